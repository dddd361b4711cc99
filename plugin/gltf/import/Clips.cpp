// SPDX-License-Identifier: MIT
#include "gltf/import/Clips.h"

#include "gltf/data/Accessor.h"
#include "gltf/data/AnimationPointers.h"
#include "gltf/file/Elements.h"

#include <osgGpuAnimation/animation/bounds/TransformBound.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>

#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

Channel::Path pathOf(std::string_view name)
{
    if (name == "translation") return Channel::Path::Translation;
    if (name == "rotation") return Channel::Path::Rotation;
    if (name == "scale") return Channel::Path::Scale;
    return Channel::Path::Weights;
}

Channel::Interpolation interpolationOf(std::string_view name)
{
    if (name == "STEP") return Channel::Interpolation::Step;
    if (name == "CUBICSPLINE") return Channel::Interpolation::CubicSpline;
    return Channel::Interpolation::Linear;
}

/// The fault of a marker; empty if it has none.
const char* faultOf(const tinygltf::Value& marker)
{
    if (!marker.IsObject()) return "no object";
    const tinygltf::Value& time = marker.Get("time");
    if (!time.IsNumber()) return "no number as its time";
    if (!std::isfinite(time.GetNumberAsDouble()) || time.GetNumberAsDouble() < 0.0) return "a time below 0";
    return marker.Get("name").IsString() ? "" : "no text as its name";
}

/// subject: the animation, for messages.
std::vector<ClipMarker> readMarkers(const tinygltf::Value& extras, const std::string& subject, Report& report)
{
    std::vector<ClipMarker> result;
    if (!extras.IsObject() || !extras.Has("markers")) return result;
    const tinygltf::Value& markers = extras.Get("markers");
    if (!markers.IsArray()) report.warn(subject + ".extras.markers: no array; markers skipped");
    for (std::size_t i = 0; markers.IsArray() && i < markers.ArrayLen(); ++i)
    {
        const tinygltf::Value& marker = markers.Get(i);
        const std::string fault = faultOf(marker);
        if (fault.empty())
            result.push_back({marker.Get("time").GetNumberAsDouble(), marker.Get("name").Get<std::string>()});
        else
            report.warn(subject + ".extras.markers[" + std::to_string(i) + "]: " + fault + "; marker skipped");
    }
    return result;
}

std::size_t numbersIn(const tinygltf::Model& model, int input, int output)
{
    const tinygltf::Accessor& times = elementOf(model.accessors, input);
    const tinygltf::Accessor& values = elementOf(model.accessors, output);
    return times.count + values.count * componentCount(values);
}

/// Reads one animation of the file after the other.
class ClipReader
{
public:
    ClipReader(const tinygltf::Model& model, const Joints& joints, const Morphs& morphs, MemoryBudget& budget,
               Report& report)
        : _model(model), _joints(joints), _morphs(morphs), _budget(budget), _report(report),
          _builder(joints.skeleton, morphs.weights)
    {
    }

    std::optional<Clip> read(std::size_t index);

private:
    /// False, with a warning, if the clip is at fault.
    bool addChannel(const tinygltf::Animation& animation, std::size_t index);
    bool fail(const std::string& why);

    const tinygltf::Model& _model;
    const Joints& _joints;
    const Morphs& _morphs;
    MemoryBudget& _budget;
    Report& _report;
    ClipBuilder _builder;
    std::string _clip;    ///< the animation that is being read, for messages
    std::string _channel; ///< its channel
    std::size_t _channelBytes =
        0; ///< of the keys read for this clip; freed with the channels, so only compared with the budget
};

bool ClipReader::fail(const std::string& why)
{
    _report.warn(_clip + (_channel.empty() ? "" : "." + _channel) + ": " + why + "; clip skipped");
    return false;
}

bool ClipReader::addChannel(const tinygltf::Animation& animation, std::size_t index)
{
    const tinygltf::AnimationChannel& source = animation.channels[index];
    _channel = "channels[" + std::to_string(index) + "]";
    const std::optional<PropertyPointer> property = propertyOf(source);
    if (source.target_node < 0 && !property) return true;
    const auto node = static_cast<std::size_t>(source.target_node); // of no property
    const tinygltf::AnimationSampler& sampler = elementOf(animation.samplers, source.sampler);
    Channel channel;
    channel.path = property ? Channel::Path::Weights : pathOf(source.target_path);
    channel.target = property                                 ? _morphs.ofPointer.at(source.target_path)
                     : channel.path == Channel::Path::Weights ? _morphs.ofNode[node]
                                                              : _joints.ofNode[node];
    channel.weight = weightOf(source);
    channel.interpolation = interpolationOf(sampler.interpolation);
    if (channel.path != Channel::Path::Weights && _joints.isSheared[node])
    {
        _report.warn(_clip + "." + _channel + ": " + namedElement("nodes", node, _model.nodes[node].name) +
                     " has a matrix that shears and cannot be animated; channel skipped");
        return true;
    }
    _channelBytes += numbersIn(_model, sampler.input, sampler.output) * sizeof(double);
    if (_channelBytes > _budget.left()) return fail("its keys take too many bytes, " + _budget.limitText());
    channel.times = readDoubles(_model, sampler.input);
    channel.values = readDoubles(_model, sampler.output);
    if (property && property->member->isBoolean)
        for (double& value : channel.values)
            value = value == 0.0 ? 0.0 : 1.0;
    const Result<void> added = _builder.add(std::move(channel));
    return added ? true : fail(added.error().message);
}

std::optional<Clip> ClipReader::read(std::size_t index)
{
    const tinygltf::Animation& animation = _model.animations[index];
    _clip = namedElement("animations", index, animation.name);
    _channel.clear();
    _channelBytes = 0;
    if (animation.channels.empty()) return std::nullopt; // the validation has emptied it and said why
    bool good = true;
    for (std::size_t channel = 0; channel < animation.channels.size() && good; ++channel)
        good = addChannel(animation, channel);
    _channel.clear();
    const std::size_t bytes = _builder.byteSize();
    if (good && !_budget.take(bytes))
        good = fail("its keyframes would take " + std::to_string(bytes) + " bytes, " + _budget.limitText());
    if (!good)
    {
        _builder = ClipBuilder(_joints.skeleton, _morphs.weights);
        return std::nullopt;
    }
    Clip clip = _builder.build(animation.name.empty() ? "clip " + std::to_string(index) : animation.name);
    if (!fits(_joints.skeleton, clip))
    {
        fail("it takes joints or weights " + outOfRangeText());
        return std::nullopt;
    }
    Result<Clip> marked = clip.withMarkers(readMarkers(animation.extras, _clip, _report));
    return marked ? std::move(marked.value()) : std::move(clip);
}

} // namespace

Clips readClips(const tinygltf::Model& model, const Joints& joints, const Morphs& morphs, MemoryBudget& budget,
                Report& report)
{
    Clips result;
    ClipReader reader(model, joints, morphs, budget, report);
    for (std::size_t index = 0; index < model.animations.size(); ++index)
    {
        std::optional<Clip> clip = reader.read(index);
        if (!clip) continue;
        result.clips.push_back(std::move(*clip));
        result.animationOfClip.push_back(static_cast<int>(index));
    }
    return result;
}

} // namespace osgGpuAnimation::gltf
