// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/JsonTree.h"
#include "gltf/Report.h"
#include "gltf/SchemaRule.h"

#include <osgGpuAnimation/animation/Result.h>

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// Holds a document against its schema: types, required members, numbers in range, indices within their collections.
/// Members that the schema does not name, and faulty ones that a document can do without, are left out of the tree,
/// the latter with a warning.
///
///     if (std::optional<Error> fault = SchemaCheck(document, report).run(documentSchema)) return *fault;
class SchemaCheck
{
public:
    SchemaCheck(const JsonValue& document, Report& report);

    /// The first fault that the document must be refused for.
    std::optional<Error> run(const ObjectRule& rules);

private:
    /// One step of the way to the value in hand.
    struct Step
    {
        std::string_view member;
        std::size_t index = isMember;
        static constexpr std::size_t isMember = std::size_t(-1);
    };
    /// What was wrong, while the way to it is still known.
    struct Finding
    {
        std::string element;
        std::string expected;
        std::string found;
    };
    enum class Outcome
    {
        Good,
        LeaveOut,
        Refuse
    };

    bool checkObject(const JsonValue& object, const ObjectRule& rules);
    bool checkMember(const JsonValue& object, const JsonValue& member, const SchemaRule& rule);
    bool checkMissing(const SchemaRule& rule);
    Outcome checkValue(const JsonValue& value, const SchemaRule& rule);
    Outcome checkNumber(const JsonValue& value, const SchemaRule& rule);
    Outcome checkInteger(const JsonValue& value, const SchemaRule& rule);
    Outcome checkIndex(const JsonValue& value, const SchemaRule& rule);
    Outcome checkChoice(const JsonValue& value, const SchemaRule& rule);
    Outcome checkCode(const JsonValue& value, const SchemaRule& rule);
    Outcome checkMap(const JsonValue& value, const SchemaRule& rule);
    Outcome checkElements(const JsonValue& value, const SchemaRule& rule);
    Outcome checkElement(const JsonValue& value, const SchemaRule& rule);
    Outcome checkType(const JsonValue& value, JsonTree::Type type, const SchemaRule& rule, std::string_view expected);

    Outcome wrong(const SchemaRule& rule, std::string expected, const JsonValue& found);
    Outcome outOfRange(const SchemaRule& rule, std::string expected, const JsonValue& found);
    Outcome find(OnFault policy, std::string expected, std::string found);
    std::string pathText() const;

    JsonValue _document;
    Report& _report;
    std::array<std::size_t, std::size_t(Collection::Count)> _sizes{};
    std::vector<Step> _path;
    Finding _finding;
    std::optional<Error> _error;
};

} // namespace osgGpuAnimation::gltf
