// SPDX-License-Identifier: MIT
#include "gltf/document/JsonReader.h"

#include "gltf/document/MemoryBudget.h"
#include "gltf/file/Report.h"
#include "gltf/file/Uri.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

constexpr std::size_t leastTaken = 1024;

constexpr std::ptrdiff_t rootDepth = 1;
constexpr std::ptrdiff_t elementDepth = 3; ///< of the members of buffers[0]

// readModel() recurses over extras. A stack of 8 MB must suffice, whatever depth the options allow.
const std::size_t deepestJson = 1000;

/// Builds the tree from the events of nlohmann's SAX parser, which prescribes the names.
class TreeBuilder
{
public:
    using Json = nlohmann::json;

    TreeBuilder(JsonText& source, JsonTree& tree, const ImportOptions& options)
        : _source(source), _tree(tree), _mostDepth(std::min(options.maxJsonDepth, deepestJson)),
          _mostElements(options.maxElements),
          _mostValues(std::min<std::size_t>(options.maxDocumentBytes / bytesOfJsonValue,
                                            std::numeric_limits<std::uint32_t>::max() - 1))
    {
    }

    void reserve() { _tree.reserve(std::min(_source.mostValues(), _mostValues), _source.text().size()); }

    bool null() { return add(JsonTree::Type::Null); }
    bool boolean(bool value) { return addNumber(JsonTree::Type::Boolean, value ? 1.0 : 0.0); }
    bool number_integer(Json::number_integer_t value) { return addNumber(JsonTree::Type::Number, double(value)); }
    bool number_unsigned(Json::number_unsigned_t value) { return addNumber(JsonTree::Type::Number, double(value)); }
    bool number_float(Json::number_float_t value, const std::string&)
    {
        return addNumber(JsonTree::Type::Number, value);
    }
    bool string(std::string& value)
    {
        if (!add(JsonTree::Type::String)) return false;
        if (const std::optional<std::string_view> data = _source.dataAt(_strings++))
            _tree.setOutsideText(_last, *data);
        else
            _tree.setText(_last, value);
        return true;
    }
    bool binary(Json::binary_t&) { return false; }
    bool start_object(std::size_t) { return open(JsonTree::Type::Object); }
    bool start_array(std::size_t) { return open(JsonTree::Type::Array); }
    bool key(std::string& name)
    {
        ++_strings;
        _key.swap(name);
        return true;
    }
    bool end_object()
    {
        dropDuplicates();
        return close();
    }
    bool end_array() { return close(); }
    bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception& exception)
    {
        if (!_fault.empty()) return false;
        _fault = "JSON syntax: " + withoutId(exception.what());
        if (_source.dataBytes() > 0) _fault += " (counted without the data URIs)";
        return false;
    }

    const std::string& faultText() const { return _fault; }
    const std::vector<std::uint32_t>& duplicates() const { return _duplicates; }

private:
    struct Open
    {
        std::uint32_t value;
        std::uint32_t size;
    };

    static std::string withoutId(const std::string& what)
    {
        const std::size_t id = what.find("] ");
        return printable(std::string_view(what).substr(id == std::string::npos ? 0 : id + 2), 200);
    }

    bool refuse(const std::string& expected)
    {
        _fault = "JSON: expected " + expected + ", found more";
        return false;
    }

    bool add(JsonTree::Type type)
    {
        if (_tree.size() >= _mostValues)
            return refuse("at most " + std::to_string(_mostValues) + " values in all (limit maxDocumentBytes)");
        if (!_open.empty() && ++_open.back().size > _mostElements)
            return refuse("arrays of at most " + std::to_string(_mostElements) + " elements (limit maxElements)");
        _last = _tree.add(type, _key);
        _key.clear();
        return true;
    }

    bool addNumber(JsonTree::Type type, double value)
    {
        if (!add(type)) return false;
        _tree.setNumber(_last, value);
        return true;
    }

    bool open(JsonTree::Type type)
    {
        if (_open.size() >= _mostDepth)
            return refuse("a nesting depth of at most " + std::to_string(_mostDepth) + " (limit maxJsonDepth)");
        if (!add(type)) return false;
        _open.push_back({_last, 0});
        return true;
    }

    bool close()
    {
        _tree.end(_open.back().value, _open.back().size);
        _open.pop_back();
        return true;
    }

    using Member = std::pair<std::string_view, std::uint32_t>;

    /// Any order that puts equal keys side by side: lengths mostly differ and compare faster.
    static bool isBefore(const Member& a, const Member& b)
    {
        return a.first.size() != b.first.size() ? a.first.size() < b.first.size() : a < b;
    }

    void dropDuplicates()
    {
        if (_open.back().size < 2) return;
        _members.clear();
        for (std::uint32_t member = _open.back().value + 1; member < _tree.size(); member = _tree.endOf(member))
            _members.emplace_back(_tree.keyOf(member), member);
        std::sort(_members.begin(), _members.end(), isBefore);
        for (std::size_t i = 1; i < _members.size(); ++i)
            if (_members[i - 1].first == _members[i].first)
            {
                _tree.drop(_members[i - 1].second);
                _duplicates.push_back(_members[i].second);
                --_open.back().size;
            }
    }

    JsonText& _source;
    JsonTree& _tree;
    std::size_t _strings = 0; ///< read so far, keys included
    std::size_t _mostDepth;
    std::size_t _mostElements;
    std::size_t _mostValues;
    std::string _key;
    std::uint32_t _last = 0;
    std::vector<Open> _open;
    std::vector<Member> _members;
    std::vector<std::uint32_t> _duplicates;
    std::string _fault;
};

/// nodes[3].mesh: the path from the root to a value.
std::string pathOf(JsonTree& tree, std::uint32_t wanted)
{
    std::string path;
    for (std::uint32_t at = 0; at != wanted;)
    {
        const bool array = JsonValue(tree, at).is(JsonTree::Type::Array);
        std::size_t index = 0;
        std::uint32_t child = at + 1;
        for (; tree.endOf(child) <= wanted; child = tree.endOf(child))
            ++index;
        if (array)
            path = elementName(path, index);
        else
            path += (path.empty() ? "" : ".") + printable(tree.keyOf(child));
        at = child;
    }
    return path;
}

/// The parser ends at the first NUL.
std::optional<Error> checkEnd(std::string_view text, Report& report)
{
    const std::size_t end = text.find('\0');
    if (end == std::string_view::npos) return std::nullopt;
    const std::size_t more = text.find_first_not_of('\0', end);
    if (more != std::string_view::npos)
        return Error{"JSON syntax: expected the end of the text after the NUL at byte " + std::to_string(end) +
                     ", found more at byte " + std::to_string(more)};
    report.warn("JSON: expected the end of the text at byte " + std::to_string(end) + ", found " +
                std::to_string(text.size() - end) + " bytes of NUL; ignored");
    return std::nullopt;
}

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
            _otherBytes += text.size() - begin; // the parser stores the unterminated string
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

Result<JsonTree> readJson(std::string_view text, const ImportOptions& options, Report& report)
{
    if (text.size() >= std::numeric_limits<std::uint32_t>::max())
        return Error{"JSON: expected a text of less than 4 GiB, found " + std::to_string(text.size()) + " bytes"};
    JsonText source(text);
    if (source.otherBytes() > options.maxDocumentBytes / bytesOfJsonLetter)
        return fault("JSON",
                     "strings of at most " + std::to_string(options.maxDocumentBytes / bytesOfJsonLetter) +
                         " bytes in all, less data URIs without escapes (limit maxDocumentBytes)",
                     std::to_string(source.otherBytes()));
    JsonTree tree;
    TreeBuilder builder(source, tree, options);
    builder.reserve();
    if (!nlohmann::json::sax_parse(source.text().begin(), source.text().end(), &builder))
        return Error{builder.faultText()};
    if (const std::optional<Error> more = checkEnd(text, report)) return *more;
    if (!tree.root().is(JsonTree::Type::Object))
        return fault("JSON", "an object as the root", tree.root().description());
    for (std::size_t i = 0; i < builder.duplicates().size() && i < 100; ++i)
        report.warn(pathOf(tree, builder.duplicates()[i]) + ": the key appears twice; the last counts");
    return tree;
}

} // namespace osgGpuAnimation::gltf
