// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/StateGraphFile.h>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <utility>

namespace osgGpuAnimation
{

namespace
{

// Kept in the order in which they are written: without "start" the first state is meant.
using Json = nlohmann::ordered_json;

constexpr std::size_t largestFile = 1 << 20;

/// What is at fault with a member; caught where the text is read.
struct Fault
{
    std::string message;
};

template <typename T>
using Words = std::initializer_list<std::pair<const char*, T>>;

void checkObject(const Json& value, const std::string& where, std::initializer_list<const char*> known)
{
    if (!value.is_object()) throw Fault{where + ": expected an object, found " + value.type_name()};
    for (const auto& member : value.items())
    {
        bool isKnown = false;
        for (const char* name : known)
            isKnown = isKnown || member.key() == name;
        if (!isKnown) throw Fault{where + ": unknown member \"" + member.key() + "\""};
    }
}

void readText(const Json& object, const char* name, const std::string& where, std::string& out)
{
    const auto found = object.find(name);
    if (found == object.end()) return;
    if (!found->is_string()) throw Fault{where + "." + name + ": expected a string, found " + found->type_name()};
    out = found->get<std::string>();
}

void readNumber(const Json& object, const char* name, const std::string& where, double& out)
{
    const auto found = object.find(name);
    if (found == object.end()) return;
    if (!found->is_number()) throw Fault{where + "." + name + ": expected a number, found " + found->type_name()};
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

StateDescription toState(const std::string& name, const Json& json)
{
    const std::string where = "states." + name;
    checkObject(json, where, {"clip", "loop", "speed"});
    StateDescription state;
    state.name = name;
    readText(json, "clip", where, state.clip);
    readNumber(json, "speed", where, state.speed);
    readWord<LoopMode>(json, "loop", where,
                       {{"loop", LoopMode::Loop}, {"once", LoopMode::Once}, {"pingpong", LoopMode::PingPong}},
                       state.loopMode);
    return state;
}

std::vector<std::string> toConditions(const Json& json, const std::string& where)
{
    std::vector<std::string> conditions;
    const Json list = json.is_array() ? json : Json::array({json});
    for (const Json& condition : list)
    {
        if (!condition.is_string()) throw Fault{where + ": expected a string, found " + condition.type_name()};
        conditions.push_back(condition.get<std::string>());
    }
    return conditions;
}

TransitionDescription toTransition(const Json& json, const std::string& where)
{
    checkObject(json, where, {"from", "to", "when", "seconds", "curve", "sync"});
    TransitionDescription transition;
    readText(json, "from", where, transition.from);
    readText(json, "to", where, transition.to);
    readNumber(json, "seconds", where, transition.seconds);
    readWord<FadeCurve>(json, "curve", where, {{"linear", FadeCurve::Linear}, {"smooth", FadeCurve::Smooth}},
                        transition.curve);
    readWord<Sync>(json, "sync", where, {{"start", Sync::Start}, {"phase", Sync::Phase}}, transition.sync);
    if (json.contains("when")) transition.when = toConditions(json["when"], where + ".when");
    return transition;
}

StateGraphDescription toDescription(const Json& json)
{
    checkObject(json, "the file", {"start", "states", "transitions"});
    StateGraphDescription description;
    readText(json, "start", "the file", description.start);
    const Json states = json.value("states", Json::object());
    if (!states.is_object()) throw Fault{std::string("states: expected an object, found ") + states.type_name()};
    for (const auto& state : states.items())
        description.states.push_back(toState(state.key(), state.value()));
    const Json transitions = json.value("transitions", Json::array());
    if (!transitions.is_array())
        throw Fault{std::string("transitions: expected an array, found ") + transitions.type_name()};
    for (std::size_t t = 0; t < transitions.size(); ++t)
        description.transitions.push_back(toTransition(transitions[t], "transitions[" + std::to_string(t) + "]"));
    return description;
}

} // namespace

Result<std::shared_ptr<const StateGraph>> parseStateGraph(const AnimationSet& set, const std::string& json)
{
    try
    {
        return StateGraph::create(set, toDescription(Json::parse(json)));
    }
    catch (const Fault& fault)
    {
        return Error{fault.message};
    }
    catch (const nlohmann::json::exception& exception)
    {
        return Error{exception.what()};
    }
}

Result<std::shared_ptr<const StateGraph>> readStateGraphFile(const AnimationSet& set, const std::string& file)
{
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) return Error{file + ": there is no such file"};
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    if (error || size > largestFile)
        return Error{file + ": " + std::to_string(size) + " bytes, at most " + std::to_string(largestFile) +
                     " are read"};
    std::ifstream stream(file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    if (!stream.good() && !stream.eof()) return Error{file + ": cannot be read"};
    Result<std::shared_ptr<const StateGraph>> graph = parseStateGraph(set, text);
    if (!graph) return Error{file + ": " + graph.error().message};
    return graph;
}

} // namespace osgGpuAnimation
