// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/StateGraphFile.h>

#include <osgGpuAnimation/nodes/files/JsonText.h>

namespace osgGpuAnimation
{

using namespace json;

namespace
{

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
    StateGraphDescription description;
    const Result<void> read = readJson(json, [&](const Json& text) { description = toDescription(text); });
    if (!read) return read.error();
    return StateGraph::create(set, description);
}

Result<std::shared_ptr<const StateGraph>> readStateGraphFile(const AnimationSet& set, const std::string& file)
{
    const Result<std::string> text = readJsonFile(file);
    if (!text) return text.error();
    Result<std::shared_ptr<const StateGraph>> graph = parseStateGraph(set, text.value());
    if (!graph) return Error{file + ": " + graph.error().message};
    return graph;
}

} // namespace osgGpuAnimation
