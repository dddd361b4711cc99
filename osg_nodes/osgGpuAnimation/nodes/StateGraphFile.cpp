// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/StateGraphFile.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <initializer_list>
#include <iterator>
#include <set>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

// Keeps the order of the members: without "start" the first state is the start.
using Json = nlohmann::ordered_json;

constexpr std::size_t maxText = 1 << 16;
constexpr int deepest = 256;

/// An error in a member; parseStateGraph() catches it.
struct Fault
{
    std::string message;
};

/// Rejects deep nesting and duplicate members, which the parser alone accepts.
class ParserWatch
{
public:
    bool operator()(int depth, Json::parse_event_t event, const Json& parsed)
    {
        using Event = Json::parse_event_t;
        if (event == Event::object_start || event == Event::array_start)
        {
            if (depth >= deepest) throw Fault{"nested more than " + std::to_string(deepest) + " deep"};
            _members.resize(static_cast<std::size_t>(depth) + 1);
            _members.back().clear();
        }
        if (event == Event::key)
        {
            const std::string& name = parsed.get_ref<const std::string&>();
            if (!_members[static_cast<std::size_t>(depth) - 1].insert(name).second)
                throw Fault{"member \"" + name + "\" comes twice"};
        }
        return true;
    }

private:
    std::vector<std::set<std::string>> _members; ///< of each enclosing object
};

Error tooLong(std::uintmax_t size)
{
    return Error{std::to_string(size) + " bytes, at most " + std::to_string(maxText) + " are read"};
}

template <typename T>
using Words = std::initializer_list<std::pair<const char*, T>>;

void expect(bool isExpected, const std::string& where, const char* expected, const Json& found)
{
    if (!isExpected) throw Fault{where + ": expected " + expected + ", found " + found.type_name()};
}

void checkObject(const Json& value, const std::string& where, std::initializer_list<const char*> known)
{
    expect(value.is_object(), where, "an object", value);
    for (const auto& member : value.items())
        if (std::find(known.begin(), known.end(), member.key()) == known.end())
            throw Fault{where + ": unknown member \"" + member.key() + "\""};
}

void readText(const Json& object, const char* name, const std::string& where, std::string& out)
{
    const auto found = object.find(name);
    if (found == object.end()) return;
    expect(found->is_string(), where + "." + name, "a string", *found);
    out = found->get<std::string>();
}

void requireMember(const Json& object, const char* name, const std::string& where)
{
    if (!object.contains(name)) throw Fault{where + ": it has no \"" + name + "\""};
}

void readNumber(const Json& object, const char* name, const std::string& where, double& out)
{
    const auto found = object.find(name);
    if (found == object.end()) return;
    expect(found->is_number(), where + "." + name, "a number", *found);
    out = found->get<double>();
}

template <typename T>
void readWord(const Json& object, const char* name, const std::string& where, Words<T> words, T& out)
{
    std::string text;
    readText(object, name, where, text);
    if (object.find(name) == object.end()) return;
    std::string known;
    for (const auto& [word, value] : words)
    {
        known += (known.empty() ? "\"" : ", \"") + std::string(word) + "\"";
        if (text != word) continue;
        out = value;
        return;
    }
    throw Fault{where + "." + name + ": \"" + text + "\" is not one of " + known};
}

/// One string or an array of strings.
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

BlendSpace::Position toPosition(const Json& json, const std::string& where)
{
    checkObject(json, where, {"clip", "at"});
    requireMember(json, "clip", where);
    requireMember(json, "at", where);
    BlendSpace::Position position;
    readText(json, "clip", where, position.clip);
    const Json& at = json["at"];
    const bool isPair = at.is_array() && at.size() == 2 && at[0].is_number() && at[1].is_number();
    expect(isPair || at.is_number(), where + ".at", "a number or an array of two numbers", at);
    position.x = isPair ? at[0].get<double>() : at.get<double>();
    position.y = isPair ? at[1].get<double>() : 0.0;
    return position;
}

StateBlendDescription toBlend(const Json& json, const std::string& where)
{
    requireMember(json, "parameter", where);
    StateBlendDescription blend;
    const Json& positions = json["blend"];
    expect(positions.is_array(), where + ".blend", "an array", positions);
    for (const Json& position : positions)
        blend.positions.push_back(
            toPosition(position, where + ".blend[" + std::to_string(blend.positions.size()) + "]"));
    blend.parameters = toTexts(json["parameter"], where + ".parameter");
    if (json.contains("markers")) blend.syncMarkers = toTexts(json["markers"], where + ".markers");
    return blend;
}

StateDescription toState(const std::string& name, const Json& json)
{
    const std::string where = "states." + name;
    StateDescription state;
    state.name = name;
    if (json.is_object() && json.contains("blend"))
    {
        checkObject(json, where, {"blend", "parameter", "markers", "loop", "speed", "groundSpeed"});
        state.blend = toBlend(json, where);
    }
    else
    {
        checkObject(json, where, {"clip", "loop", "speed", "groundSpeed"});
        requireMember(json, "clip", where);
    }
    readText(json, "clip", where, state.clip);
    readNumber(json, "speed", where, state.speed);
    readText(json, "groundSpeed", where, state.groundSpeed);
    readWord<LoopMode>(json, "loop", where,
                       {{"loop", LoopMode::Loop}, {"once", LoopMode::Once}, {"pingpong", LoopMode::PingPong}},
                       state.loopMode);
    return state;
}

TransitionDescription toTransition(const Json& json, const std::string& where)
{
    checkObject(json, where, {"from", "to", "when", "seconds", "curve", "sync"});
    requireMember(json, "to", where);
    TransitionDescription transition;
    readText(json, "from", where, transition.from);
    readText(json, "to", where, transition.to);
    readNumber(json, "seconds", where, transition.seconds);
    readWord<FadeCurve>(json, "curve", where, {{"linear", FadeCurve::Linear}, {"smooth", FadeCurve::Smooth}},
                        transition.curve);
    readWord<Sync>(json, "sync", where, {{"start", Sync::Start}, {"phase", Sync::Phase}}, transition.sync);
    if (json.contains("when")) transition.when = toTexts(json["when"], where + ".when");
    return transition;
}

StateGraphDescription toDescription(const Json& json)
{
    checkObject(json, "the file", {"start", "states", "transitions", "sharedPhase"});
    StateGraphDescription description;
    if (const auto shared = json.find("sharedPhase"); shared != json.end())
    {
        expect(shared->is_boolean(), "sharedPhase", "true or false", *shared);
        description.isPhaseShared = shared->get<bool>();
    }
    readText(json, "start", "the file", description.start);
    if (const auto states = json.find("states"); states != json.end())
    {
        expect(states->is_object(), "states", "an object", *states);
        for (const auto& state : states->items())
            description.states.push_back(toState(state.key(), state.value()));
    }
    if (const auto transitions = json.find("transitions"); transitions != json.end())
    {
        expect(transitions->is_array(), "transitions", "an array", *transitions);
        for (const Json& transition : *transitions)
            description.transitions.push_back(
                toTransition(transition, "transitions[" + std::to_string(description.transitions.size()) + "]"));
    }
    return description;
}

} // namespace

Result<std::shared_ptr<const StateGraph>> parseStateGraph(const AnimationSet& set, const std::string& json)
{
    if (json.size() > maxText) return tooLong(json.size());
    try
    {
        ParserWatch watch;
        return StateGraph::create(set, toDescription(Json::parse(json, std::ref(watch))));
    }
    catch (const Fault& fault)
    {
        return Error{fault.message};
    }
    catch (const nlohmann::json::exception& exception)
    {
        const std::string what = exception.what(); // [json.exception…] parse error …
        return Error{"JSON syntax: " + what.substr(what.find("] ") + 2)};
    }
}

Result<std::shared_ptr<const StateGraph>> readStateGraphFile(const AnimationSet& set, const std::string& file)
{
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(file, error);
    if (!std::filesystem::exists(status)) return Error{file + ": there is no such file"};
    if (std::filesystem::is_directory(status)) return Error{file + ": is not a file but a folder"};
    if (!std::filesystem::is_regular_file(status)) return Error{file + ": is not a plain file"};
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    if (error) return Error{file + ": " + error.message()};
    if (size > maxText) return Error{file + ": " + tooLong(size).message};
    std::ifstream stream(file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    if (!stream.good() && !stream.eof()) return Error{file + ": cannot be read"};
    Result<std::shared_ptr<const StateGraph>> graph = parseStateGraph(set, text);
    if (!graph) return Error{file + ": " + graph.error().message};
    return graph;
}

} // namespace osgGpuAnimation
