// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/authoring/ClipBuilder.h>

#include <osgGpuAnimation/authoring/keyframes/ChannelCurve.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace osgGpuAnimation
{

namespace
{

using Path = Channel::Path;

constexpr std::size_t componentsPerTrack = MorphWeights::weightsPerBlock;
constexpr JointTransform zeroTransform{glm::vec4(0.0f), glm::vec4(0.0f), glm::vec4(0.0f)};

float rounded(double value)
{
    constexpr double max = std::numeric_limits<float>::max();
    return static_cast<float>(std::clamp(value, -max, max));
}

/// The index of a path's first number among the twelve numbers of a track.
std::size_t firstComponent(Path path)
{
    return path == Path::Rotation ? 4 : path == Path::Scale ? 8 : 0;
}

const char* nameOf(Path path)
{
    static constexpr const char* names[]{"translation", "rotation", "scale", "weights"};
    return names[static_cast<std::size_t>(path)];
}

std::size_t valuesPerKey(const Channel& channel)
{
    return channel.interpolation == Channel::Interpolation::CubicSpline ? 3 : 1;
}

/// Checks the times and rounds them to floats.
std::optional<std::string> findFaultInTimes(std::vector<double>& times)
{
    if (times.empty()) return "has no times";
    for (std::size_t i = 0; i < times.size(); ++i)
    {
        const double time = static_cast<double>(static_cast<float>(times[i]));
        const char* fault = nullptr;
        if (!std::isfinite(time))
            fault = "is not finite";
        else if (time < 0.0)
            fault = "is negative";
        else if (i > 0 && time <= times[i - 1])
            fault = "is not after the one before it";
        if (fault) return "time " + std::to_string(i) + " (" + std::to_string(times[i]) + ") " + fault;
        times[i] = time;
    }
    return std::nullopt;
}

std::optional<std::string> findFaultInValues(const Channel& channel, std::size_t componentCount)
{
    const std::size_t wanted = channel.times.size() * valuesPerKey(channel) * componentCount;
    if (channel.values.size() != wanted)
        return std::to_string(channel.times.size()) + " times ask for " + std::to_string(wanted) +
               " numbers, but has " + std::to_string(channel.values.size());
    for (std::size_t i = 0; i < channel.values.size(); ++i)
        if (!std::isfinite(static_cast<float>(channel.values[i])))
            return "number " + std::to_string(i) + " of its values is not finite";
    if (channel.path != Path::Rotation) return std::nullopt;

    for (std::size_t key = 0; key < channel.times.size(); ++key)
    {
        const double* q = channel.values.data() + 4 * (valuesPerKey(channel) == 3 ? key * 3 + 1 : key);
        if (!(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] > 0.0))
            return "the quaternion of key " + std::to_string(key) + " has length 0";
    }
    return std::nullopt;
}

void sortUnique(std::vector<double>& times)
{
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
}

/// The keyframes of a clip with these curves: the union of all key times, twice at a jump.
std::vector<Moment> findMoments(const std::vector<ChannelCurve>& curves)
{
    std::vector<double> times;
    std::vector<double> jumps;
    const std::vector<double> none;
    const std::vector<double>* max = &none;
    for (const ChannelCurve& curve : curves)
    {
        // Most channels share the times of an earlier channel, and sorting is slow.
        const std::vector<double>& own = curve.channel().times;
        if (!std::includes(max->begin(), max->end(), own.begin(), own.end()))
            times.insert(times.end(), own.begin(), own.end());
        if (own.size() > max->size()) max = &own;
        curve.appendJumps(jumps);
    }
    sortUnique(times);
    sortUnique(jumps);
    std::vector<double> middles;
    for (const ChannelCurve& curve : curves)
        curve.appendMiddlesOfHalfTurns(times, middles);
    times.insert(times.end(), middles.begin(), middles.end());
    sortUnique(times);
    if (times.empty()) times.push_back(0.0);

    std::vector<Moment> moments;
    moments.reserve(times.size() + jumps.size());
    for (const double time : times)
    {
        if (std::binary_search(jumps.begin(), jumps.end(), time)) moments.push_back({time, true});
        moments.push_back({time, false});
    }
    return moments;
}

/// Writes numbers into one part of one track, keyframe by keyframe.
class TrackWriter
{
public:
    TrackWriter(std::vector<JointTransform>& data, const Clip& clip, std::size_t track, std::size_t firstComponent)
        : _data(data), _stride(clip.keyframeStride()), _perTrack(clip.transformsPerTrack()), _place(track * _perTrack),
          _firstComponent(firstComponent)
    {
    }

    /// part: 0 the value, 1 the in-tangent, 2 the out-tangent. Numbers beyond a track's twelve go to the next track.
    void write(std::size_t keyframe, std::size_t part, const std::vector<double>& numbers)
    {
        for (std::size_t i = 0; i < numbers.size(); ++i)
        {
            const std::size_t at = _firstComponent + i;
            const std::size_t track = at / componentsPerTrack;
            JointTransform& transform = _data[keyframe * _stride + _place + track * _perTrack + part];
            transform.number(at % componentsPerTrack) = rounded(numbers[i]);
        }
    }

    void markAsSplineRotation(std::size_t keyframe) { _data[keyframe * _stride + _place].translation.w = 0.0f; }

private:
    std::vector<JointTransform>& _data;
    std::size_t _stride;
    std::size_t _perTrack;
    std::size_t _place;
    std::size_t _firstComponent;
};

void writeCurve(ChannelCurve curve, const std::vector<Moment>& moments, bool spline, TrackWriter writer)
{
    std::vector<double> value(curve.componentCount());
    for (std::size_t k = 0; k < moments.size(); ++k)
    {
        curve.value(moments[k], value.data());
        writer.write(k, 0, value);
        if (curve.isSplineRotation()) writer.markAsSplineRotation(k);
    }
    if (!spline) return;

    std::vector<double> last(curve.componentCount());
    for (std::size_t k = 0; k + 1 < moments.size(); ++k)
    {
        curve.tangents(moments[k], moments[k + 1], value.data(), last.data());
        writer.write(k, 2, value);
        writer.write(k + 1, 1, last);
    }
}

/// Fills every keyframe with the rest pose; tangents are 0.
void fillWithRest(const std::vector<JointTransform>& rest, std::size_t jointCount, bool spline,
                  std::size_t keyframeCount, std::vector<JointTransform>& out)
{
    out.reserve(rest.size() * (spline ? 3 : 1) * keyframeCount);
    for (std::size_t k = 0; k < keyframeCount; ++k)
        for (std::size_t track = 0; track < rest.size(); ++track)
        {
            out.push_back(rest[track]);
            if (!spline) continue;
            if (track < jointCount) out.back().translation.w = 1.0f;
            out.insert(out.end(), 2, zeroTransform);
        }
}

} // namespace

ClipBuilder::ClipBuilder(const Skeleton& skeleton, const std::vector<MorphWeights>& morphs)
    : _rest(restPose(skeleton, morphs)), _jointCount(skeleton.jointCount()),
      _firstTrackOfMorph(firstTracksOfMorphs(skeleton, morphs)), _firstKeyOfMorph{skeleton.jointCount() * 3}
{
    for (const MorphWeights& morph : morphs)
    {
        _weightCounts.push_back(morph.defaults.size());
        _firstKeyOfMorph.push_back(_firstKeyOfMorph.back() + morph.defaults.size());
    }
    _driven.resize(_firstKeyOfMorph.back());
}

std::size_t ClipBuilder::componentCount(const Channel& channel) const
{
    if (channel.path == Path::Weights) return channel.weight >= 0 ? 1 : _weightCounts[channel.target];
    return channel.path == Path::Rotation ? 4 : 3;
}

std::string ClipBuilder::describe(const Channel& channel) const
{
    return std::string(nameOf(channel.path)) + " of " + (channel.path == Path::Weights ? "morph " : "joint ") +
           std::to_string(channel.target) + ": ";
}

std::pair<std::size_t, std::size_t> ClipBuilder::keysOf(const Channel& channel) const
{
    const auto target = static_cast<std::size_t>(channel.target);
    std::size_t first = target * 3 + static_cast<std::size_t>(channel.path);
    if (channel.path != Path::Weights) return {first, first + 1};
    if (channel.weight < 0) return {_firstKeyOfMorph[target], _firstKeyOfMorph[target + 1]};
    first = _firstKeyOfMorph[target] + static_cast<std::size_t>(channel.weight);
    return {first, first + 1};
}

Result<void> ClipBuilder::add(Channel channel)
{
    const auto subject = [&] { return describe(channel); };
    const std::size_t targets = channel.path == Path::Weights ? _weightCounts.size() : _jointCount;
    if (channel.target < 0 || static_cast<std::size_t>(channel.target) >= targets)
        return Error{subject() + "there are " + std::to_string(targets)};
    if (componentCount(channel) == 0) return Error{subject() + "it has no weights"};
    if (channel.path == Path::Weights && channel.weight >= 0 &&
        static_cast<std::size_t>(channel.weight) >= _weightCounts[channel.target])
        return Error{subject() + "there is no weight " + std::to_string(channel.weight) + " among " +
                     std::to_string(_weightCounts[channel.target])};
    const auto [firstKey, endKey] = keysOf(channel);
    const auto first = _driven.begin() + firstKey;
    const auto end = _driven.begin() + endKey;
    if (std::find(first, end, true) != end) return Error{subject() + "another channel has this target already"};
    if (auto fault = findFaultInTimes(channel.times)) return Error{subject() + *fault};
    if (auto fault = findFaultInValues(channel, componentCount(channel))) return Error{subject() + *fault};

    std::fill(first, end, true);
    _channels.push_back(std::move(channel));
    return {};
}

std::vector<ChannelCurve> ClipBuilder::curves() const
{
    std::vector<ChannelCurve> curves;
    for (const Channel& channel : _channels)
        curves.emplace_back(channel, componentCount(channel));
    return curves;
}

Clip::Form ClipBuilder::form() const
{
    const auto isSpline = [](const Channel& channel) { return valuesPerKey(channel) == 3; };
    return std::any_of(_channels.begin(), _channels.end(), isSpline) ? Clip::Form::Spline : Clip::Form::Linear;
}

std::size_t ClipBuilder::byteSize() const
{
    const double bytesPerKeyframe =
        static_cast<double>(sizeof(float) + _rest.size() * Clip::transformsPerTrack(form()) * sizeof(JointTransform));
    const double bytes = bytesPerKeyframe * static_cast<double>(findMoments(curves()).size());
    constexpr auto max = std::numeric_limits<std::size_t>::max();
    return bytes < static_cast<double>(max) ? static_cast<std::size_t>(bytes) : max;
}

Clip ClipBuilder::build(std::string name)
{
    Clip clip;
    clip._name = std::move(name);
    clip._trackCount = _rest.size();
    clip._form = form();
    const bool spline = clip._form == Clip::Form::Spline;
    const std::vector<ChannelCurve> curves = this->curves();
    const std::vector<Moment> moments = findMoments(curves);
    for (const Moment& moment : moments)
        clip._times.push_back(static_cast<float>(moment.time));
    fillWithRest(_rest, _jointCount, spline, moments.size(), *clip._data);
    for (const ChannelCurve& curve : curves)
    {
        const auto target = static_cast<std::size_t>(curve.channel().target);
        const std::size_t track = curve.channel().path == Path::Weights ? _firstTrackOfMorph[target] : target;
        const std::size_t first = curve.channel().weight >= 0 && curve.channel().path == Path::Weights
                                      ? static_cast<std::size_t>(curve.channel().weight)
                                      : firstComponent(curve.channel().path);
        writeCurve(curve, moments, spline, TrackWriter(*clip._data, clip, track, first));
    }
    _channels.clear();
    _driven.assign(_driven.size(), false);
    return clip;
}

} // namespace osgGpuAnimation
