// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/authoring/ClipBuilder.h>

#include <osgGpuAnimation/math/Hermite.h>
#include <osgGpuAnimation/math/Rotation.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace osgGpuAnimation
{

namespace
{

using Path = Channel::Path;
using Interpolation = Channel::Interpolation;

constexpr std::size_t componentsPerTrack = MorphWeights::weightsPerBlock;

float rounded(double value)
{
    constexpr double max = std::numeric_limits<float>::max();
    return static_cast<float>(std::clamp(value, -max, max));
}

std::size_t valuesPerKey(const Channel& channel)
{
    return channel.interpolation == Interpolation::CubicSpline ? 3 : 1;
}

glm::dvec4 rotationAt(const double* q)
{
    return glm::dvec4(q[0], q[1], q[2], q[3]);
}

void store(const glm::dvec4& q, double* out)
{
    for (int c = 0; c < 4; ++c)
        out[c] = q[c];
}

/// True if single precision could find the other way shorter: |cos| < 1e-6. If every term of the dot product is 0, it
/// is 0 in any precision. a, b: of float range, so that their squares neither overflow nor vanish.
bool isAmbiguous(const glm::dvec4& a, const glm::dvec4& b)
{
    const double product = glm::dot(a, b);
    return product * product < 1e-12 * glm::dot(a, a) * glm::dot(b, b) && a * b != glm::dvec4(0.0);
}

/// The time of a clip's keyframe. At a jump two keyframes have the same time; the first of them is `before` the jump.
struct Moment
{
    double time = 0.0; ///< seconds; a value that fits a float
    bool before = false;
};

/// A checked channel as a function of time in double precision (glTF 2.0, appendix C). It keeps a cursor into the keys,
/// so ascending moments are fast.
class ChannelCurve
{
public:
    /// The channel must outlive the curve.
    explicit ChannelCurve(const Channel& channel)
        : _channel(channel), _valuesPerKey(valuesPerKey(channel)),
          _componentCount(channel.values.size() / (channel.times.size() * _valuesPerKey))
    {
    }

    const Channel& channel() const { return _channel; }
    std::size_t componentCount() const { return _componentCount; } ///< numbers per value

    /// True for CUBICSPLINE rotations, which are not unit; false for rotations that are slerped or stepped.
    bool isSplineRotation() const
    {
        return _channel.path == Path::Rotation && _channel.interpolation == Interpolation::CubicSpline;
    }

    /// Before the first key it is the first value, after the last key the last value. STEP and LINEAR rotations are
    /// unit; CUBICSPLINE rotations are not normalized.
    void value(const Moment& at, double* out)
    {
        const std::size_t key = keyAt(at);
        const bool isRotation = _channel.path == Path::Rotation;
        const bool oldValue =
            _channel.interpolation == Interpolation::Step && at.before && key > 0 && _channel.times[key] == at.time;
        const double* first = valueOfKey(oldValue ? key - 1 : key);
        if (_channel.interpolation == Interpolation::Step || isHeldAt(key, at.time) || at.time == _channel.times[key])
        {
            std::copy_n(first, _componentCount, out);
            if (isRotation && !isSplineRotation()) store(Rotation::unit(rotationAt(first)), out);
            return;
        }
        const double* second = valueOfKey(key + 1);
        const double length = _channel.times[key + 1] - _channel.times[key];
        const double alpha = (at.time - _channel.times[key]) / length;
        if (isRotation && !isSplineRotation())
            return store(Rotation::slerp(rotationAt(first), rotationAt(second), alpha), out);
        for (std::size_t c = 0; c < _componentCount; ++c)
            out[c] = _channel.interpolation == Interpolation::Linear
                         ? first[c] * (1.0 - alpha) + second[c] * alpha
                         : hermite(first[c], length * tangentAfter(first)[c], second[c],
                                   length * tangentBefore(second)[c], alpha);
    }

    /// The Hermite tangents of the piece between two moments without a key between them: the derivatives at its ends,
    /// multiplied by its length; 0 for slerped rotations.
    void tangents(const Moment& from, const Moment& to, double* outFirst, double* outLast)
    {
        std::fill_n(outFirst, _componentCount, 0.0);
        std::fill_n(outLast, _componentCount, 0.0);
        const std::size_t key = keyAt(from);
        if (isHeldAt(key, to.time) || from.time == to.time || _channel.interpolation == Interpolation::Step) return;
        const double length = _channel.times[key + 1] - _channel.times[key];
        const double share = (to.time - from.time) / length;
        if (_channel.interpolation == Interpolation::CubicSpline)
        {
            splineSlope(key, (from.time - _channel.times[key]) / length, share, outFirst);
            splineSlope(key, (to.time - _channel.times[key]) / length, share, outLast);
        }
        else if (_channel.path != Path::Rotation)
            for (std::size_t c = 0; c < _componentCount; ++c)
                outFirst[c] = outLast[c] = (valueOfKey(key + 1)[c] - valueOfKey(key)[c]) * share;
    }

    /// Appends the times of the keys at which the value jumps: STEP keys with a new value.
    void appendJumps(std::vector<double>& out) const
    {
        if (_channel.interpolation != Interpolation::Step) return;
        for (std::size_t key = 1; key < _channel.times.size(); ++key)
            if (!std::equal(valueOfKey(key), valueOfKey(key) + _componentCount, valueOfKey(key - 1)))
                out.push_back(_channel.times[key]);
    }

    /// For each slerp of almost 180 degrees that contains none of the times, appends the time of its middle: the
    /// rounding of its ends to floats could reverse its direction. times: ascending.
    void appendMiddlesOfHalfTurns(const std::vector<double>& times, std::vector<double>& out) const
    {
        if (_channel.path != Path::Rotation || _channel.interpolation != Interpolation::Linear) return;
        for (std::size_t key = 0; key + 1 < _channel.times.size(); ++key)
        {
            if (!isAmbiguous(rotationAt(valueOfKey(key)), rotationAt(valueOfKey(key + 1)))) continue;
            const double from = _channel.times[key];
            const double to = _channel.times[key + 1];
            const auto next = std::upper_bound(times.begin(), times.end(), from);
            const double middle = static_cast<double>(static_cast<float>(0.5 * (from + to)));
            const bool isCut = next != times.end() && *next < to;
            if (!isCut && from < middle && middle < to) out.push_back(middle);
        }
    }

private:
    const double* valueOfKey(std::size_t key) const
    {
        const std::size_t place = _valuesPerKey == 3 ? key * 3 + 1 : key; // in-tangent, value, out-tangent
        return _channel.values.data() + place * _componentCount;
    }

    const double* tangentBefore(const double* value) const { return value - _componentCount; }
    const double* tangentAfter(const double* value) const { return value + _componentCount; }

    std::size_t keyAt(const Moment& at)
    {
        const std::vector<double>& times = _channel.times;
        if (times[_cursor] > at.time) _cursor = 0;
        while (_cursor + 1 < times.size() && times[_cursor + 1] <= at.time)
            ++_cursor;
        return _cursor;
    }

    bool isHeldAt(std::size_t key, double time) const
    {
        return time <= _channel.times.front() || key + 1 == _channel.times.size();
    }

    void splineSlope(std::size_t key, double alpha, double factor, double* out) const
    {
        const double length = _channel.times[key + 1] - _channel.times[key];
        const double* v0 = valueOfKey(key);
        const double* v1 = valueOfKey(key + 1);
        for (std::size_t c = 0; c < _componentCount; ++c)
        {
            const double m0 = length * tangentAfter(v0)[c], m1 = length * tangentBefore(v1)[c];
            out[c] = hermiteSlope(v0[c], m0, v1[c], m1, alpha) * factor;
        }
    }

    const Channel& _channel;
    std::size_t _valuesPerKey, _componentCount;
    std::size_t _cursor = 0;
};

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

/// Writes a curve keyframe by keyframe. firstNumber: where it begins among the numbers of the first track; numbers
/// beyond a track's twelve go to the next track.
void writeCurve(ChannelCurve curve, const std::vector<Moment>& moments, const Clip& clip, std::size_t firstTrack,
                std::size_t firstNumber, std::vector<JointTransform>& data)
{
    const std::size_t perTrack = clip.transformsPerTrack();
    const auto at = [&](std::size_t keyframe, std::size_t track)
    { return &data[keyframe * clip.keyframeStride() + track * perTrack]; };
    // part: 0 the value, 1 the in-tangent, 2 the out-tangent
    const auto write = [&](std::size_t keyframe, std::size_t part, const std::vector<double>& numbers)
    {
        for (std::size_t i = 0; i < numbers.size(); ++i)
        {
            const std::size_t number = firstNumber + i;
            at(keyframe, firstTrack + number / componentsPerTrack)[part].number(number % componentsPerTrack) =
                rounded(numbers[i]);
        }
    };
    std::vector<double> value(curve.componentCount()), last(value);
    for (std::size_t k = 0; k < moments.size(); ++k)
    {
        curve.value(moments[k], value.data());
        write(k, 0, value);
        if (curve.isSplineRotation()) at(k, firstTrack)->translation.w = 0.0f;
    }
    for (std::size_t k = 0; k + 1 < moments.size() && clip.form() == Clip::Form::Spline; ++k)
    {
        curve.tangents(moments[k], moments[k + 1], value.data(), last.data());
        write(k, 2, value);
        write(k + 1, 1, last);
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

Result<void> ClipBuilder::add(Channel channel)
{
    const bool isOfMorph = channel.path == Path::Weights;
    const auto subject = [&]
    {
        static constexpr const char* names[]{"translation", "rotation", "scale", "weights"};
        return std::string(names[static_cast<std::size_t>(channel.path)]) + (isOfMorph ? " of morph " : " of joint ") +
               std::to_string(channel.target) + ": ";
    };
    const std::size_t targets = isOfMorph ? _weightCounts.size() : _jointCount;
    if (channel.target < 0 || static_cast<std::size_t>(channel.target) >= targets)
        return Error{subject() + "there are " + std::to_string(targets)};
    if (componentCount(channel) == 0) return Error{subject() + "it has no weights"};
    if (isOfMorph && channel.weight >= 0 && static_cast<std::size_t>(channel.weight) >= _weightCounts[channel.target])
        return Error{subject() + "there is no weight " + std::to_string(channel.weight) + " among " +
                     std::to_string(_weightCounts[channel.target])};
    const auto target = static_cast<std::size_t>(channel.target);
    const auto first =
        _driven.begin() + (isOfMorph ? _firstKeyOfMorph[target] + static_cast<std::size_t>(std::max(channel.weight, 0))
                                     : target * 3 + static_cast<std::size_t>(channel.path));
    const auto end = isOfMorph && channel.weight < 0 ? _driven.begin() + _firstKeyOfMorph[target + 1] : first + 1;
    if (std::find(first, end, true) != end) return Error{subject() + "another channel has this target already"};
    if (auto fault = findFaultInTimes(channel.times)) return Error{subject() + *fault};
    if (auto fault = findFaultInValues(channel, componentCount(channel))) return Error{subject() + *fault};

    std::fill(first, end, true);
    _channels.push_back(std::move(channel));
    return {};
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
    const double bytes =
        bytesPerKeyframe * static_cast<double>(findMoments({_channels.begin(), _channels.end()}).size());
    constexpr auto max = std::numeric_limits<std::size_t>::max();
    return bytes < static_cast<double>(max) ? static_cast<std::size_t>(bytes) : max;
}

Clip ClipBuilder::build(std::string name)
{
    Clip clip;
    clip._name = std::move(name);
    clip._trackCount = _rest.size();
    clip._form = form();
    const std::vector<ChannelCurve> curves(_channels.begin(), _channels.end());
    const std::vector<Moment> moments = findMoments(curves);
    for (const Moment& moment : moments)
        clip._times.push_back(static_cast<float>(moment.time));
    *clip._data = restKeyframes(_rest, _jointCount, clip.transformsPerTrack(), moments.size());
    for (const ChannelCurve& curve : curves)
    {
        const auto target = static_cast<std::size_t>(curve.channel().target);
        const Path path = curve.channel().path;
        const std::size_t track = path == Path::Weights ? _firstTrackOfMorph[target] : target;
        std::size_t first = path == Path::Rotation ? 4 : path == Path::Scale ? 8 : 0;
        if (path == Path::Weights && curve.channel().weight >= 0)
            first = static_cast<std::size_t>(curve.channel().weight);
        writeCurve(curve, moments, clip, track, first, *clip._data);
    }
    _channels.clear();
    _driven.assign(_driven.size(), false);
    return clip;
}

} // namespace osgGpuAnimation
