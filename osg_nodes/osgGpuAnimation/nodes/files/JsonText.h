// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/Result.h>

#include <nlohmann/json.hpp>

#include <functional>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

// Short JSON texts of applications: state graphs and outfits. Messages name the member, what was expected and found.
// exports.map hides these functions: an application may have another nlohmann_json.
namespace osgGpuAnimation::json
{

/// Keeps the order of the members.
using Json = nlohmann::ordered_json;

/// An error in a member; readJson() catches it.
struct JsonFault
{
    std::string message;
};

/// The text of a file of at most 64 KiB. Errors start with the name of the file.
Result<std::string> readJsonFile(const std::string& file);

/// Calls read() with what the text describes. Errors: invalid JSON; a text of more than 64 KiB or with more than 256
/// nested levels; a duplicate member; the faults that read() throws.
Result<void> readJson(const std::string& text, const std::function<void(const Json&)>& read);

// where: the place of the value in the text. All throw a JsonFault.

/// expected: "a string". found: the value, of which the message names the type.
void expect(bool isExpected, const std::string& where, const char* expected, const Json& found);
/// The value is an object, and its members are among the known ones.
void checkObject(const Json& value, const std::string& where, std::initializer_list<const char*> known);
void requireMember(const Json& object, const char* name, const std::string& where);
/// Leaves out unchanged if the object has no such member.
void readText(const Json& object, const char* name, const std::string& where, std::string& out);
void readNumber(const Json& object, const char* name, const std::string& where, double& out); ///< As readText().
/// One string or an array of strings.
std::vector<std::string> toTexts(const Json& json, const std::string& where);

/// As readText(), for one of several words.
template <typename Value>
void readWord(const Json& object, const char* name, const std::string& where,
              std::initializer_list<std::pair<const char*, Value>> words, Value& out)
{
    std::string text;
    readText(object, name, where, text);
    if (!object.contains(name)) return;
    std::string known;
    for (const auto& [word, value] : words)
    {
        known += (known.empty() ? "\"" : ", \"") + std::string(word) + "\"";
        if (text != word) continue;
        out = value;
        return;
    }
    throw JsonFault{where + "." + name + ": \"" + text + "\" is not one of " + known};
}

} // namespace osgGpuAnimation::json
