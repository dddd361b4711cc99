// SPDX-License-Identifier: MIT
#include "gltf/import/Clips.h"

#include "gltf/data/Accessor.h"
#include "gltf/data/AnimationPointers.h"
#include "gltf/file/Elements.h"

#include <osgGpuAnimation/animation/bounds/TransformBound.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <set>
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

/// subject: the animation, for messages. begin: the time in the file at which the clip begins.
std::vector<ClipMarker> readMarkers(const tinygltf::Value& extras, double begin, const std::string& subject,
                                    Report& report)
{
    std::vector<ClipMarker> result;
    if (!extras.IsObject() || !extras.Has("markers")) return result;
    const tinygltf::Value& markers = extras.Get("markers");
    if (!markers.IsArray()) report.warn(subject + ".extras.markers: no array; markers skipped");
    for (std::size_t i = 0; markers.IsArray() && i < markers.ArrayLen(); ++i)
    {
        const tinygltf::Value& marker = markers.Get(static_cast<int>(i));
        const std::string fault = faultOf(marker);
        if (fault.empty())
            result.push_back({marker.Get("time").GetNumberAsDouble() - begin, marker.Get("name").Get<std::string>()});
        else
            report.warn(subject + ".extras.markers[" + std::to_string(i) + "]: " + fault + "; marker skipped");
    }
    return result;
}

/// Of keys with equal times the last one remains.
void dropRepeatedKeys(Channel& channel)
{
    const std::size_t perKey = channel.values.size() / channel.times.size();
    std::size_t kept = 0;
    for (std::size_t key = 0; key < channel.times.size(); ++key)
    {
        if (kept > 0 && channel.times[kept - 1] == channel.times[key]) --kept;
        channel.times[kept] = channel.times[key];
        for (std::size_t i = 0; i < perKey; ++i)
            channel.values[kept * perKey + i] = channel.values[key * perKey + i];
        ++kept;
    }
    channel.times.resize(kept);
    channel.values.resize(kept * perKey);
}

/// Reads one animation of the file after the other.
class ClipReader
{
public:
    ClipReader(const tinygltf::Model& model, const Joints& joints, const Morphs& morphs, const std::string& fileName,
               MemoryBudget& budget, Report& report)
        : _model(model), _joints(joints), _morphs(morphs), _fileName(fileName), _budget(budget), _report(report),
          _builder(joints.skeleton, morphs.weights)
    {
    }

    std::optional<Clip> read(std::size_t index)
    {
        const tinygltf::Animation& animation = _model.animations[index];
        _clip = namedElement("animations", index, animation.name);
        _channel.clear();
        _channels.clear();
        _channelBytes = 0;
        if (animation.channels.empty()) return std::nullopt; // the document's check has said so
        bool good = true;
        for (std::size_t channel = 0; channel < animation.channels.size() && good; ++channel)
            good = readChannel(animation, channel);
        const double begin = good ? shiftToZero() : 0.0;
        good = good && addChannels();
        const std::size_t bytes = _builder.byteSize();
        if (good && !_budget.take(bytes))
            good = fail("its keyframes would take " + std::to_string(bytes) + " bytes, " + _budget.limitText());
        if (!good)
        {
            _builder = ClipBuilder(_joints.skeleton, _morphs.weights);
            return std::nullopt;
        }
        Clip clip = _builder.build(nameOf(animation, index));
        if (!fits(_joints.skeleton, clip))
        {
            fail("it takes joints or weights " + outOfRangeText());
            return std::nullopt;
        }
        Result<Clip> marked = clip.withMarkers(readMarkers(animation.extras, begin, _clip, _report));
        return marked ? std::move(marked.value()) : std::move(clip);
    }

private:
    struct ReadChannel
    {
        std::size_t index; ///< in the animation
        int input;         ///< the accessor of its times
        Channel channel;
    };

    std::string nameOf(const tinygltf::Animation& animation, std::size_t index) const
    {
        if (animation.name.empty()) return "clip " + std::to_string(index);
        if (_fileName.empty() || !isGenericClipName(animation.name)) return animation.name;
        const auto isInTheWay = [&](const tinygltf::Animation& other)
        { return &other != &animation && (isGenericClipName(other.name) || other.name == _fileName); };
        const bool isAlone = std::none_of(_model.animations.begin(), _model.animations.end(), isInTheWay);
        return isAlone ? _fileName : animation.name;
    }

    // These return false, with a warning, if the clip is at fault.

    bool readChannel(const tinygltf::Animation& animation, std::size_t index)
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
        const tinygltf::Accessor& output = elementOf(_model.accessors, sampler.output);
        _channelBytes +=
            (elementOf(_model.accessors, sampler.input).count + output.count * componentCount(output)) * sizeof(double);
        if (_channelBytes > _budget.left()) return fail("its keys take too many bytes, " + _budget.limitText());
        channel.times = readDoubles(_model, sampler.input);
        channel.values = readDoubles(_model, sampler.output);
        if (property && property->member->isBoolean)
            for (double& value : channel.values)
                value = value == 0.0 ? 0.0 : 1.0;
        _channels.push_back({index, sampler.input, std::move(channel)});
        return true;
    }

    bool addChannels()
    {
        bool any = _channels.empty(); // a clip without a target shows the rest pose
        for (ReadChannel& read : _channels)
        {
            _channel = "channels[" + std::to_string(read.index) + "]";
            if (!mendTimes(read.input, read.channel)) continue;
            const Result<void> added = _builder.add(std::move(read.channel));
            if (!added) return fail(added.error().message);
            any = true;
        }
        _channel.clear();
        return any || fail("no channel is left");
    }

    bool fail(const std::string& why)
    {
        _report.warn(_clip + (_channel.empty() ? "" : "." + _channel) + ": " + why + "; clip skipped");
        return false;
    }

    /// Where the times begin before 0, the clip begins there. Returns that time.
    double shiftToZero()
    {
        double begin = 0.0;
        for (const ReadChannel& read : _channels) // but those that mendTimes() leaves out
            if (std::is_sorted(read.channel.times.begin(), read.channel.times.end()))
                begin = std::min(begin, read.channel.times.front());
        if (begin == 0.0) return begin;
        _report.warn(_clip + ": expected times from 0 on, found " + numberText(begin) + "; the clip begins there");
        for (ReadChannel& read : _channels)
            for (double& time : read.channel.times)
                time = static_cast<double>(static_cast<float>(time - begin));
        return begin;
    }

    /// False if a time is less than the one before it: its key may be misplaced or mistyped.
    bool mendTimes(int input, Channel& channel)
    {
        const auto end = channel.times.end();
        const auto equal = std::adjacent_find(channel.times.begin(), end, std::greater_equal<>());
        if (equal == end) return true;
        const auto less = std::is_sorted_until(equal, end);
        const bool isSorted = less == end;
        if (_faultyInputs.insert(input).second)
            _report.warn(_clip + "." + _channel + ": " + elementName("accessors", input) +
                         ": expected times that increase, found " +
                         (isSorted
                              ? numberText(*equal) + " twice; the last of such keys is used, here and in other channels"
                              : numberText(*less) + " after " + numberText(*(less - 1)) +
                                    "; this channel and others with these times are skipped"));
        if (isSorted) dropRepeatedKeys(channel);
        return isSorted;
    }

    const tinygltf::Model& _model;
    const Joints& _joints;
    const Morphs& _morphs;
    const std::string& _fileName;
    MemoryBudget& _budget;
    Report& _report;
    ClipBuilder _builder;
    std::string _clip;    ///< the animation that is being read, for messages
    std::string _channel; ///< its channel
    std::vector<ReadChannel> _channels;
    std::set<int> _faultyInputs; ///< accessors of times of which it has warned
    std::size_t _channelBytes =
        0; ///< of the keys read for this clip; freed with the channels, so only compared with the budget
};

} // namespace

bool isGenericClipName(const std::string& name)
{
    return name.find("mixamo.com") != std::string::npos || name == "Take 001" || name == "Motion";
}

Clips readClips(const tinygltf::Model& model, const Joints& joints, const Morphs& morphs, const std::string& fileName,
                MemoryBudget& budget, Report& report)
{
    Clips result;
    ClipReader reader(model, joints, morphs, fileName, budget, report);
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
