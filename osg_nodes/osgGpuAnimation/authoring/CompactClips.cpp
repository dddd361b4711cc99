// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/authoring/CompactClips.h>

#include <osgGpuAnimation/animation/bounds/ClipBounds.h>
#include <osgGpuAnimation/animation/keyframes/CompactTracks.h>
#include <osgGpuAnimation/animation/keyframes/TrackBlend.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/authoring/keyframes/PoseDistance.h>
#include <osgGpuAnimation/math/Rotation.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

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

constexpr std::array<glm::vec4 JointTransform::*, 3> partsOfTracks{&JointTransform::translation,
                                                                   &JointTransform::rotation, &JointTransform::scale};
constexpr std::size_t rotationPart = 1;

const CompactTracks::Part& partOf(const CompactTracks::Track& track, std::size_t part)
{
    if (part == rotationPart) return track.rotation;
    return part == 0 ? track.translation : track.scale;
}

/// The place for RotationPart: that of a component which is never small, else maxPlace.
std::uint32_t omittedPlace(const std::vector<glm::vec4>& rotations)
{
    // An omitted component of 0.3 makes errors of the others up to three times larger: worth two bits per keyframe.
    constexpr double min = 0.3;
    glm::dvec4 smallest(1.0);
    for (const glm::vec4& rotation : rotations)
        smallest = glm::min(smallest, glm::abs(Rotation::unit(glm::dvec4(rotation))));
    int best = 3;
    for (int i = 0; i < 3; ++i)
        if (smallest[i] > smallest[best]) best = i;
    return smallest[best] >= min ? static_cast<std::uint32_t>(best) : CompactTracks::maxPlace;
}

/// Chooses how many bits each number of a compact clip takes: it begins with few, and each raise() gives one more to
/// the numbers whose rounding moves a point most.
class BitAllocator
{
public:
    /// wanted: trackCount() transforms per keyframe; they are rounded here. The set must outlive this object.
    BitAllocator(const AnimationSet& set, std::vector<JointTransform> wanted)
        : _set(set), _wanted(std::move(wanted)), _rounded(_wanted), _moving(set.skeleton().jointCount())
    {
        const std::size_t stride = set.trackCount();
        _tracks.tracks.resize(_moving.size());
        for (std::size_t joint = 0; joint < _moving.size(); ++joint)
        {
            for (std::size_t part = 0; part < partCount; ++part)
            {
                std::vector<glm::vec4> keys;
                for (std::size_t at = joint; at < _wanted.size(); at += stride)
                    keys.push_back(_wanted[at].*partsOfTracks[part]);
                Moving& moving = _moving[joint][part];
                moving.isMoving =
                    std::any_of(keys.begin(), keys.end(), [&](const glm::vec4& key) { return key != keys.front(); });
                if (!moving.isMoving) continue;
                std::uint32_t& place = _tracks.tracks[joint].rotation.place;
                if (part == rotationPart) place = omittedPlace(keys);
                for (const glm::vec4& key : keys)
                {
                    std::uint32_t omitted = place;
                    const glm::vec3 value =
                        part == rotationPart ? CompactTracks::componentsOf(key, omitted) : glm::vec3(key);
                    moving.min = glm::min(moving.min, value);
                    moving.max = glm::max(moving.max, value);
                }
                setBits(joint, part, glm::uvec3(0u));
            }
            round(joint);
        }
    }

    /// Begins with the bits with which no number alone moves a point of the first keyframe farther than `most`.
    void begin(const PoseDistance& distance, double max)
    {
        const std::vector<JointTransform> pose(_rounded.begin(), _rounded.begin() + _set.trackCount());
        std::vector<AffineMatrix> jointToModel;
        Pose::jointToModel(_set, pose, AffineMatrix(), jointToModel);
        // Of each joint a point that it moves far: its own one, or that of a child. In its own space.
        std::vector<glm::vec3> far(_moving.size());
        for (std::size_t joint = 0; joint < far.size(); ++joint)
            far[joint] = distance.points(joint).back();
        for (std::size_t joint = far.size(); joint-- > 0;)
        {
            forNumbers(joint,
                       [&](const Number& number)
                       {
                           while (bitsOf(joint, number.part)[number.axis] < CompactTracks::maxBits &&
                                  effect(pose[joint], number, far[joint], jointToModel) > max)
                               addBit(number);
                       });
            round(joint);
            const int parent = _set.skeleton().joint(joint).parent;
            if (parent < 0) continue;
            const glm::vec3 inParent = pose[joint].toMatrix().transformPoint(far[joint]);
            glm::vec3& farther = far[parent];
            if (glm::length(inParent) > glm::length(farther)) farther = inParent;
        }
    }

    /// Gives numbers that move the point more bits. pose: a mix of rounded keyframes, the last one of distance.to().
    /// False: all of them have the most bits.
    bool raise(const std::vector<JointTransform>& pose, const PoseDistance& distance, const PoseDistance::Worst& worst)
    {
        // Numbers of nearly the same effect are raised together: one at a time takes long for deep skeletons.
        constexpr double share = 0.9;
        _effects.clear();
        double max = 0.0;
        glm::vec3 point = worst.point;
        for (int joint = static_cast<int>(worst.joint); joint >= 0;)
        {
            const auto index = static_cast<std::size_t>(joint);
            forNumbers(index,
                       [&](const Number& number)
                       {
                           _effects.emplace_back(effect(pose[index], number, point, distance.jointToModel()), number);
                           max = std::max(max, _effects.back().first);
                       });
            point = pose[index].toMatrix().transformPoint(point);
            joint = _set.skeleton().joint(index).parent;
        }
        if (!(max > 0.0)) return false;
        for (const auto& [way, number] : _effects)
        {
            if (!(way >= share * max)) continue;
            addBit(number);
            round(number.joint);
        }
        return true;
    }

    /// The rounded keyframes.
    const std::vector<JointTransform>& rounded() const { return _rounded; }
    /// The tracks, packed, and the keyframes that they show. False: a record would be too large.
    bool finish(CompactTracks& outTracks, std::vector<JointTransform>& outData)
    {
        outTracks = _tracks;
        outData = _wanted;
        for (std::size_t joint = 0; joint < _moving.size(); ++joint)
        {
            CompactTracks::Track& track = outTracks.tracks[joint];
            // A part that never differs from its base is constant.
            const auto hold = [&](CompactTracks::Part& part, glm::vec4 JointTransform::*which)
            {
                if (!part.isMoving() || part.bits != glm::uvec3(0u)) return;
                for (std::size_t at = joint; at < outData.size(); at += _set.trackCount())
                    outData[at].*which = _rounded[at].*which;
                part.firstBit = -1;
            };
            hold(track.translation, &JointTransform::translation);
            if (track.rotation.place != CompactTracks::maxPlace) hold(track.rotation, &JointTransform::rotation);
            hold(track.scale, &JointTransform::scale);
        }
        return outTracks.pack(outData, _set.trackCount());
    }

private:
    static constexpr std::size_t partCount = 3;
    /// A part of a joint that moves: the range of its values.
    struct Moving
    {
        bool isMoving = false;
        glm::vec3 min{std::numeric_limits<float>::max()};
        glm::vec3 max{std::numeric_limits<float>::lowest()};
    };
    struct Number
    {
        std::size_t joint = 0;
        std::size_t part = 0;
        int axis = 0;
    };

    /// Calls visit(number) for the moving numbers of the joint that may have more bits.
    template <typename Visit>
    void forNumbers(std::size_t joint, Visit visit) const
    {
        for (std::size_t part = 0; part < partCount; ++part)
            for (int axis = 0; _moving[joint][part].isMoving && axis < 3; ++axis)
                if (bitsOf(joint, part)[axis] < CompactTracks::maxBits) visit(Number{joint, part, axis});
    }

    glm::uvec3 bitsOf(std::size_t joint, std::size_t part) const { return partOf(_tracks.tracks[joint], part).bits; }

    float maxError(const Number& number) const
    {
        const Moving& moving = _moving[number.joint][number.part];
        const CompactTracks::Part& part = partOf(_tracks.tracks[number.joint], number.part);
        const float step =
            part.bits[number.axis] == 0 ? moving.max[number.axis] - moving.min[number.axis] : part.step[number.axis];
        return 0.5f * step;
    }

    /// The way of a point in the joint's space if the number is off by its largest error. transform: the joint's.
    double effect(const JointTransform& transform, const Number& number, const glm::vec3& point,
                  const std::vector<AffineMatrix>& jointToModel) const
    {
        JointTransform off = transform;
        const float error = maxError(number);
        if (number.part == rotationPart)
        {
            std::uint32_t place = _tracks.tracks[number.joint].rotation.place;
            glm::vec3 components = CompactTracks::componentsOf(off.rotation, place);
            components[number.axis] += components[number.axis] > 0.0f ? -error : error;
            off.rotation = CompactTracks::rotationOf(components, place);
        }
        else
            (off.*partsOfTracks[number.part])[number.axis] += error;
        const glm::vec3 way = off.toMatrix().transformPoint(point) - transform.toMatrix().transformPoint(point);
        const int parent = _set.skeleton().joint(number.joint).parent;
        return static_cast<double>(glm::length(parent < 0 ? way : jointToModel[parent].transformVector(way)));
    }

    void addBit(const Number& number)
    {
        glm::uvec3 bits = bitsOf(number.joint, number.part);
        const float before = maxError(number);
        // The first bits of a narrow range gain nothing: it is rounded to units.
        do
        {
            ++bits[number.axis];
            setBits(number.joint, number.part, bits);
        } while (bits[number.axis] < CompactTracks::maxBits && !(maxError(number) < before));
    }

    void setBits(std::size_t joint, std::size_t part, const glm::uvec3& bits)
    {
        CompactTracks::Track& track = _tracks.tracks[joint];
        const Moving& moving = _moving[joint][part];
        const auto set = [&](auto& one)
        {
            one.firstBit = 0;
            one.setRange(moving.min, moving.max, bits);
        };
        if (part == rotationPart)
            set(track.rotation);
        else
            set(part == 0 ? track.translation : track.scale);
    }

    void round(std::size_t joint)
    {
        for (std::size_t at = joint; at < _wanted.size(); at += _set.trackCount())
        {
            _rounded[at] = _wanted[at];
            CompactTracks::round(_tracks.tracks[joint], _rounded[at]);
        }
    }

    const AnimationSet& _set;
    std::vector<JointTransform> _wanted, _rounded;
    std::vector<std::array<Moving, partCount>> _moving; ///< by joint: translation, rotation, scale
    CompactTracks _tracks;
    std::vector<std::pair<double, Number>> _effects; ///< of the last raise()
};

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
                    bool isNear = true;
                    for (std::size_t at = joint; at < data.size(); at += stride)
                        isNear = isNear && distance(data[at], value) <= limit;
                    if (!isNear) continue;
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
