// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/Result.h>

#include <charconv>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// The messages of an import: warnings (an element of the file was left out or mended) and notes.
/// Each names its element: `animations[2].channels[4]: 10 times but 9 values; channel skipped`.
struct Messages
{
    std::vector<std::string> warnings;
    std::vector<std::string> notes; ///< not faults, for example an unknown extension in extensionsUsed
    /// What the caller asked for and does not get, for example a file of clips for other joints; warnings, too.
    std::vector<std::string> unmet;
};

/// Collects the messages of one load. A file may hold a million faults: after the first hundred of a kind, one line
/// replaces the others.
///
///     report.warn("nodes[3].skin: the mesh has no JOINTS_0; the skin is ignored");
class Report
{
public:
    explicit Report(Messages& messages) : _messages(messages) {}
    void warn(std::string message);
    void note(std::string message);
    /// A warning of both, about a request of the caller: `clips "run.glb": the file has no clips`, what follows from
    /// it.
    void unmet(const std::string& message, const std::string& consequence);

private:
    Messages& _messages;
    std::size_t _warnings = 0;
    std::size_t _notes = 0;
};

// How messages name the parts of a document: accessors[3].byteOffset, animations[2].channels[4].target.path.

template <typename Index>
std::string elementName(std::string_view collection, Index index)
{
    return std::string(collection) + '[' + std::to_string(index) + ']';
}

/// elementName("animations", 2, "channels", 4) is animations[2].channels[4].
template <typename Index, typename... Rest>
std::string elementName(std::string_view collection, Index index, std::string_view inner, const Rest&... rest)
{
    std::string name = elementName(collection, index) + '.';
    if constexpr (sizeof...(Rest) == 0)
        name += inner;
    else
        name += elementName(inner, rest...);
    return name;
}

/// A primitive of a mesh. A file may have millions, so their names become text in messages only.
struct PrimitiveName
{
    std::size_t mesh = 0;
    std::size_t primitive = 0;

    std::string text() const { return elementName("meshes", mesh, "primitives", primitive); }
    /// meshes[3].primitives[0].attributes, or with a target meshes[3].primitives[0].targets[1].
    std::string attributes(int target = -1) const
    {
        return text() + '.' + (target < 0 ? std::string("attributes") : elementName("targets", target));
    }
};

/// Text of the file for a message: in quotation marks, clipped, printable ASCII only.
std::string quoted(std::string_view text);
inline std::string quoted(const std::string& text) // not std::quoted
{
    return quoted(std::string_view(text));
}

/// The same without the quotation marks.
std::string printable(std::string_view text, std::size_t max = 80);
/// quotedNames() of the names, each made printable.
std::string namesText(std::vector<std::string> names);
/// The shortest text that reads back as the number: 8, 0.5, 1e+30.
std::string numberText(double number);

/// `element: expected …, found …`
Error fault(std::string_view element, std::string_view expected, std::string_view found);
inline Error fault(std::string_view element, std::string_view expected, std::size_t found)
{
    return fault(element, expected, std::to_string(found));
}

/// `expected …, found …`, for callers that name the element.
Error unexpected(const std::string& expected, const std::string& found);

/// `subject needs library, without which this osgGpuAnimation was built`
Error missingLibrary(const std::string& subject, const std::string& library);

/// An element with its name in the file, for messages: `animations[2] "Run"`.
template <typename Index>
std::string namedElement(std::string_view collection, Index index, std::string_view name)
{
    return elementName(collection, index) + (name.empty() ? "" : ' ' + quoted(name));
}

/// The number that the whole text represents, in any locale; none if it is not a number or does not fit Number:
/// parsedNumber<int>("1x") is none.
template <typename Number>
std::optional<Number> parsedNumber(std::string_view text)
{
    Number number = 0;
    const char* const end = text.data() + text.size();
    const std::from_chars_result read = std::from_chars(text.data(), end, number);
    return read.ec == std::errc() && read.ptr == end ? std::optional<Number>(number) : std::nullopt;
}

} // namespace osgGpuAnimation::gltf
