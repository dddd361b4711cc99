// SPDX-License-Identifier: MIT
#include "gltf/SchemaCheck.h"

#include "gltf/DocumentSchema.h"
#include "gltf/ElementName.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace osgGpuAnimation::gltf
{

using Kind = SchemaRule::Kind;
using Type = JsonTree::Type;

namespace
{

std::string listed(const SchemaRule& rule)
{
    std::string list = "one of";
    for (std::size_t i = 0; i < rule.choices; ++i)
        list += (i == 0 ? " " : ", ") + (rule.texts ? quoted(rule.texts[i]) : std::to_string(rule.codes[i]));
    return list;
}

std::string rangeText(const SchemaRule& rule, const std::string& what)
{
    std::string text = what + " from " + numberText(rule.least) + " to " + numberText(rule.most);
    if (rule.step != 1.0) text += " in steps of " + numberText(rule.step);
    return text;
}

bool isArrayKind(Kind kind)
{
    return kind == Kind::Numbers || kind == Kind::Indices || kind == Kind::Strings || kind == Kind::Objects ||
           kind == Kind::IndexMaps;
}

std::string elementsText(const SchemaRule& rule)
{
    const std::string what = rule.kind == Kind::Numbers   ? " numbers"
                             : rule.kind == Kind::Indices ? " indices"
                             : rule.kind == Kind::Strings ? " texts"
                                                          : " objects";
    if (rule.leastCount == rule.mostCount) return std::to_string(rule.leastCount) + what;
    return "at least " + std::to_string(rule.leastCount) + what;
}

} // namespace

SchemaCheck::SchemaCheck(const JsonValue& document, Report& report) : _document(document), _report(report)
{
    for (std::size_t i = 0; i < _sizes.size(); ++i)
        if (const JsonValue collection = document[collectionName(Collection(i))])
            if (collection.is(Type::Array)) _sizes[i] = collection.size();
}

std::optional<Error> SchemaCheck::run(const ObjectRule& rules)
{
    checkObject(_document, rules);
    return _error;
}

bool SchemaCheck::checkObject(const JsonValue& object, const ObjectRule& rules)
{
    std::uint64_t seen = 0;
    for (const JsonValue& member : object)
    {
        const SchemaRule* const last = rules.members + rules.count;
        const SchemaRule* rule = std::find_if(
            rules.members, last, [key = member.key()](const SchemaRule& candidate) { return candidate.name == key; });
        if (rule == last)
        {
            member.dropFrom(object);
            continue;
        }
        seen |= std::uint64_t(1) << (rule - rules.members);
        if (!checkMember(object, member, *rule)) return false;
    }
    for (std::size_t i = 0; i < rules.count; ++i)
        if (rules.members[i].isRequired && (seen >> i & 1) == 0 && !checkMissing(rules.members[i])) return false;
    return true;
}

bool SchemaCheck::checkMember(const JsonValue& object, const JsonValue& member, const SchemaRule& rule)
{
    _path.push_back({rule.name});
    const Outcome outcome = checkValue(member, rule);
    _path.pop_back();
    const bool saysNothing = outcome == Outcome::Good && rule.firstIsDefault && member.text() == rule.texts[0];
    if (outcome == Outcome::Good && rule.isHandedOn && !saysNothing) return true;
    member.dropFrom(object);
    if (outcome == Outcome::Good) return true;
    const Error error = fault(_finding.element, _finding.expected, _finding.found);
    const bool refuse = outcome == Outcome::Refuse || (rule.isRequired && rule.onFault == OnFault::Refuse);
    if (refuse && !_error) _error = error;
    if (!refuse) _report.warn(error.message + "; left out");
    return !refuse;
}

bool SchemaCheck::checkMissing(const SchemaRule& rule)
{
    _path.push_back({rule.name});
    const Outcome outcome = find(rule.onFault,
                                 isArrayKind(rule.kind) ? "an array"
                                 : rule.object          ? "an object"
                                                        : "a value",
                                 "nothing");
    _path.pop_back();
    const Error error = fault(_finding.element, _finding.expected, _finding.found);
    if (outcome == Outcome::Refuse)
        _error = error;
    else
        _report.warn(error.message);
    return outcome != Outcome::Refuse;
}

SchemaCheck::Outcome SchemaCheck::checkValue(const JsonValue& value, const SchemaRule& rule)
{
    return isArrayKind(rule.kind) ? checkElements(value, rule) : checkElement(value, rule);
}

SchemaCheck::Outcome SchemaCheck::checkElements(const JsonValue& value, const SchemaRule& rule)
{
    if (!value.is(Type::Array)) return wrong(rule, "an array of " + elementsText(rule), value);
    if (value.size() == 0 && !rule.isRequired && rule.leastCount <= 1)
        return find(OnFault::LeaveOut, elementsText(rule), "none");
    if (value.size() < rule.leastCount || value.size() > rule.mostCount) return wrong(rule, elementsText(rule), value);
    _path.push_back({{}, 0});
    Outcome outcome = Outcome::Good;
    for (const JsonValue& element : value)
    {
        outcome = checkElement(element, rule);
        if (outcome != Outcome::Good) break;
        ++_path.back().index;
    }
    _path.pop_back();
    return outcome;
}

SchemaCheck::Outcome SchemaCheck::checkElement(const JsonValue& value, const SchemaRule& rule)
{
    switch (rule.kind)
    {
    case Kind::Any:
        return Outcome::Good;
    case Kind::Boolean:
        return checkType(value, Type::Boolean, rule, "true or false");
    case Kind::String:
    case Kind::Strings:
        return checkType(value, Type::String, rule, "a text");
    case Kind::Number:
    case Kind::Numbers:
        return checkNumber(value, rule);
    case Kind::Integer:
        return checkInteger(value, rule);
    case Kind::Index:
    case Kind::Indices:
        return checkIndex(value, rule);
    case Kind::Choice:
        return checkChoice(value, rule);
    case Kind::Code:
        return checkCode(value, rule);
    case Kind::IndexMap:
    case Kind::IndexMaps:
        return checkMap(value, rule);
    case Kind::Object:
    case Kind::Objects:
        break;
    }
    const Outcome outcome = checkType(value, Type::Object, rule, "an object");
    if (outcome != Outcome::Good) return outcome;
    return checkObject(value, *rule.object) ? Outcome::Good : Outcome::Refuse;
}

SchemaCheck::Outcome SchemaCheck::checkType(const JsonValue& value, Type type, const SchemaRule& rule,
                                            std::string_view expected)
{
    return value.is(type) ? Outcome::Good : wrong(rule, std::string(expected), value);
}

SchemaCheck::Outcome SchemaCheck::checkNumber(const JsonValue& value, const SchemaRule& rule)
{
    if (!value.is(Type::Number)) return wrong(rule, "a number", value);
    const double number = value.number();
    if (number >= rule.least && number <= rule.most) return Outcome::Good;
    if (rule.onRange != OnFault::Clamp) return outOfRange(rule, rangeText(rule, "a number"), value);
    const double nearest = std::clamp(number, rule.least, rule.most);
    value.setNumber(nearest);
    // Exporters write 1.0000001: rounding, not a fault.
    if (std::abs(nearest - number) > 1e-5)
        _report.warn(fault(pathText(), rangeText(rule, "a number"), numberText(number)).message + "; " +
                     numberText(nearest) + " is taken");
    return Outcome::Good;
}

SchemaCheck::Outcome SchemaCheck::checkInteger(const JsonValue& value, const SchemaRule& rule)
{
    if (!value.isInteger()) return wrong(rule, "an integer", value);
    const double number = value.number();
    if (number < rule.least || number > rule.most || (rule.step != 1.0 && std::fmod(number, rule.step) != 0.0))
        return outOfRange(rule, rangeText(rule, "an integer"), value);
    return Outcome::Good;
}

SchemaCheck::Outcome SchemaCheck::checkIndex(const JsonValue& value, const SchemaRule& rule)
{
    const std::size_t size = _sizes[std::size_t(rule.refersTo)];
    if (value.isInteger() && value.number() >= 0.0 && value.number() < double(size)) return Outcome::Good;
    return wrong(rule, "an index below " + std::to_string(size) + " of " + std::string(collectionName(rule.refersTo)),
                 value);
}

SchemaCheck::Outcome SchemaCheck::checkChoice(const JsonValue& value, const SchemaRule& rule)
{
    if (value.is(Type::String))
        for (std::size_t i = 0; i < rule.choices; ++i)
            if (value.text() == rule.texts[i]) return Outcome::Good;
    return wrong(rule, listed(rule), value);
}

SchemaCheck::Outcome SchemaCheck::checkCode(const JsonValue& value, const SchemaRule& rule)
{
    if (value.is(Type::Number))
        for (std::size_t i = 0; i < rule.choices; ++i)
            if (value.number() == rule.codes[i]) return Outcome::Good;
    return wrong(rule, listed(rule), value);
}

SchemaCheck::Outcome SchemaCheck::checkMap(const JsonValue& value, const SchemaRule& rule)
{
    if (!value.is(Type::Object)) return wrong(rule, "an object of indices", value);
    for (const JsonValue& member : value)
    {
        _path.push_back({member.key()});
        const Outcome outcome = checkIndex(member, rule);
        _path.pop_back();
        if (outcome != Outcome::Good) return outcome;
    }
    return Outcome::Good;
}

SchemaCheck::Outcome SchemaCheck::wrong(const SchemaRule& rule, std::string expected, const JsonValue& found)
{
    return find(rule.onFault, std::move(expected), found.description());
}

SchemaCheck::Outcome SchemaCheck::outOfRange(const SchemaRule& rule, std::string expected, const JsonValue& found)
{
    return find(rule.onRange, std::move(expected), found.description());
}

SchemaCheck::Outcome SchemaCheck::find(OnFault policy, std::string expected, std::string found)
{
    _finding = {pathText(), std::move(expected), std::move(found)};
    return policy == OnFault::Refuse ? Outcome::Refuse : Outcome::LeaveOut;
}

std::string SchemaCheck::pathText() const
{
    std::string text;
    for (const Step& step : _path)
    {
        if (step.index != Step::isMember)
            text = elementName(text, step.index);
        else
            text += (text.empty() ? "" : ".") + printable(step.member);
    }
    return text;
}

} // namespace osgGpuAnimation::gltf
