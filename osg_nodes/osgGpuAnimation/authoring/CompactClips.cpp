// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/authoring/CompactClips.h>

#include <osgGpuAnimation/animation/bounds/ClipBounds.h>
#include <osgGpuAnimation/animation/keyframes/CompactTracks.h>
#include <osgGpuAnimation/animation/keyframes/TrackBlend.h>
#include <osgGpuAnimation/authoring/keyframes/BitAllocator.h>
#include <osgGpuAnimation/authoring/keyframes/PoseDistance.h>
#include <osgGpuAnimation/math/Rotation.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

namespace
{

// Shares of the tolerance, chosen by measuring characters: for one part of a joint that becomes constant, for the
// bits that one number begins with, and for dropped keyframes. Rounding has what is left. Where few keyframes can be
// dropped, all are kept for fewer bits.
constexpr double constantShare = 0.03;
constexpr double beginningShare = 0.5;
constexpr double droppedShares[] = {0.75, 0.1};
constexpr int attempts = 4;

/// Of the model's size: something attached to a joint reaches that far.
constexpr double reachShare = 0.5;

/// True if all values of a track are within `most` of a value.
template <typename Distance>
bool isNear(const std::vector<JointTransform>& data, std::size_t track, std::size_t stride, const JointTransform& value,
            double max, Distance distance)
{
    for (std::size_t at = track; at < data.size(); at += stride)
        if (!(distance(data[at], value) <= max)) return false;
    return true;
}

} // namespace

/// Creates compact clips of the clips of a set, see compactClips().
class ClipCompactor
{
public:
    /// size, tolerance: in the model's units, above 0. The set must outlive this object.
    ClipCompactor(const AnimationSet& set, const EntryBoxes& entryBoxes, double size, double tolerance)
        : _set(set), _tolerance(tolerance), _size(size), _distance(set, entryBoxes, reachShare * size),
          _exactPose(set.trackCount()), _madePose(set.trackCount())
    {
    }

    /// The compact clip, or the clip itself if the tolerance cannot be met.
    Clip compact(const Clip& clip)
    {
        Clip best = clip;
        double error = 0.0;
        double share = 1.0;
        for (int i = 0; i < attempts && clip.form() == Clip::Form::Linear && !clip.compactTracks(); ++i, share *= 0.5)
        {
            for (const double dropped : droppedShares)
            {
                Clip made = attempt(clip, share * constantShare, share * dropped);
                if (!made.compactTracks() || !(_error <= _tolerance)) continue;
                if (best.compactTracks() &&
                    best.compactTracks()->records.size() <= made.compactTracks()->records.size())
                    continue;
                best = made;
                error = _error;
            }
            if (best.compactTracks()) break;
        }
        _error = error;
        return best;
    }

    double error() const { return _error; } ///< of the last result of compact(), in the model's units

private:
    Clip attempt(const Clip& clip, double constant, double dropped)
    {
        std::vector<JointTransform> data = clip.data();
        makePartsConstant(clip, data, constant * _tolerance);
        const std::vector<std::size_t> kept = keptKeyframes(clip, data, dropped * _tolerance);

        Clip made = clip;
        made._times.clear();
        std::vector<JointTransform> wanted;
        for (const std::size_t k : kept)
        {
            made._times.push_back(clip.times()[k]);
            const auto from = data.begin() + k * clip.keyframeStride();
            wanted.insert(wanted.end(), from, from + clip.keyframeStride());
        }
        BitAllocator bits(_set, std::move(wanted));
        CompactTracks tracks;
        made._data = std::make_shared<std::vector<JointTransform>>();
        if (!chooseBits(clip, kept, bits) || !bits.finish(tracks, *made._data)) return clip;
        made._compactTracks = std::make_shared<const CompactTracks>(std::move(tracks));
        _error = errorOf(clip, made, kept);
        return made;
    }

    /// Makes parts constant that hardly move: at the value of the rest pose if that is near enough.
    void makePartsConstant(const Clip& clip, std::vector<JointTransform>& data, double max) const
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
            hold(&JointTransform::translation, max, apart(&JointTransform::translation));
            hold(&JointTransform::rotation, max / _size, turned);
            hold(&JointTransform::scale, max / _size, apart(&JointTransform::scale));
        }
    }

    std::vector<std::size_t> keptKeyframes(const Clip& clip, const std::vector<JointTransform>& data, double max)
    {
        std::vector<std::size_t> kept{0};
        const std::size_t last = clip.keyframeCount() - 1;
        while (kept.back() < last)
            // A root motion curve has one key per keyframe, so none is dropped.
            kept.push_back(clip.rootMotion() ? kept.back() + 1 : nextKept(clip, data, kept.back(), max));
        return kept;
    }

    /// The last keyframe that may follow `from` if all keyframes between them are dropped. It doubles the distance,
    /// then halves it, so that long constant stretches do not take quadratic time.
    std::size_t nextKept(const Clip& clip, const std::vector<JointTransform>& data, std::size_t from, double max)
    {
        const std::vector<float>& times = clip.times();
        std::size_t end = from + 1; // never across a jump
        while (end + 1 < times.size() && times[end - 1] < times[end] && times[end] < times[end + 1])
            ++end;
        const auto tells = [&](std::size_t to)
        {
            const std::size_t stride = clip.keyframeStride();
            bool isNearEnough = true;
            forPosesBetween(clip, from, to,
                            [&](double share)
                            {
                                mix(&data[from * stride], &data[to * stride], share, _madePose);
                                isNearEnough = _distance.to(_madePose).distance <= max;
                                return isNearEnough;
                            });
            return isNearEnough;
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

    /// Raises bits until all poses are near enough. False: they cannot be.
    bool chooseBits(const Clip& clip, const std::vector<std::size_t>& kept, BitAllocator& bits)
    {
        bits.begin(_distance, beginningShare * _tolerance);
        const std::size_t stride = clip.keyframeStride();
        bool isRaised = true, isPossible = true;
        const auto approach = [&](std::size_t k, std::size_t next, double share)
        {
            while (isPossible)
            {
                mix(&bits.rounded()[k * stride], &bits.rounded()[next * stride], share, _madePose);
                const PoseDistance::Worst worst = _distance.to(_madePose);
                if (worst.distance <= _tolerance) return true;
                isPossible = std::isfinite(worst.distance) && bits.raise(_madePose, _distance, worst);
                isRaised = true;
            }
            return false;
        };
        while (isRaised && isPossible)
        {
            isRaised = false;
            for (std::size_t k = 0; k < kept.size() && isPossible; ++k)
            {
                const std::size_t next = std::min(k + 1, kept.size() - 1);
                forPosesBetween(clip, kept[k], kept[next], [&](double share) { return approach(k, next, share); });
            }
        }
        return isPossible;
    }

    /// Calls visit(share of `to`) with _distance from the clip's pose at keyframe `from`, then at those before `to` and
    /// at the times halfway between them, as long as it returns true.
    template <typename Visit>
    void forPosesBetween(const Clip& clip, std::size_t from, std::size_t to, Visit visit)
    {
        const auto timeOf = [&](std::size_t k) { return static_cast<double>(clip.times()[k]); };
        const double span = timeOf(to) - timeOf(from);
        const std::size_t stride = clip.keyframeStride();
        for (std::size_t step = 0; step == 0 || step < 2 * (to - from); ++step)
        {
            const std::size_t k = from + step / 2;
            const bool isHalfway = step % 2 != 0;
            if (isHalfway && !(span > 0.0)) continue; // a jump
            const JointTransform* exact = &clip.data()[k * stride];
            const double time = isHalfway ? 0.5 * (timeOf(k) + timeOf(k + 1)) : timeOf(k);
            mix(exact, isHalfway ? exact + stride : exact, isHalfway ? 0.5 : 0.0, _exactPose);
            _distance.from(_exactPose);
            if (!visit(span > 0.0 ? (time - timeOf(from)) / span : 0.0)) return;
        }
    }

    void mix(const JointTransform* a, const JointTransform* b, double alpha, std::vector<JointTransform>& out) const
    {
        for (std::size_t track = 0; track < out.size(); ++track)
        {
            const bool isWeights = track >= _set.skeleton().jointCount();
            const MixedTrack mixed = MixedTrack::between({a, b, alpha, false}, track, isWeights);
            out[track] = {glm::vec4(mixed.translation), glm::vec4(mixed.rotation), glm::vec4(mixed.scale)};
        }
    }

    double errorOf(const Clip& clip, const Clip& made, const std::vector<std::size_t>& kept)
    {
        double worst = 0.0;
        for (std::size_t k = 0; k < kept.size() && worst <= _tolerance; ++k)
        {
            const std::size_t next = std::min(k + 1, kept.size() - 1);
            forPosesBetween(clip, kept[k], kept[next],
                            [&](double share)
                            {
                                mix(made.at(k, 0), made.at(next, 0), share, _madePose);
                                worst = std::max(worst, _distance.to(_madePose).distance);
                                return worst <= _tolerance;
                            });
        }
        return worst;
    }

    const AnimationSet& _set;
    double _tolerance;
    double _size;
    PoseDistance _distance;
    double _error = 0.0;
    std::vector<JointTransform> _exactPose, _madePose;
};

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
    return maxComponent(glm::dvec3(box.max - box.min));
}

} // namespace osgGpuAnimation
