// SPDX-License-Identifier: MIT
#include "gltf/Clips.h"

#include "gltf/Accessor.h"
#include "gltf/Markers.h"
#include "gltf/NamedElement.h"
#include "gltf/Reach.h"

#include <osgGpuAnimation/animation/ClipBuilder.h>

#include <optional>
#include <set>
#include <string_view>
#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

std::optional<Channel::Path> pathOf(std::string_view name)
{
    if (name == "translation") return Channel::Path::Translation;
    if (name == "rotation") return Channel::Path::Rotation;
    if (name == "scale") return Channel::Path::Scale;
    if (name == "weights") return Channel::Path::Weights;
    return std::nullopt;
}

std::optional<Channel::Interpolation> interpolationOf(std::string_view name)
{
    if (name == "STEP") return Channel::Interpolation::Step;
    if (name == "LINEAR" || name.empty()) return Channel::Interpolation::Linear;
    if (name == "CUBICSPLINE") return Channel::Interpolation::CubicSpline;
    return std::nullopt;
}

std::size_t numbersIn(const tinygltf::Model& model, int input, int output)
{
    const tinygltf::Accessor& times = model.accessors[static_cast<std::size_t>(input)];
    const tinygltf::Accessor& values = model.accessors[static_cast<std::size_t>(output)];
    return times.count + values.count * componentCount(values);
}

/// Reads one animation of the file after the other.
class ClipReader
{
public:
    ClipReader(const tinygltf::Model& model, const Joints& joints, const Morphs& morphs, DecodedBytes& budget,
               Report& report)
        : _model(model), _joints(joints), _morphs(morphs), _budget(budget), _report(report),
          _builder(joints.skeleton, morphs.weights)
    {
    }

    std::optional<Clip> read(std::size_t index);

private:
    /// False: the clip is at fault, and a warning says so.
    bool addChannel(const tinygltf::Animation& animation, std::size_t index);
    /// The joint or the morph that the channel drives; -1, with a warning, where there is none.
    int targetOf(const tinygltf::AnimationChannel& channel, Channel::Path path);
    bool fail(const std::string& why);
    void warn(const std::string& text) { _report.warn(text); }

    const tinygltf::Model& _model;
    const Joints& _joints;
    const Morphs& _morphs;
    DecodedBytes& _budget;
    Report& _report;
    ClipBuilder _builder;
    std::string _clip;    ///< the animation that is being read, for messages
    std::string _channel; ///< its channel
    std::set<std::pair<int, Channel::Path>> _driven;
    std::size_t _channelBytes = 0; ///< of the keys read for this clip so far: given back when it is built
};

bool ClipReader::fail(const std::string& why)
{
    warn(_clip + (_channel.empty() ? "" : "." + _channel) + ": " + why + "; clip skipped");
    return false;
}

int ClipReader::targetOf(const tinygltf::AnimationChannel& channel, Channel::Path path)
{
    const auto node = static_cast<std::size_t>(channel.target_node);
    if (node >= _model.nodes.size()) return -1;
    const auto where = [&] { return _clip + "." + _channel + ": "; };
    const int target = path == Channel::Path::Weights ? _morphs.ofNode[node] : _joints.ofNode[node];
    if (target < 0)
        warn(where() + namedElement("nodes", node, _model.nodes[node].name) + " has no morph targets; channel skipped");
    else if (path != Channel::Path::Weights && _joints.isSheared[node])
    {
        warn(where() + namedElement("nodes", node, _model.nodes[node].name) +
             " has a matrix that shears and cannot be animated; channel skipped");
        return -1;
    }
    else if (!_driven.emplace(channel.target_node, path).second)
    {
        warn(where() + channel.target_path + " of nodes[" + std::to_string(node) +
             "] is driven by another channel already; channel skipped");
        return -1;
    }
    return target;
}

bool ClipReader::addChannel(const tinygltf::Animation& animation, std::size_t index)
{
    const tinygltf::AnimationChannel& source = animation.channels[index];
    _channel = "channels[" + std::to_string(index) + "]";
    if (source.target_node < 0) return true;
    const std::optional<Channel::Path> path = pathOf(source.target_path);
    if (!path)
    {
        warn(_clip + "." + _channel + ": unknown path " + quoted(source.target_path) + "; channel skipped");
        return true;
    }
    Channel channel;
    channel.path = *path;
    channel.target = targetOf(source, *path);
    if (channel.target < 0) return true;
    if (source.sampler < 0 || static_cast<std::size_t>(source.sampler) >= animation.samplers.size())
        return fail("sampler " + std::to_string(source.sampler) + " of " + std::to_string(animation.samplers.size()));
    const tinygltf::AnimationSampler& sampler = animation.samplers[static_cast<std::size_t>(source.sampler)];
    const std::optional<Channel::Interpolation> interpolation = interpolationOf(sampler.interpolation);
    if (!interpolation) return fail("unknown interpolation " + quoted(sampler.interpolation));
    channel.interpolation = *interpolation;
    _channelBytes += numbersIn(_model, sampler.input, sampler.output) * sizeof(double);
    if (_channelBytes > _budget.left()) return fail("its keys take too many bytes, " + _budget.limitText());
    channel.times = readDoubles(_model, sampler.input);
    channel.values = readDoubles(_model, sampler.output);
    const Result<bool> added = _builder.add(std::move(channel));
    return added ? true : fail(added.error().message);
}

std::optional<Clip> ClipReader::read(std::size_t index)
{
    const tinygltf::Animation& animation = _model.animations[index];
    _clip = namedElement("animations", index, animation.name);
    _channel.clear();
    _driven.clear();
    _channelBytes = 0;
    if (animation.channels.empty()) return std::nullopt; // emptied by the validation, which has said why
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
        fail("it takes joints or weights " + beyondFarthest());
        return std::nullopt;
    }
    Result<Clip> marked = clip.withMarkers(readMarkers(animation.extras, _clip, _report));
    return marked ? std::move(marked.value()) : std::move(clip);
}

} // namespace

Clips readClips(const tinygltf::Model& model, const Joints& joints, const Morphs& morphs, DecodedBytes& budget,
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
