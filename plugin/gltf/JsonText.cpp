// SPDX-License-Identifier: MIT
#include "gltf/JsonText.h"

#include "gltf/Uri.h"

namespace osgGpuAnimation::gltf
{

namespace
{

constexpr std::size_t leastTaken = 1024;

constexpr std::ptrdiff_t rootDepth = 1;
constexpr std::ptrdiff_t elementDepth = 3; ///< of the members of buffers[0]

} // namespace

JsonText::JsonText(std::string_view text) : _whole(text)
{
    for (std::size_t at = 0; at < text.size(); ++at)
    {
        const char c = text[at];
        if (c == ',') ++_mostValues;
        if (c == '{' || c == '[')
        {
            ++_depth;
            ++_mostValues;
        }
        if (c == '}' || c == ']') --_depth;
        if (c != '"') continue;
        const std::size_t begin = at + 1;
        bool isPlain = true;
        for (at = begin; at < text.size() && text[at] != '"'; ++at)
        {
            isPlain = isPlain && text[at] >= 0x20 && text[at] < 0x7f && text[at] != '\\';
            if (text[at] == '\\') ++at;
        }
        if (at < text.size())
            readString(begin, at, isPlain);
        else
            _otherBytes += text.size() - begin; // the parser keeps it until it misses the end
    }
    shorten();
}

void JsonText::readString(std::size_t begin, std::size_t end, bool isPlain)
{
    const std::string_view string = _whole.substr(begin, end - begin);
    const std::size_t number = _strings++;
    const std::size_t next = _whole.find_first_not_of(" \t\r\n", end + 1);
    if (next != std::string_view::npos && _whole[next] == ':')
    {
        _key = string;
        if (_depth == rootDepth) _list = string;
    }
    else if (isPlain && string.size() >= leastTaken && _depth == elementDepth && _key == "uri" &&
             (_list == "buffers" || _list == "images") && isDataUri(string))
    {
        _data.emplace_back(number, string);
        return;
    }
    _otherBytes += string.size();
}

void JsonText::shorten()
{
    if (_data.empty()) return;
    std::size_t left = _whole.size();
    for (const auto& [number, data] : _data)
        left -= data.size();
    _shortened.reserve(left);
    const char* from = _whole.data();
    for (const auto& [number, data] : _data)
    {
        _shortened.append(from, data.data());
        from = data.data() + data.size();
    }
    _shortened.append(from, _whole.data() + _whole.size());
}

std::optional<std::string_view> JsonText::dataAt(std::size_t string)
{
    if (_nextData == _data.size() || _data[_nextData].first != string) return std::nullopt;
    return _data[_nextData++].second;
}

} // namespace osgGpuAnimation::gltf
