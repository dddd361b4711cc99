// SPDX-License-Identifier: MIT
#include "gltf/document/JsonReader.h"

#include "gltf/document/MemoryBudget.h"
#include "gltf/file/Uri.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <limits>

namespace osgGpuAnimation::gltf
{

namespace
{

// readModel() recurses over extras. A stack of 8 MB must suffice, whatever depth the options allow.
const std::size_t maxDepthOfJson = 1000;

/// Builds the tree from the events of nlohmann's SAX parser, which prescribes the names.
class TreeBuilder
{
public:
    using Json = nlohmann::json;

    TreeBuilder(JsonTree& tree, const ImportOptions& options)
        : _tree(tree), _maxLetters(options.maxDocumentBytes / bytesOfJsonLetter),
          _maxDepth(std::min(options.maxJsonDepth, maxDepthOfJson)), _maxElements(options.maxElements),
          _maxValues(std::min<std::size_t>(options.maxDocumentBytes / bytesOfJsonValue,
                                           std::numeric_limits<std::uint32_t>::max() - 1))
    {
    }

    bool null() { return add(JsonTree::Type::Null); }
    bool boolean(bool value) { return addNumber(value ? 1.0 : 0.0, JsonTree::Type::Boolean); }
    bool number_integer(Json::number_integer_t value) { return addNumber(static_cast<double>(value)); }
    bool number_unsigned(Json::number_unsigned_t value) { return addNumber(static_cast<double>(value)); }
    bool number_float(Json::number_float_t value, const std::string&) { return addNumber(value); }
    bool string(std::string& value)
    {
        const bool isData = isDataOfFile(value);
        if ((!isData && !countLetters(value)) || !add(JsonTree::Type::String)) return false;
        if (isData)
            _tree.setData(_last, std::move(value));
        else
            _tree.setText(_last, value);
        return true;
    }
    bool binary(Json::binary_t&) { return false; }
    bool start_object(std::size_t) { return open(JsonTree::Type::Object); }
    bool start_array(std::size_t) { return open(JsonTree::Type::Array); }
    bool key(std::string& name)
    {
        _key.swap(name);
        return countLetters(_key);
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

    /// The data URI of a buffer or image: data URIs can be nearly all of a file.
    bool isDataOfFile(std::string_view text) const
    {
        if (_open.size() != 3 || _key != "uri" || !isDataUri(text)) return false;
        const std::string_view list = _tree.keyOf(_open[1].value);
        return list == "buffers" || list == "images";
    }

    bool countLetters(std::string_view text)
    {
        _letters += text.size();
        return _letters <= _maxLetters || refuse("strings of at most " + std::to_string(_maxLetters) +
                                                 " bytes in all, less data URIs (limit maxDocumentBytes)");
    }

    bool add(JsonTree::Type type)
    {
        if (_tree.size() >= _maxValues)
            return refuse("at most " + std::to_string(_maxValues) + " values in all (limit maxDocumentBytes)");
        if (!_open.empty() && ++_open.back().size > _maxElements)
            return refuse("arrays of at most " + std::to_string(_maxElements) + " elements (limit maxElements)");
        _last = _tree.add(type, _key);
        _key.clear();
        return true;
    }

    bool addNumber(double value, JsonTree::Type type = JsonTree::Type::Number)
    {
        if (!add(type)) return false;
        _tree.setNumber(_last, value);
        return true;
    }

    bool open(JsonTree::Type type)
    {
        if (_open.size() >= _maxDepth)
            return refuse("a nesting depth of at most " + std::to_string(_maxDepth) + " (limit maxJsonDepth)");
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

    JsonTree& _tree;
    std::size_t _letters = 0; ///< of strings and keys
    std::size_t _maxLetters;
    std::size_t _maxDepth;
    std::size_t _maxElements;
    std::size_t _maxValues;
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

Result<JsonTree> readJson(std::string_view text, const ImportOptions& options, Report& report)
{
    if (text.size() >= std::numeric_limits<std::uint32_t>::max())
        return Error{"JSON: expected a text of less than 4 GiB, found " + std::to_string(text.size()) + " bytes"};
    JsonTree tree;
    TreeBuilder builder(tree, options);
    if (!nlohmann::json::sax_parse(text.begin(), text.end(), &builder)) return Error{builder.faultText()};
    if (const std::optional<Error> more = checkEnd(text, report)) return *more;
    if (!tree.root().is(JsonTree::Type::Object))
        return fault("JSON", "an object as the root", tree.root().description());
    for (std::size_t i = 0; i < builder.duplicates().size() && i < 100; ++i)
        report.warn(pathOf(tree, builder.duplicates()[i]) + ": the key appears twice; the last counts");
    return tree;
}

} // namespace osgGpuAnimation::gltf
