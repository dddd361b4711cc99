// SPDX-License-Identifier: MIT
#include "gltf/file/Report.h"

#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

const std::size_t maxOfAKind = 100;

void add(std::vector<std::string>& list, std::size_t& count, std::string message)
{
    if (count < maxOfAKind) list.push_back(std::move(message));
    if (count == maxOfAKind) list.push_back("more of the kind follow and are not listed");
    ++count;
}

} // namespace

void Report::warn(std::string message)
{
    add(_messages.warnings, _warnings, std::move(message));
}

void Report::note(std::string message)
{
    add(_messages.notes, _notes, std::move(message));
}

void Report::unmet(const std::string& message, const std::string& consequence)
{
    _messages.unmet.push_back(message);
    warn(message + "; " + consequence);
}

std::string printable(std::string_view text, std::size_t max)
{
    static const char digits[] = "0123456789abcdef";
    std::string out;
    for (char c : text.substr(0, max))
    {
        const unsigned char byte = static_cast<unsigned char>(c);
        if (byte >= 0x20 && byte < 0x7f)
            out += c;
        else
            out += std::string("\\x") + digits[byte >> 4] + digits[byte & 15];
    }
    if (text.size() > max) out += "...";
    return out;
}

std::string namesText(std::vector<std::string> names)
{
    for (std::string& name : names)
        name = printable(name);
    return quotedNames(names);
}

std::string quoted(std::string_view text)
{
    return '"' + printable(text) + '"';
}

std::string numberText(double number)
{
    char text[32];
    return std::string(text, std::to_chars(text, text + sizeof(text), number).ptr);
}

Error unexpected(const std::string& expected, const std::string& found)
{
    return Error{"expected " + expected + ", found " + found};
}

Error missingLibrary(const std::string& subject, const std::string& library)
{
    return {subject + " needs " + library + ", without which this osgGpuAnimation was built"};
}

Error fault(std::string_view element, std::string_view expected, std::string_view found)
{
    return Error{std::string(element) + ": " + unexpected(std::string(expected), std::string(found)).message};
}

} // namespace osgGpuAnimation::gltf
