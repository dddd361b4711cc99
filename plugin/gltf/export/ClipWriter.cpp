// SPDX-License-Identifier: MIT
#include "gltf/export/ClipWriter.h"

#include "gltf/export/ClipKeys.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

/// A path of a joint's channel and where its numbers are, see JointTransform::number().
struct JointPath
{
    const char* path;
    const char* type;
    std::size_t firstNumber;
    std::size_t count;
    bool isRotation;
};

constexpr JointPath jointPaths[] = {
    {"translation", "VEC3", 0, 3, false}, {"rotation", "VEC4", 4, 4, true}, {"scale", "VEC3", 8, 3, false}};

/// True for the joint that meshes that do not move follow in a crowd, see Joints in Joints.h. An import adds it again.
bool isOfImport(const Joint& joint)
{
    return joint.name.empty() && joint.parent < 0 && joint.sourceNode < 0;
}

std::vector<float> restValues(const AnimationSet& set, const ClipProperty& property)
{
    std::vector<float> values;
    for (std::size_t i = 0; i < property.count; ++i)
        values.push_back(
            set.restPose()[property.track + (property.firstNumber + i) / 12].number((property.firstNumber + i) % 12));
    return values;
}

void addMarkers(const std::vector<ClipMarker>& markers, nlohmann::json& animation)
{
    if (markers.empty()) return;
    nlohmann::json& all = animation["extras"]["markers"];
    std::set<std::pair<double, std::string>> known;
    for (const nlohmann::json& marker : all) // of the same clip of another character
        known.emplace(marker["time"].get<double>(), marker["name"].get<std::string>());
    for (const ClipMarker& marker : markers)
        if (known.emplace(marker.time, marker.name).second)
            all.push_back({{"time", marker.time}, {"name", marker.name}});
}

} // namespace

void ClipWriter::addChannel(nlohmann::json& animation, std::size_t node, const char* path, const char* type,
                            const ClipKeys& keys)
{
    // The slopes of a spline with keys close together may be beyond floats.
    if (!std::all_of(keys.values.begin(), keys.values.end(), [](float number) { return std::isfinite(number); }))
        return _report.warn("clip " + quoted(animation.value("name", "")) + ": the " + path + " of node " +
                            quoted(_writer.document["nodes"][node].value("name", "")) +
                            " has slopes beyond floats; left out");
    nlohmann::json sampler{{"input", _writer.addFloats(keys.times, "SCALAR", GlbWriter::Use::Times)},
                           {"output", _writer.addFloats(keys.values, type, GlbWriter::Use::Values)}};
    if (keys.interpolation != ClipKeys().interpolation) sampler["interpolation"] = keys.interpolation;
    const std::size_t number = append(animation["samplers"], std::move(sampler));
    append(animation["channels"], {{"sampler", number}, {"target", {{"node", node}, {"path", path}}}});
}

void ClipWriter::write(const WrittenCharacter& character, const Clip& clip, bool isFirst, nlohmann::json& animation)
{
    const AnimationSet& set = *character.set;
    std::vector<bool> isMoved(set.skeleton().jointCount(), false);
    for (std::size_t joint = 0; joint < isMoved.size(); ++joint)
        for (const JointPath& path : jointPaths)
        {
            const ClipProperty property{joint, path.firstNumber, path.count, path.isRotation};
            const ClipKeys keys = keysOf(clip, property, restValues(set, property));
            if (keys.times.empty()) continue;
            addChannel(animation, character.nodeOfJoint[joint], path.path, path.type, keys);
            isMoved[joint] = true;
        }
    for (std::size_t morph = 0; morph < set.morphs().size(); ++morph)
        for (const std::size_t node : character.morphNodes[morph])
        {
            const std::size_t targets = _writer.document["nodes"][node]["weights"].size();
            const std::size_t count = std::min(targets, set.morphs()[morph].defaults.size());
            const ClipProperty property{set.firstTrackOfMorph(morph), 0, count, false};
            const ClipKeys keys = keysOf(clip, property, restValues(set, property));
            if (!keys.times.empty() && count == targets) addChannel(animation, node, "weights", "SCALAR", keys);
        }
    // A joint is a node that a skin has or a clip moves: those without either keep their rest pose as keys, except the
    // one that the import adds. A clip without keys would lose its duration.
    std::vector<float> times{clip.times().front()};
    if (clip.times().back() > times.front()) times.push_back(clip.times().back());
    for (std::size_t joint = 0; joint < isMoved.size(); ++joint)
    {
        const bool isNeeded = isFirst ? !character.isInSkin[joint] : !animation.contains("channels");
        if (isMoved[joint] || !isNeeded || isOfImport(set.skeleton().joint(joint))) continue;
        const ClipProperty property{joint, 0, 3, false};
        ClipKeys keys;
        keys.times = times;
        for (std::size_t key = 0; key < times.size(); ++key)
            for (const float number : restValues(set, property))
                keys.values.push_back(number);
        addChannel(animation, character.nodeOfJoint[joint], "translation", "VEC3", keys);
    }
    if (!animation.contains("channels") && !isMoved.empty())
        addChannel(animation, character.nodeOfJoint[0], "translation", "VEC3",
                   {"LINEAR", {times.front()}, restValues(set, {0, 0, 3, false})});
}

void ClipWriter::write(const WrittenCharacter& character)
{
    std::map<std::string, std::size_t> repetitions;
    bool isFirst = true;
    for (const Clip& clip : character.set->clips())
    {
        if (clip.rootMotion())
            _report.warn("clip " + quoted(clip.name()) + ": the root motion that was taken out of it is left out");
        nlohmann::json channels = nlohmann::json::object();
        const auto [number, isNew] = _number.try_emplace({clip.name(), repetitions[clip.name()]++});
        nlohmann::json animation =
            isNew ? nlohmann::json::object() : std::move(_writer.document["animations"][number->second]);
        if (isNew && !clip.name().empty()) animation["name"] = clip.name();
        write(character, clip, isFirst, animation);
        addMarkers(clip.markers(), animation);
        isFirst = false;
        if (isNew && !animation.contains("channels"))
            _number.erase(number);
        else if (isNew)
            number->second = append(_writer.document["animations"], std::move(animation));
        else
            _writer.document["animations"][number->second] = std::move(animation);
    }
    const std::vector<MorphWeights>& morphs = character.set->morphs();
    const auto properties =
        std::count_if(morphs.begin(), morphs.end(), [](const MorphWeights& morph) { return morph.isProperty(); });
    if (properties > 0)
        _report.warn("animated properties of materials, lights, cameras and nodes: their curves are not written; " +
                     std::to_string(properties) + " keep one value");
    if (!character.set->constraints().empty())
        _report.warn("constraints: glTF has none; " + std::to_string(character.set->constraints().size()) +
                     " are left out");
}

} // namespace osgGpuAnimation::gltf
