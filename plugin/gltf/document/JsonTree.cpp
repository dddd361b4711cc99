// SPDX-License-Identifier: MIT
#include "gltf/document/JsonTree.h"

#include <cmath>

namespace osgGpuAnimation::gltf
{

JsonValue JsonTree::root()
{
    return JsonValue(*this, 0);
}

std::uint32_t JsonTree::add(Type type, std::string_view key)
{
    Node node;
    node.type = type;
    node.key = static_cast<std::uint32_t>(_text.size());
    node.keyLength = static_cast<std::uint32_t>(key.size());
    node.end = static_cast<std::uint32_t>(_nodes.size() + 1);
    _text += key;
    _nodes.push_back(node);
    return node.end - 1;
}

void JsonTree::setText(std::uint32_t value, std::string_view text)
{
    _nodes[value].text = static_cast<std::uint32_t>(_text.size());
    _nodes[value].textLength = static_cast<std::uint32_t>(text.size());
    _text += text;
}

void JsonTree::setData(std::uint32_t value, std::string&& uri)
{
    _nodes[value].text = static_cast<std::uint32_t>(_data.size());
    _nodes[value].isData = true;
    _data.push_back(std::move(uri));
}

void JsonTree::end(std::uint32_t container, std::uint32_t size)
{
    _nodes[container].end = static_cast<std::uint32_t>(_nodes.size());
    _nodes[container].size = size;
}

bool JsonValue::isInteger() const
{
    return is(JsonTree::Type::Number) && std::trunc(node().number) == node().number;
}

std::string_view JsonValue::text() const
{
    if (node().isData) return _tree->_data[node().text];
    return std::string_view(_tree->_text).substr(node().text, node().textLength);
}

JsonValue JsonValue::operator[](std::string_view member) const
{
    if (!is(JsonTree::Type::Object)) return JsonValue();
    for (const JsonValue& value : *this)
        if (value.key() == member) return value;
    return JsonValue();
}

void JsonValue::dropFrom(const JsonValue& object) const
{
    _tree->drop(_value);
    --_tree->_nodes[object._value].size;
}

void JsonValue::dropMembers() const
{
    if (!is(JsonTree::Type::Object)) return;
    for (const JsonValue& member : *this)
        member.dropFrom(*this);
}

std::string JsonValue::description() const
{
    if (!_tree) return "nothing";
    switch (type())
    {
    case JsonTree::Type::Null:
        return "null";
    case JsonTree::Type::Boolean:
        return boolean() ? "true" : "false";
    case JsonTree::Type::Number:
        return numberText(number());
    case JsonTree::Type::String:
        return quoted(text());
    case JsonTree::Type::Array:
        return "an array of " + std::to_string(size());
    default:
        return "an object";
    }
}

} // namespace osgGpuAnimation::gltf
