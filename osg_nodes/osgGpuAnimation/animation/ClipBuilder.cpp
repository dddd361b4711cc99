// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/ClipBuilder.h>

#include <osgGpuAnimation/animation/bounds/ClipBounds.h>
#include <osgGpuAnimation/animation/keyframes/ChannelCurve.h>
#include <osgGpuAnimation/animation/keyframes/ClipCompactor.h>
#include <osgGpuAnimation/animation/math/Box.h>
#include <osgGpuAnimation/animation/playback/FootPaths.h>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>

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
    constexpr double largest = std::numeric_limits<float>::max();
    return static_cast<float>(std::clamp(value, -largest, largest));
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
    const std::vector<double>* most = &none;
    for (const ChannelCurve& curve : curves)
    {
        // Most channels share the times of an earlier channel, and sorting is slow.
        const std::vector<double>& own = curve.channel().times;
        if (!std::includes(most->begin(), most->end(), own.begin(), own.end()))
            times.insert(times.end(), own.begin(), own.end());
        if (own.size() > most->size()) most = &own;
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

constexpr double pi = glm::pi<double>();

glm::dquat unitRotation(const JointTransform& transform)
{
    return Rotation::quaternion(Rotation::unit(glm::dvec4(transform.rotation)));
}

glm::vec4 rounded(const glm::dquat& q)
{
    return glm::vec4(Rotation::numbers(q));
}

bool isNear(const glm::vec4& a, const glm::vec4& b, double most)
{
    return glm::all(glm::lessThanEqual(glm::dvec4(glm::abs(a - b)), glm::dvec4(most)));
}

bool isNear(const JointTransform& a, const JointTransform& b)
{
    const double size = 1.0 + static_cast<double>(glm::length(a.translation) + glm::length(a.scale));
    return isNear(a.translation, b.translation, 1e-6 * size) && isNear(a.rotation, b.rotation, 1e-6) &&
           isNear(a.scale, b.scale, 1e-6 * size);
}

/// True for a rotation with a uniform scale, without a mirror.
bool isSimilarity(const glm::dmat3& m)
{
    const double size = glm::length(m[0]);
    constexpr double tolerance = 1e-4;
    return size > 0.0 && std::isfinite(size) && std::abs(glm::length(m[1]) / size - 1.0) <= tolerance &&
           std::abs(glm::length(m[2]) / size - 1.0) <= tolerance &&
           glm::length(glm::cross(m[0], m[1]) / (size * size) - m[2] / size) <= tolerance;
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
    if (channel.path == Path::Weights)
        return channel.weight >= 0 ? 1 : _weightCounts[static_cast<std::size_t>(channel.target)];
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

Result<bool> ClipBuilder::add(Channel channel)
{
    const auto subject = [&] { return describe(channel); };
    const std::size_t targets = channel.path == Path::Weights ? _weightCounts.size() : _jointCount;
    if (channel.target < 0 || static_cast<std::size_t>(channel.target) >= targets)
        return Error{subject() + "there are " + std::to_string(targets)};
    if (componentCount(channel) == 0) return Error{subject() + "it has no weights"};
    if (channel.path == Path::Weights && channel.weight >= 0 &&
        static_cast<std::size_t>(channel.weight) >= _weightCounts[static_cast<std::size_t>(channel.target)])
        return Error{subject() + "there is no weight " + std::to_string(channel.weight) + " among " +
                     std::to_string(_weightCounts[static_cast<std::size_t>(channel.target)])};
    const auto [firstKey, endKey] = keysOf(channel);
    const auto first = _driven.begin() + static_cast<std::ptrdiff_t>(firstKey);
    const auto end = _driven.begin() + static_cast<std::ptrdiff_t>(endKey);
    if (std::find(first, end, true) != end) return Error{subject() + "another channel has this target already"};
    if (auto fault = findFaultInTimes(channel.times)) return Error{subject() + *fault};
    if (auto fault = findFaultInValues(channel, componentCount(channel))) return Error{subject() + *fault};

    std::fill(first, end, true);
    _channels.push_back(std::move(channel));
    return true;
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
    constexpr auto most = std::numeric_limits<std::size_t>::max();
    return bytes < static_cast<double>(most) ? static_cast<std::size_t>(bytes) : most;
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

Result<CompactedSet> compactClips(const AnimationSet& set, const EntryBoxes& entryBoxes, const CompactOptions& options)
{
    if (!(options.tolerance > 0.0) || !std::isfinite(options.tolerance))
        return Error{"a tolerance of " + std::to_string(options.tolerance) +
                     " for compact clips: expected a finite number above 0"};
    if (entryBoxes.size() != set.paletteSize())
        return Error{std::to_string(entryBoxes.size()) + " boxes for " + std::to_string(set.paletteSize()) +
                     " palette entries"};
    CompactedSet result;
    std::vector<Clip> clips;
    ClipCompactor compactor(set, entryBoxes, longestSide(set, entryBoxes), options.tolerance);
    for (const Clip& clip : set.clips())
    {
        clips.push_back(compactor.compact(clip));
        result.errors.push_back(compactor.error());
    }
    auto made = set.withClips(std::move(clips));
    if (!made) return made.error();
    result.set = std::move(made).value();
    return result;
}

double longestSide(const AnimationSet& set, const EntryBoxes& entryBoxes)
{
    Box box = boundsOfClip(set, -1, entryBoxes);
    if (box.empty()) box = boundsOfJoints(set);
    if (box.empty()) return 0.0;
    return largestComponent(glm::dvec3(box.max - box.min));
}

/// Removes the motion of one joint from clips, see withRootMotion().
class RootMotionExtractor
{
public:
    RootMotionExtractor(const Skeleton& skeleton, std::size_t joint, const RootMotionAxes& axes)
        : _skeleton(skeleton), _joint(joint), _axes(axes)
    {
        _axes.up = glm::normalize(_axes.up);
    }

    Result<Clip> extract(const Clip& clip);

private:
    bool isStill(const Clip& clip, std::size_t joint) const;
    Result<bool> findParent(const Clip& clip);
    double yawOf(const glm::dquat& rotation) const;
    void removeTranslation(Clip& clip, RootMotionCurve& curve) const;
    void removeYaw(Clip& clip, RootMotionCurve& curve) const;

    const Skeleton& _skeleton;
    std::size_t _joint;
    RootMotionAxes _axes; ///< up is unit
    // From the space of the joint's parent to model space.
    glm::dmat4 _parentToModel{1.0};
    glm::dquat _parentRotation = glm::identity<glm::dquat>();
};

bool RootMotionExtractor::isStill(const Clip& clip, std::size_t joint) const
{
    for (std::size_t k = 0; k < clip.keyframeCount(); ++k)
    {
        const JointTransform* here = clip.at(k, joint);
        if (!isNear(*clip.at(0, joint), *here)) return false;
        for (std::size_t tangent = 1; tangent < clip.transformsPerTrack(); ++tangent)
            if (!isNear(zeroTransform, here[tangent])) return false;
    }
    return true;
}

Result<bool> RootMotionExtractor::findParent(const Clip& clip)
{
    _parentToModel = glm::dmat4(1.0);
    _parentRotation = glm::identity<glm::dquat>();
    for (int j = _skeleton.joint(_joint).parent; j >= 0; j = _skeleton.joint(static_cast<std::size_t>(j)).parent)
    {
        const auto joint = static_cast<std::size_t>(j);
        if (!isStill(clip, joint))
            return Error{"clip \"" + clip.name() + "\" moves joint \"" + _skeleton.joint(joint).name + "\" above \"" +
                         _skeleton.joint(_joint).name + "\", whose motion is to be taken out"};
        const JointTransform& local = *clip.at(0, joint);
        _parentToModel = local.toMatrix().toColumns() * _parentToModel;
        _parentRotation = unitRotation(local) * _parentRotation;
    }
    if (!isSimilarity(glm::dmat3(_parentToModel)))
        return Error{"joint \"" + _skeleton.joint(_joint).name +
                     "\" is under a scale that is not the same in all directions: its motion cannot be taken out"};
    return true;
}

Result<Clip> RootMotionExtractor::extract(const Clip& clip)
{
    if (const RootMotionCurve* taken = clip.rootMotion())
        return Error{"clip \"" + clip.name() + "\" has had its root motion taken out already, from joint \"" +
                     _skeleton.joint(taken->joint).name + "\""};
    const Result<bool> hasParent = findParent(clip);
    if (!hasParent) return hasParent.error();
    Clip stripped = clip;
    stripped._compactTracks = nullptr;
    stripped._data = std::make_shared<std::vector<JointTransform>>(clip.data());
    auto curve = std::make_shared<RootMotionCurve>();
    curve->joint = _joint;
    curve->up = _axes.up;
    curve->keys.resize(clip.keyframeCount());
    removeTranslation(stripped, *curve);
    if (_axes.yaw) removeYaw(stripped, *curve);
    stripped._rootMotion = std::move(curve);
    return stripped;
}

void RootMotionExtractor::removeTranslation(Clip& clip, RootMotionCurve& curve) const
{
    const glm::dmat3 toModel(_parentToModel);
    const glm::dmat3 toParent = glm::inverse(toModel);
    const auto taken = [&](const glm::dvec3& v)
    {
        const glm::dvec3 along = _axes.up * glm::dot(_axes.up, v);
        return (_axes.horizontal ? v - along : glm::dvec3(0.0)) + (_axes.vertical ? along : glm::dvec3(0.0));
    };
    const std::size_t perTrack = clip.transformsPerTrack();
    JointTransform* key = &(*clip._data)[_joint * perTrack];
    const glm::dvec3 first(key->translation);
    for (std::size_t k = 0; k < curve.keys.size(); ++k, key += clip.keyframeStride())
        for (std::size_t part = 0; part < perTrack; ++part)
        {
            const glm::dvec3 own(key[part].translation);
            const glm::dvec3 way = toModel * (part == 0 ? own - first : own);
            const glm::dvec3 gone = taken(way);
            const glm::dvec3 left = own - toParent * gone;
            key[part].translation = glm::vec4(glm::vec3(left), key[part].translation.w);
            RootMotionCurve::Key& out = curve.keys[k];
            const auto place = part == 0   ? &RootMotionCurve::Point::value
                               : part == 1 ? &RootMotionCurve::Point::in
                                           : &RootMotionCurve::Point::out;
            out.displacement.*place = gone;
            out.pivot.*place = glm::dvec3(_parentToModel * glm::dvec4(left, part == 0 ? 1.0 : 0.0));
        }
}

/// The part of a rotation in model space that turns about up (its twist), in [-pi, pi].
double RootMotionExtractor::yawOf(const glm::dquat& rotation) const
{
    const double along = glm::dot(glm::dvec3(rotation.x, rotation.y, rotation.z), _axes.up);
    if (along == 0.0 && rotation.w == 0.0) return 0.0;
    const double angle = 2.0 * std::atan2(along, rotation.w);
    return angle > pi ? angle - 2.0 * pi : angle < -pi ? angle + 2.0 * pi : angle;
}

void RootMotionExtractor::removeYaw(Clip& clip, RootMotionCurve& curve) const
{
    const std::size_t perTrack = clip.transformsPerTrack(), stride = clip.keyframeStride();
    JointTransform* keys = &(*clip._data)[_joint * perTrack];
    const glm::dquat first = _parentRotation * unitRotation(*keys);
    for (std::size_t k = 0; k < curve.keys.size(); ++k)
    {
        const double yaw = yawOf(_parentRotation * unitRotation(keys[k * stride]) * glm::conjugate(first));
        const double before = k == 0 ? 0.0 : curve.keys[k - 1].yaw;
        curve.keys[k].yaw = yaw + 2.0 * pi * std::round((before - yaw) / (2.0 * pi));
    }
    const glm::dvec3 axis = glm::conjugate(_parentRotation) * _axes.up;
    for (std::size_t k = 0; k < curve.keys.size(); ++k)
    {
        JointTransform* key = keys + k * stride;
        const double yaw = curve.keys[k].yaw;
        const glm::dquat back = glm::angleAxis(-yaw, axis);
        const glm::dquat value = back * Rotation::quaternion(glm::dvec4(key->rotation));
        const bool isSpline = perTrack == 3 && key->translation.w == 0.0f;
        for (std::size_t part = 1; isSpline && part < 3; ++part)
        {
            // Product rule: the tangent itself, and the yaw that changes within that piece.
            const std::size_t from = part == 1 ? (k == 0 ? 0 : k - 1) : k;
            const std::size_t to = std::min(from + 1, curve.keys.size() - 1);
            const double slope = part == 1 && k == 0 ? 0.0 : curve.keys[to].yaw - curve.keys[from].yaw;
            key[part].rotation = rounded(back * Rotation::quaternion(glm::dvec4(key[part].rotation)) -
                                         glm::dquat(0.0, axis) * value * (0.5 * slope));
        }
        key->rotation = rounded(value);
    }
}

Result<std::shared_ptr<const AnimationSet>> withRootMotion(const AnimationSet& set, const std::string& joint,
                                                           const RootMotionAxes& axes)
{
    const Result<std::size_t> index = set.skeleton().jointNamed(joint);
    if (!index) return index.error();
    const double length = glm::length(axes.up);
    if (!(length > 0.0) || !std::isfinite(length)) return Error{"an up axis that has no direction"};

    std::vector<Clip> clips;
    for (const Clip& clip : set.clips())
    {
        Result<Clip> stripped = RootMotionExtractor(set.skeleton(), index.value(), axes).extract(clip);
        if (!stripped) return stripped.error();
        clips.push_back(std::move(stripped).value());
    }
    return set.withClips(std::move(clips));
}

Result<std::vector<FootContact>> findFootContacts(const AnimationSet& set, const std::string& clip,
                                                  const std::string& joint)
{
    const Result<std::size_t> foundClip = set.clipNamed(clip);
    if (!foundClip) return foundClip.error();
    const Result<std::size_t> foundJoint = set.skeleton().jointNamed(joint);
    if (!foundJoint) return foundJoint.error();
    return findFootContacts(set, foundClip.value(), foundJoint.value());
}

Result<std::vector<FootContact>> findFootContacts(const AnimationSet& set, std::size_t clip, std::size_t joint)
{
    if (const Result<std::size_t> known = set.clipAt(clip); !known) return known.error();
    if (joint >= set.skeleton().jointCount())
        return Error{"there is no joint " + std::to_string(joint) + " among " +
                     std::to_string(set.skeleton().jointCount())};
    const double duration = set.clips()[clip].duration();
    std::vector<FootContact> contacts;
    if (!(duration > 0.0)) return contacts;
    const double samples = std::ceil(std::clamp(duration * 240.0, 64.0, 65536.0));
    std::vector<double> times;
    for (double sample = 0.0; sample <= samples; sample += 1.0)
        times.push_back(duration * sample / samples);
    const auto poseAt = [&](std::size_t sample)
    {
        PoseInstruction instruction;
        instruction.samples[0] = set.sampleAt(static_cast<int>(clip), times[sample]);
        return instruction;
    };
    const FootPaths paths(set, times, poseAt, {joint});
    for (const auto& [first, last] : paths.contactsOf(0))
        contacts.push_back(
            {duration * static_cast<double>(first) / samples, duration * static_cast<double>(last) / samples});
    return contacts;
}

} // namespace osgGpuAnimation
