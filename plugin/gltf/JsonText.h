// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// A JSON text from which the data URIs of buffers and images were taken: the parser keeps several copies of each
/// string that it reads, and these can be nearly all of a file. They stay where they are, in the caller's bytes, which
/// must outlive this and what is made of it. Short ones, and those with escapes or beyond ASCII, are left to the
/// parser.
class JsonText
{
public:
    /// Never fails: what is no JSON is for the parser to say, which meets the same fault at the same string.
    explicit JsonText(std::string_view text);

    JsonText(const JsonText&) = delete;
    JsonText& operator=(const JsonText&) = delete;

    std::string_view text() const { return _data.empty() ? _whole : std::string_view(_shortened); }
    /// The data URI in whose place there is an empty string; string: its number in the text, keys count. To be asked
    /// for rising numbers.
    std::optional<std::string_view> dataAt(std::size_t string);

    /// At least as many as it has values: one, and one more for each comma and opening bracket outside strings.
    std::size_t mostValues() const { return _mostValues; }
    std::size_t dataBytes() const { return _whole.size() - text().size(); } ///< of all that was taken out
    /// Of the strings and keys that the parser gets: all that were not taken out.
    std::size_t otherBytes() const { return _otherBytes; }

private:
    void readString(std::size_t begin, std::size_t end, bool isPlain);
    void shorten();

    std::string_view _whole;
    std::string _shortened;
    std::vector<std::pair<std::size_t, std::string_view>> _data; ///< by the number of the string
    std::size_t _nextData = 0;
    std::size_t _strings = 0;
    std::size_t _otherBytes = 0;
    std::size_t _mostValues = 1;
    std::ptrdiff_t _depth = 0;
    std::string_view _list; ///< the last key of the root object
    std::string_view _key;
};

} // namespace osgGpuAnimation::gltf
