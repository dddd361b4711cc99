// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/keyframes/ClipCompactor.h>

#include <osgGpuAnimation/animation/keyframes/CompactTracks.h>
#include <osgGpuAnimation/animation/keyframes/TrackBlend.h>
#include <osgGpuAnimation/animation/Pose.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgGpuAnimation
{

PoseDistance::PoseDistance(const AnimationSet& set, const EntryBoxes& entryBoxes) : _set(set)
{
    _points.assign(set.skeleton().jointCount(), {glm::vec3(0.0f)});
    for (std::size_t entry = 0; entry < entryBoxes.size(); ++entry)
    {
        const PaletteEntry& moved = set.palette()[entry];
        const Box& box = entryBoxes[entry];
        if (box.empty() || moved.joint < 0) continue;
        std::vector<glm::vec3>& points = _points[static_cast<std::size_t>(moved.joint)];
        for (int corner = 0; corner < 8; ++corner)
            points.push_back(moved.inverseBind.transformPoint(box.corner(corner)));
    }
}

bool PoseDistance::hasOtherWeights(const std::vector<JointTransform>& a, const std::vector<JointTransform>& b) const
{
    for (std::size_t track = _set.skeleton().jointCount(); track < a.size(); ++track)
        for (std::size_t i = 0; i < MorphWeights::weightsPerBlock; ++i)
        {
            const float weight = a[track].number(i);
            if (!(std::abs(weight - b[track].number(i)) <= 1e-6f * std::max(1.0f, std::abs(weight)))) return true;
        }
    return false;
}

double PoseDistance::between(const std::vector<JointTransform>& a, const std::vector<JointTransform>& b)
{
    if (hasOtherWeights(a, b)) return std::numeric_limits<double>::infinity();
    Pose::jointToModel(_set, a, AffineMatrix(), _jointsOfA);
    Pose::jointToModel(_set, b, AffineMatrix(), _jointsOfB);
    float worst = 0.0f;
    for (std::size_t joint = 0; joint < _points.size(); ++joint)
        for (const glm::vec3& point : _points[joint])
        {
            const glm::vec3 way = _jointsOfA[joint].transformPoint(point) - _jointsOfB[joint].transformPoint(point);
            const float squared = glm::dot(way, way);
            if (!std::isfinite(squared)) return std::numeric_limits<double>::infinity();
            worst = std::max(worst, squared);
        }
    return std::sqrt(static_cast<double>(worst));
}

namespace
{

// Shares of the tolerance, chosen by measuring characters: for one part of a joint that becomes constant, and for
// dropped keyframes. The remainder covers rounding and constants that add up.
constexpr double constantShare = 0.03;
constexpr double droppedShare = 0.9;
constexpr int attempts = 4;

/// True if all values of a track are within `most` of a value.
template <typename Distance>
bool isNear(const std::vector<JointTransform>& data, std::size_t track, std::size_t stride, const JointTransform& value,
            double most, Distance distance)
{
    for (std::size_t at = track; at < data.size(); at += stride)
        if (!(distance(data[at], value) <= most)) return false;
    return true;
}

} // namespace

ClipCompactor::ClipCompactor(const AnimationSet& set, const EntryBoxes& entryBoxes, double size, double tolerance)
    : _set(set), _tolerance(tolerance), _size(size), _distance(set, entryBoxes), _exactPose(set.trackCount()),
      _madePose(set.trackCount())
{
}

Clip ClipCompactor::compact(const Clip& clip)
{
    double share = 1.0;
    for (int i = 0; i < attempts && clip.form() == Clip::Form::Linear && !clip.compactTracks(); ++i, share *= 0.5)
    {
        Clip made = attempt(clip, share);
        if (_error <= _tolerance) return made;
    }
    _error = 0.0;
    return clip;
}

Clip ClipCompactor::attempt(const Clip& clip, double share)
{
    std::vector<JointTransform> data = clip.data();
    makePartsConstant(clip, data, share * constantShare * _tolerance);
    const std::vector<std::size_t> kept = keptKeyframes(clip, data, share * droppedShare * _tolerance);

    Clip made = clip;
    made._times.clear();
    made._data = std::make_shared<std::vector<JointTransform>>();
    for (const std::size_t k : kept)
    {
        made._times.push_back(clip.times()[k]);
        const auto from = data.begin() + static_cast<std::ptrdiff_t>(k * clip.keyframeStride());
        made._data->insert(made._data->end(), from, from + static_cast<std::ptrdiff_t>(clip.keyframeStride()));
    }
    made._compactTracks = std::make_shared<const CompactTracks>(
        CompactTracks::pack(*made._data, made.trackCount(), _set.skeleton().jointCount()));
    _error = errorOf(clip, made, kept);
    return made;
}

/// Makes parts constant that hardly move: at the value of the rest pose if that is near enough.
void ClipCompactor::makePartsConstant(const Clip& clip, std::vector<JointTransform>& data, double most) const
{
    const auto apart = [](glm::vec4 JointTransform::*part)
    {
        return [part](const JointTransform& a, const JointTransform& b)
        { return static_cast<double>(glm::length(glm::vec3(a.*part) - glm::vec3(b.*part))); };
    };
    const auto turned = [](const JointTransform& a, const JointTransform& b)
    {
        const glm::dvec4 from = Rotation::unit(glm::dvec4(a.rotation)), to = Rotation::unit(glm::dvec4(b.rotation));
        const double chord = std::min(glm::length(to - from), glm::length(to + from)); // of the turn the short way
        return 4.0 * std::asin(0.5 * chord);
    };
    const std::size_t stride = clip.keyframeStride();
    for (std::size_t joint = 0; joint < _set.skeleton().jointCount(); ++joint)
    {
        const auto hold = [&](glm::vec4 JointTransform::*part, double limit, const auto& distance)
        {
            for (const JointTransform value : {_set.restPose()[joint], data[joint]})
            {
                if (!isNear(data, joint, stride, value, limit, distance)) continue;
                for (std::size_t at = joint; at < data.size(); at += stride)
                    data[at].*part = value.*part;
                return;
            }
        };
        hold(&JointTransform::translation, most, apart(&JointTransform::translation));
        hold(&JointTransform::rotation, most / _size, turned);
        hold(&JointTransform::scale, most / _size, apart(&JointTransform::scale));
    }
}

std::vector<std::size_t> ClipCompactor::keptKeyframes(const Clip& clip, const std::vector<JointTransform>& data,
                                                      double most)
{
    std::vector<std::size_t> kept{0};
    const std::size_t last = clip.keyframeCount() - 1;
    while (kept.back() < last)
        // A root motion curve has one key per keyframe, so none is dropped.
        kept.push_back(clip.rootMotion() ? kept.back() + 1 : farthest(clip, data, kept.back(), most));
    return kept;
}

/// The last keyframe that may follow `from` if all keyframes between them are dropped. It doubles the distance, then
/// halves it, so that long constant stretches do not take quadratic time.
std::size_t ClipCompactor::farthest(const Clip& clip, const std::vector<JointTransform>& data, std::size_t from,
                                    double most)
{
    const std::vector<float>& times = clip.times();
    std::size_t end = from + 1; // never across a jump
    while (end + 1 < times.size() && times[end - 1] < times[end] && times[end] < times[end + 1])
        ++end;
    const auto tells = [&](std::size_t to)
    {
        const std::size_t stride = clip.keyframeStride();
        return worstWithin(clip, from, to, &data[from * stride], &data[to * stride], most) <= most;
    };
    std::size_t good = from + 1;
    std::size_t bad = end + 1;
    for (std::size_t step = 1; good < end; step *= 2)
    {
        const std::size_t next = std::min(good + step, end);
        if (!tells(next))
        {
            bad = next;
            break;
        }
        good = next;
    }
    while (good + 1 < bad)
    {
        const std::size_t middle = good + (bad - good) / 2;
        (tells(middle) ? good : bad) = middle;
    }
    return good;
}

/// The largest error of a mix of a and b against the clip's keyframes [from, to] and the points halfway between them.
/// Stops at an error above `enough`.
double ClipCompactor::worstWithin(const Clip& clip, std::size_t from, std::size_t to, const JointTransform* a,
                                  const JointTransform* b, double enough)
{
    const auto timeOf = [&](std::size_t k) { return static_cast<double>(clip.times()[k]); };
    const double span = timeOf(to) - timeOf(from);
    double worst = 0.0;
    for (std::size_t step = 0; step <= 2 * (to - from) && worst <= enough; ++step)
    {
        const std::size_t k = from + step / 2;
        const bool isHalfway = step % 2 != 0;
        if (isHalfway && !(span > 0.0)) continue; // a jump
        const std::size_t stride = clip.keyframeStride();
        const JointTransform* exact = &clip.data()[k * stride];
        const double time = isHalfway ? 0.5 * (timeOf(k) + timeOf(k + 1)) : timeOf(k);
        mix(exact, isHalfway ? exact + stride : exact, isHalfway ? 0.5 : 0.0, _exactPose);
        mix(a, b, span > 0.0 ? (time - timeOf(from)) / span : static_cast<double>(k == to), _madePose);
        worst = std::max(worst, _distance.between(_exactPose, _madePose));
    }
    return worst;
}

void ClipCompactor::mix(const JointTransform* a, const JointTransform* b, double alpha,
                        std::vector<JointTransform>& out) const
{
    for (std::size_t track = 0; track < out.size(); ++track)
    {
        const bool isWeights = track >= _set.skeleton().jointCount();
        const MixedTrack mixed = MixedTrack::between({a, b, alpha, false}, track, isWeights);
        out[track] = {glm::vec4(mixed.translation), glm::vec4(mixed.rotation), glm::vec4(mixed.scale)};
    }
}

double ClipCompactor::errorOf(const Clip& clip, const Clip& made, const std::vector<std::size_t>& kept)
{
    double worst = 0.0;
    const std::size_t stride = clip.keyframeStride();
    for (std::size_t k = 0; k < kept.size() && worst <= _tolerance; ++k)
    {
        const std::size_t next = std::min(k + 1, kept.size() - 1);
        worst = std::max(worst, worstWithin(clip, kept[k], kept[next], &made.data()[k * stride],
                                            &made.data()[next * stride], _tolerance));
    }
    return worst;
}

} // namespace osgGpuAnimation
