// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

/// The rules of DocumentSchema's tables.
namespace osgGpuAnimation::gltf::schema
{

constexpr double maxInteger = 9007199254740991.0; // 2^53 - 1: exact in every JSON reader (section 2.7)
constexpr double maxInt = 2147483647.0;
constexpr double maxFloat = 3.4028234663852886e38;
constexpr double aboveZero = 1e-300; // the least number where glTF asks for one above 0
constexpr double belowPi = 3.14159265358979;
constexpr double halfPi = 1.5707964; // pi / 2 as a float, rounded up
constexpr std::size_t anyCount = std::size_t(-1);

/// The consequence for a member that breaks its rule.
enum class OnFault : std::uint8_t
{
    Refuse,   ///< the document is refused
    LeaveOut, ///< a warning; the member counts as absent
    Empty,    ///< of a list: a warning; an element with a fault loses its members and keeps its place
    Clamp     ///< a warning; the number becomes the nearest allowed one (numbers out of range only)
};

enum class Kind : std::uint8_t
{
    Any,
    Boolean,
    String,
    Number,
    Integer,
    Index,    ///< an integer from 0, below the size of a collection
    Choice,   ///< one of some texts
    Code,     ///< one of some integers
    Object,   ///< with the members of a table; others are left out
    IndexMap, ///< an object whose members are indices: the attributes of a primitive
};

/// The type and range of one member of a JSON object. Rules are built in tables:
///
///     index("mesh", "meshes"), number("matrix").list(16, 16), integer("count").from(1).required()
struct SchemaRule
{
    std::string_view name;
    Kind kind = Kind::Any;
    bool isList = false; ///< an array of that kind
    bool isRequired = false;
    OnFault onFault = OnFault::Refuse;      ///< wrong type, wrong number of elements, missing, bad index
    OnFault onRange = OnFault::LeaveOut;    ///< a number of the right type that is out of range
    double min = 0.0, max = 0.0;            ///< of numbers, both inclusive
    double step = 1.0;                      ///< integers are multiples of it
    std::size_t minCount = 0, maxCount = 0; ///< of the elements of a list
    std::string_view collection;            ///< of indices: the array of the document that they refer to
    std::string_view choices;               ///< separated by spaces
    const SchemaRule* members = nullptr;    ///< of objects
    std::size_t memberCount = 0;

    template <typename Member>
    constexpr SchemaRule with(Member SchemaRule::*member, Member value) const
    {
        SchemaRule rule = *this;
        rule.*member = value;
        return rule;
    }
    constexpr SchemaRule required() const { return with(&SchemaRule::isRequired, true); }
    constexpr SchemaRule withRangeFault(OnFault fault) const { return with(&SchemaRule::onRange, fault); }
    /// Any fault removes this member only.
    constexpr SchemaRule dropIfInvalid() const
    {
        return with(&SchemaRule::onFault, OnFault::LeaveOut).withRangeFault(OnFault::LeaveOut);
    }

    /// A fault in an element of the list, or in what the element requires, costs that element.
    constexpr SchemaRule emptyIfInvalid() const { return with(&SchemaRule::onFault, OnFault::Empty); }
    constexpr SchemaRule from(double first) const { return with(&SchemaRule::min, first); }
    constexpr SchemaRule upTo(double last) const { return with(&SchemaRule::max, last); }
    constexpr SchemaRule clamped(double first, double last) const
    {
        return from(first).upTo(last).withRangeFault(OnFault::Clamp);
    }
    constexpr SchemaRule inStepsOf(double multiple) const { return with(&SchemaRule::step, multiple); }
    constexpr SchemaRule list(std::size_t atLeast = 1, std::size_t atMost = anyCount) const
    {
        return with(&SchemaRule::isList, true).with(&SchemaRule::minCount, atLeast).with(&SchemaRule::maxCount, atMost);
    }
};

constexpr SchemaRule rule(std::string_view name, Kind kind)
{
    return SchemaRule().with(&SchemaRule::name, name).with(&SchemaRule::kind, kind);
}

constexpr SchemaRule text(std::string_view name)
{
    return rule(name, Kind::String);
}

constexpr SchemaRule integer(std::string_view name)
{
    return rule(name, Kind::Integer).upTo(maxInteger).withRangeFault(OnFault::Refuse);
}

constexpr SchemaRule number(std::string_view name)
{
    return rule(name, Kind::Number).from(-maxFloat).upTo(maxFloat);
}

constexpr SchemaRule index(std::string_view name, std::string_view collection)
{
    return rule(name, Kind::Index).with(&SchemaRule::collection, collection);
}

constexpr SchemaRule indexMap(std::string_view name, std::string_view collection)
{
    return rule(name, Kind::IndexMap).with(&SchemaRule::collection, collection);
}

constexpr SchemaRule choice(std::string_view name, std::string_view texts)
{
    return rule(name, Kind::Choice).with(&SchemaRule::choices, texts);
}

constexpr SchemaRule code(std::string_view name, std::string_view integers)
{
    return rule(name, Kind::Code).with(&SchemaRule::choices, integers);
}

template <std::size_t size>
constexpr SchemaRule object(std::string_view name, const SchemaRule (&members)[size])
{
    SchemaRule made = rule(name, Kind::Object).with(&SchemaRule::memberCount, size);
    made.members = members;
    return made;
}

} // namespace osgGpuAnimation::gltf::schema
