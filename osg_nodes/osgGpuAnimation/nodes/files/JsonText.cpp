// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/math/detail/RegularFile.h>
#include <osgGpuAnimation/nodes/files/JsonText.h>

#include <algorithm>
#include <set>

namespace osgGpuAnimation::json
{

namespace
{

constexpr std::size_t maxText = 1 << 16;
constexpr int deepest = 256;

} // namespace

Result<std::string> readJsonFile(const std::string& file)
{
    const Result<std::string> text = RegularFile::readWhole(file, maxText);
    if (!text) return Error{file + ": " + text.error().message};
    return text;
}

Result<void> readJson(const std::string& text, const std::function<void(const Json&)>& read)
{
    if (text.size() > maxText)
        return Error{std::to_string(text.size()) + " bytes, at most " + std::to_string(maxText) + " are read"};
    std::vector<std::set<std::string>> members; // of each enclosing object
    // Rejects deep nesting and duplicate members, which the parser alone accepts.
    const auto watch = [&](int depth, Json::parse_event_t event, const Json& parsed)
    {
        using Event = Json::parse_event_t;
        if (event == Event::object_start || event == Event::array_start)
        {
            if (depth >= deepest) throw JsonFault{"nested more than " + std::to_string(deepest) + " deep"};
            members.resize(static_cast<std::size_t>(depth) + 1);
            members.back().clear();
        }
        if (event == Event::key)
        {
            const std::string& name = parsed.get_ref<const std::string&>();
            if (!members[static_cast<std::size_t>(depth) - 1].insert(name).second)
                throw JsonFault{"member \"" + name + "\" comes twice"};
        }
        return true;
    };
    try
    {
        read(Json::parse(text, watch));
        return {};
    }
    catch (const JsonFault& fault)
    {
        return Error{fault.message};
    }
    catch (const nlohmann::json::exception& exception)
    {
        const std::string what = exception.what(); // [json.exception…] parse error …
        return Error{"JSON syntax: " + what.substr(what.find("] ") + 2)};
    }
}

void expect(bool isExpected, const std::string& where, const char* expected, const Json& found)
{
    if (!isExpected) throw JsonFault{where + ": expected " + expected + ", found " + found.type_name()};
}

void checkObject(const Json& value, const std::string& where, std::initializer_list<const char*> known)
{
    expect(value.is_object(), where, "an object", value);
    for (const auto& member : value.items())
        if (std::find(known.begin(), known.end(), member.key()) == known.end())
            throw JsonFault{where + ": unknown member \"" + member.key() + "\""};
}

void requireMember(const Json& object, const char* name, const std::string& where)
{
    if (!object.contains(name)) throw JsonFault{where + ": it has no \"" + name + "\""};
}

void readText(const Json& object, const char* name, const std::string& where, std::string& out)
{
    const auto found = object.find(name);
    if (found == object.end()) return;
    expect(found->is_string(), where + "." + name, "a string", *found);
    out = found->get<std::string>();
}

void readNumber(const Json& object, const char* name, const std::string& where, double& out)
{
    const auto found = object.find(name);
    if (found == object.end()) return;
    expect(found->is_number(), where + "." + name, "a number", *found);
    out = found->get<double>();
}

std::vector<std::string> toTexts(const Json& json, const std::string& where)
{
    std::vector<std::string> texts;
    const auto add = [&](const Json& text)
    {
        expect(text.is_string(), where, "a string", text);
        texts.push_back(text.get<std::string>());
    };
    if (json.is_array())
        std::for_each(json.begin(), json.end(), add);
    else
        add(json);
    return texts;
}

} // namespace osgGpuAnimation::json
