// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/document/JsonTree.h"
#include "gltf/file/Report.h"

#include <osgGpuAnimation/animation/Result.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace osgGpuAnimation::gltf
{

/// The arrays at the top of a document that others refer to by index.
enum class Collection : std::uint8_t
{
    Accessors,
    Buffers,
    BufferViews,
    Cameras,
    Images,
    Materials,
    Meshes,
    Nodes,
    Samplers,
    Scenes,
    Skins,
    Textures,
    Count
};

/// The consequence for a member that breaks its rule.
enum class OnFault : std::uint8_t
{
    Refuse,   ///< the document is refused
    LeaveOut, ///< a warning, and the member is as if it were absent
    Clamp     ///< a warning, and the number becomes the nearest allowed one; numbers out of range only
};

/// The type and range of one member of a JSON object. Rules are built in tables:
///
///     index("mesh", Collection::Meshes), numbers("matrix", 16), integer("count").from(1).required()
struct SchemaRule
{
    enum class Kind : std::uint8_t
    {
        Any,
        Boolean,
        String,
        Strings,
        Number,
        Numbers,
        Integer,
        Index, ///< an integer from 0 to the size of a collection, less one
        Indices,
        Choice, ///< one of some texts
        Code,   ///< one of some integers
        Object,
        Objects,
        IndexMap, ///< an object whose members are indices: the attributes of a primitive
        IndexMaps
    };

    std::string_view name;
    Kind kind = Kind::Any;
    bool isRequired = false;
    OnFault onFault = OnFault::Refuse;   ///< wrong type, wrong number of elements, missing, bad index
    OnFault onRange = OnFault::LeaveOut; ///< a number of the right type that is out of range
    Collection refersTo = Collection::Count;
    double least = 0.0, most = 0.0;            ///< of numbers, both inclusive
    double step = 1.0;                         ///< integers are multiples of it
    std::size_t leastCount = 0, mostCount = 0; ///< of elements
    const SchemaRule* members = nullptr;       ///< of objects: those that are allowed, others are left out
    std::size_t memberCount = 0;
    const std::string_view* texts = nullptr;
    const int* codes = nullptr;
    std::size_t choices = 0;

    constexpr SchemaRule required() const
    {
        SchemaRule rule = *this;
        rule.isRequired = true;
        return rule;
    }
    /// Any fault costs this member only.
    constexpr SchemaRule orLeaveOut() const
    {
        SchemaRule rule = *this;
        rule.onFault = rule.onRange = OnFault::LeaveOut;
        return rule;
    }
    constexpr SchemaRule clamped(double from, double to) const
    {
        SchemaRule rule = *this;
        rule.least = from;
        rule.most = to;
        rule.onRange = OnFault::Clamp;
        return rule;
    }
    constexpr SchemaRule from(double first) const
    {
        SchemaRule rule = *this;
        rule.least = first;
        return rule;
    }
    constexpr SchemaRule upTo(double last) const
    {
        SchemaRule rule = *this;
        rule.most = last;
        return rule;
    }
    constexpr SchemaRule inStepsOf(double multiple) const
    {
        SchemaRule rule = *this;
        rule.step = multiple;
        return rule;
    }
};

namespace schema
{

using Kind = SchemaRule::Kind;

constexpr double largestInteger = 9007199254740991.0; // 2^53 - 1: exact in every JSON reader (section 2.7)
constexpr double largestInt = 2147483647.0;
constexpr double largestFloat = 3.4028234663852886e38;
constexpr std::size_t anyCount = std::size_t(-1);

constexpr SchemaRule rule(std::string_view name, Kind kind)
{
    SchemaRule made;
    made.name = name;
    made.kind = kind;
    return made;
}

constexpr SchemaRule any(std::string_view name)
{
    return rule(name, Kind::Any);
}
constexpr SchemaRule boolean(std::string_view name)
{
    return rule(name, Kind::Boolean);
}
constexpr SchemaRule text(std::string_view name)
{
    return rule(name, Kind::String);
}
constexpr SchemaRule texts(std::string_view name)
{
    SchemaRule made = rule(name, Kind::Strings);
    made.leastCount = 1;
    made.mostCount = anyCount;
    return made;
}

constexpr SchemaRule integer(std::string_view name)
{
    SchemaRule made = rule(name, Kind::Integer);
    made.most = largestInteger;
    made.onRange = OnFault::Refuse;
    return made;
}

constexpr SchemaRule number(std::string_view name)
{
    SchemaRule made = rule(name, Kind::Number);
    made.least = -largestFloat;
    made.most = largestFloat;
    return made;
}

constexpr SchemaRule numbers(std::string_view name, std::size_t least, std::size_t most)
{
    SchemaRule made = number(name);
    made.kind = Kind::Numbers;
    made.leastCount = least;
    made.mostCount = most;
    return made;
}
constexpr SchemaRule numbers(std::string_view name, std::size_t count)
{
    return numbers(name, count, count);
}

constexpr SchemaRule index(std::string_view name, Collection collection)
{
    SchemaRule made = rule(name, Kind::Index);
    made.refersTo = collection;
    return made;
}

constexpr SchemaRule indices(std::string_view name, Collection collection)
{
    SchemaRule made = index(name, collection);
    made.kind = Kind::Indices;
    made.leastCount = 1;
    made.mostCount = anyCount;
    return made;
}

constexpr SchemaRule indexMap(std::string_view name, Collection collection)
{
    SchemaRule made = index(name, collection);
    made.kind = Kind::IndexMap;
    return made;
}

constexpr SchemaRule indexMaps(std::string_view name, Collection collection)
{
    SchemaRule made = indices(name, collection);
    made.kind = Kind::IndexMaps;
    return made;
}

template <std::size_t size>
constexpr SchemaRule choice(std::string_view name, const std::string_view (&texts)[size])
{
    SchemaRule made = rule(name, Kind::Choice);
    made.texts = texts;
    made.choices = size;
    return made;
}

template <std::size_t size>
constexpr SchemaRule code(std::string_view name, const int (&codes)[size])
{
    SchemaRule made = rule(name, Kind::Code);
    made.codes = codes;
    made.choices = size;
    return made;
}

template <std::size_t size>
constexpr SchemaRule object(std::string_view name, const SchemaRule (&members)[size])
{
    SchemaRule made = rule(name, Kind::Object);
    made.members = members;
    made.memberCount = size;
    return made;
}

template <std::size_t size>
constexpr SchemaRule objects(std::string_view name, const SchemaRule (&members)[size])
{
    SchemaRule made = object(name, members);
    made.kind = Kind::Objects;
    made.leastCount = 1;
    made.mostCount = anyCount;
    return made;
}

} // namespace schema

/// Checks a document, member by member, against the schema of glTF 2.0 (chapter 5 of the specification, and the
/// extensions that are imported): types, required members, numbers in range, indices within their collections.
/// Members that the schema does not name, and faulty ones that are dispensable, are left out of the tree, the latter
/// with a warning. checkDocumentRules() checks the rules that bind several members together.
/// Returns the first fault that the document must be refused for.
std::optional<Error> checkSchema(const JsonValue& document, Report& report);

} // namespace osgGpuAnimation::gltf
