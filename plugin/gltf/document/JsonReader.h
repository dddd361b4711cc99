// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/document/JsonTree.h"
#include "gltf/file/Report.h"
#include "gltf/ImportOptions.h"

#include <osgGpuAnimation/math/Result.h>

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// A JSON text without the data URIs of buffers and images: the parser keeps several copies of each string, and data
/// URIs can be nearly all of a file. They stay in the caller's bytes, which must outlive this object and the tree. The
/// parser reads short data URIs, and those with escapes or beyond ASCII, itself.
class JsonText
{
public:
    /// Never fails: the parser reports faults in the text, at the same string.
    explicit JsonText(std::string_view text);

    JsonText(const JsonText&) = delete;
    JsonText& operator=(const JsonText&) = delete;

    std::string_view text() const { return _data.empty() ? _whole : std::string_view(_shortened); }
    /// The data URI that an empty string replaces; string: its number in the text, keys count. Call it with rising
    /// numbers.
    std::optional<std::string_view> dataAt(std::size_t string);

    /// An upper bound of the number of values: one, and one more for each comma and opening bracket outside strings.
    std::size_t mostValues() const { return _mostValues; }
    std::size_t dataBytes() const { return _whole.size() - text().size(); } ///< removed
    /// Bytes of the strings and keys that the parser reads.
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

/// Parses a JSON text within the limits of the options, without recursion: strict syntax, UTF-8 and numbers that fit a
/// double (section 2.7). Of two members with one key the last one is used, with a warning.
/// Errors: a fault in the text, with its position; more depth, elements or values than the limits allow; a root that is
/// not an object.
Result<JsonTree> readJson(std::string_view text, const ImportOptions& options, Report& report);

} // namespace osgGpuAnimation::gltf
