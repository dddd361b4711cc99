// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/file/Report.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace osgGpuAnimation::gltf
{

class JsonValue;

/// A JSON text as one flat array in document order: readJson() builds it, the checks change values or leave them out in
/// place, readModel() copies the rest into tinygltf's model. It is flat because a document has a hundred thousand
/// values, and because no function of it may recurse.
class JsonTree
{
public:
    enum class Type : std::uint8_t
    {
        Null,
        Boolean,
        Number,
        String,
        Array,
        Object
    };

    JsonValue root();

    /// For the reader: values in document order; end() is called for each array and object once it is complete.
    std::uint32_t add(Type type, std::string_view key);
    void setNumber(std::uint32_t value, double number) { _nodes[value].number = number; }
    void setText(std::uint32_t value, std::string_view text);
    /// The same for a data URI, which is not copied.
    void setData(std::uint32_t value, std::string&& uri);
    void end(std::uint32_t container, std::uint32_t size);
    void drop(std::uint32_t value) { _nodes[value].dropped = true; }
    std::size_t size() const { return _nodes.size(); }
    std::string_view keyOf(std::uint32_t value) const
    {
        return std::string_view(_text).substr(_nodes[value].key, _nodes[value].keyLength);
    }
    std::uint32_t endOf(std::uint32_t value) const { return _nodes[value].end; }

private:
    friend class JsonValue;

    struct Node
    {
        double number = 0.0;    ///< of a number; 1 for true
        std::uint32_t text = 0; ///< of a string: where it begins in _text
        std::uint32_t textLength = 0;
        std::uint32_t key = 0; ///< of an object's member: likewise
        std::uint32_t keyLength = 0;
        std::uint32_t end = 0;  ///< one past the last value below this one
        std::uint32_t size = 0; ///< elements or members
        Type type = Type::Null;
        bool dropped = false;
        bool isData = false; ///< text is an index of _data
    };

    std::vector<Node> _nodes;
    std::string _text;
    std::vector<std::string> _data;
};

/// A value of a tree, or none: asking a missing value for a member gives a missing value again.
///
///     if (JsonValue mesh = node["mesh"]) use(mesh.number());
class JsonValue
{
public:
    JsonValue() = default;
    JsonValue(JsonTree& tree, std::uint32_t value) : _tree(&tree), _value(value) {}

    explicit operator bool() const { return _tree != nullptr; }
    bool is(JsonTree::Type type) const { return _tree != nullptr && node().type == type; }
    bool isInteger() const; ///< also 8.0 (glTF 2.0, section 2.7)

    JsonTree::Type type() const { return node().type; }
    std::size_t size() const { return node().size; } ///< of an array or object, less what was left out
    std::size_t valuesBelow() const { return node().end - _value - 1; } ///< at all depths, left out or not
    double number() const { return node().number; }
    bool boolean() const { return node().number != 0.0; }
    std::string_view text() const;
    std::string_view key() const { return _tree->keyOf(_value); }

    JsonValue operator[](std::string_view member) const;

    void setNumber(double number) const { _tree->setNumber(_value, number); }
    /// Leaves a member out of its object from here on.
    void dropFrom(const JsonValue& object) const;
    /// Leaves out all members of an object; changes no other value.
    void dropMembers() const;

    /// The value as text for messages: `null`, `8.5`, `"text"`, `an array of 3`, `an object`, `nothing`.
    std::string description() const;

    class Iterator
    {
    public:
        Iterator(JsonTree* tree, std::uint32_t value, std::uint32_t end) : _tree(tree), _value(value), _end(end)
        {
            skipDropped();
        }

        JsonValue operator*() const { return JsonValue(*_tree, _value); }
        Iterator& operator++()
        {
            _value = _tree->endOf(_value);
            skipDropped();
            return *this;
        }
        bool operator!=(const Iterator& other) const { return _value != other._value; }

    private:
        void skipDropped()
        {
            while (_value != _end && _tree->_nodes[_value].dropped)
                _value = _tree->endOf(_value);
        }

        JsonTree* _tree;
        std::uint32_t _value;
        std::uint32_t _end;
    };

    /// The elements of an array, the members of an object; nothing for other values.
    Iterator begin() const { return _tree ? Iterator(_tree, _value + 1, node().end) : Iterator(nullptr, 0, 0); }
    Iterator end() const { return _tree ? Iterator(_tree, node().end, node().end) : Iterator(nullptr, 0, 0); }

private:
    const JsonTree::Node& node() const { return _tree->_nodes[_value]; }

    JsonTree* _tree = nullptr;
    std::uint32_t _value = 0;
};

} // namespace osgGpuAnimation::gltf
