// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/authoring/WithClipsOf.h>

#include <osgGpuAnimation/authoring/retarget/RigMatch.h>
#include <osgGpuAnimation/math/Rotation.h>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace osgGpuAnimation
{

namespace
{

/// True if a clip has other weights than the defaults in this morph.
bool isMorphMoved(const AnimationSet& set, std::size_t morph)
{
    const std::size_t first = set.firstTrackOfMorph(morph);
    const std::size_t end = first + set.morphs()[morph].blockCount();
    for (const Clip& clip : set.clips())
        for (std::size_t k = 0; k < clip.keyframeCount(); ++k)
            for (std::size_t track = first; track < end; ++track)
                for (std::size_t number = 0; number < MorphWeights::weightsPerBlock; ++number)
                    if (clip.at(k, track)->number(number) != set.restPose()[track].number(number)) return true;
    return false;
}

/// By index of the other set: true if it is somebody's counterpart.
std::vector<bool> usedOf(std::size_t count, const std::vector<int>& counterparts)
{
    std::vector<bool> isUsed(count, false);
    for (const int counterpart : counterparts)
        if (counterpart >= 0) isUsed[counterpart] = true;
    return isUsed;
}

/// The names of those without a counterpart.
std::vector<std::string> atRest(const AnimationSet& set, const RigMatch& match)
{
    std::vector<std::string> names;
    for (std::size_t joint = 0; joint < set.skeleton().jointCount(); ++joint)
        if (match.jointCounterparts()[joint] < 0) names.push_back(set.skeleton().joint(joint).name);
    for (std::size_t morph = 0; morph < set.morphs().size(); ++morph)
        if (match.morphCounterparts()[morph] < 0 && !set.morphs()[morph].isProperty())
            names.push_back(set.morphs()[morph].name);
    return names;
}

/// The names of those that clips of the other set move and that are nobody's counterpart.
std::vector<std::string> leftOut(const AnimationSet& other, const RigMatch& match)
{
    const std::vector<bool> isMoved = movedJoints(other.skeleton(), other.clips());
    const std::vector<bool> isUsed = usedOf(isMoved.size(), match.jointCounterparts());
    const std::vector<bool> isMorphUsed = usedOf(other.morphs().size(), match.morphCounterparts());
    std::vector<std::string> names;
    for (std::size_t joint = 0; joint < isMoved.size(); ++joint)
        if (isMoved[joint] && !isUsed[joint]) names.push_back(other.skeleton().joint(joint).name);
    for (std::size_t morph = 0; morph < isMorphUsed.size(); ++morph)
        if (!isMorphUsed[morph] && isMorphMoved(other, morph)) names.push_back(other.morphs()[morph].name);
    return names;
}

bool isFinite(const glm::dmat3& m)
{
    return std::isfinite(glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]));
}

/// xyz, with the w that is there.
void write(const glm::dvec3& value, glm::vec4& place)
{
    place = glm::vec4(glm::vec3(value), place.w);
}

/// Turns clips of one skeleton into clips of another one, keyframe by keyframe, see withClipsOf().
///
/// Rotations keep their difference from the rest pose in model space. A joint has the local rotation q (r at rest); at
/// rest its parent has the rotation P in model space. With G for its own rotation in model space, that difference is
///
///     D = G · G_rest⁻¹        D(joint) = D(parent) · P · q · r⁻¹ · P⁻¹
///
/// If joint and parent have the same D in both skeletons, then
///
///     q_to = (P_to⁻¹ · P_from) · q_from · (r_from⁻¹ · P_from⁻¹ · P_to · r_to)
///
/// The two factors are constants of the joint, so linear, step and cubic keyframes keep their form: the map is linear
/// in q, and tangents take the same factors. Joints without a counterpart keep their rest rotation and pass on the D of
/// their parent. P and r of `to` are those of RigMatch::toRest(), whose limbs are turned. Where joints of `from`
/// without a counterpart move between two that have one, D is computed from all joints of each keyframe; between
/// keyframes such rotations are slerped.
///
/// Legs of other proportions would take the feet off the ground. Where a body is not copied, its hips are therefore
/// shifted along +Y at each keyframe, so that the body is as high above the ground as in the clip, times the ratio of
/// the hip heights. A body touches the ground with a joint that is as low as the lowest one at rest; or, with ankles,
/// toes and paws, as low as that joint itself at rest. Where `from` rests below all its clips, their ground is the
/// plane y = 0, and both bodies touch it alike.
class ClipRetargeter
{
public:
    /// The rigs and the match must outlive the retargeter.
    ClipRetargeter(const Rig& from, const Rig& to, const RigMatch& match)
        : _from(from), _to(to), _match(match), _trackCount(firstTracksOfMorphs(to.skeleton, to.morphs).back())
    {
        for (const JointMatch& joint : _match.joints())
            _factors.push_back(factorsOf(joint));
        const std::vector<glm::dmat4>& rest = match.fromRest().jointToModel;
        const bool isLow =
            std::any_of(rest.begin(), rest.end(), [](const glm::dmat4& place) { return place[3].y < 0.0; });
        const double lowest = isLow ? lowestHeight(from) : 0.0; // counts where the rest pose is low alone
        for (const BodyMatch& body : _match.bodies())
        {
            const JointMatch& hips = _match.joints()[body.hips];
            if (hips.isSameRig || hips.isByName) continue;
            _bodies.emplace_back(_match, body, lowest);
        }
    }

    /// Errors: a number of the result is not finite; the clip's root motion was removed and its joint's rest pose
    /// differs.
    Result<Clip> retarget(const Clip& clip) const
    {
        Result<std::shared_ptr<const RootMotionCurve>> rootMotion = rootMotionOf(clip);
        if (!rootMotion) return rootMotion.error();
        std::vector<JointTransform> data = restKeyframes(restPose(_to.skeleton, _to.morphs), _to.skeleton.jointCount(),
                                                         clip.transformsPerTrack(), clip.keyframeCount());
        const std::vector<bool> isMoved = movedJoints(_from.skeleton, {clip});
        std::vector<std::size_t> counts; // by joint of `from`: of joints that move, from the root down to this one
        const auto countAt = [&](int joint) { return joint < 0 ? 0 : counts[joint]; };
        for (std::size_t joint = 0; joint < isMoved.size(); ++joint)
            counts.push_back(countAt(_from.skeleton.joint(joint).parent) + isMoved[joint]);
        Writer writer(*this, clip, data);
        std::vector<std::size_t> afar; // indices of matches
        for (std::size_t match = 0; match < _factors.size(); ++match)
        {
            const JointMatch& joint = _match.joints()[match];
            writer.follow(joint, _factors[match], isMoved[joint.source]);
            const bool isDirect =
                joint.isBelow && countAt(_from.skeleton.joint(joint.source).parent) == countAt(joint.above);
            if (!isDirect && !joint.isByName) afar.push_back(match);
        }
        for (std::size_t k = 0; k < clip.keyframeCount() && !afar.empty(); ++k)
        {
            const JointPlaces pose(_from.skeleton, clip.at(k, 0), clip.transformsPerTrack());
            for (const std::size_t match : afar)
                writer.followFromAfar(k, pose, _match.joints()[match], _factors[match]);
        }
        for (const std::size_t match : afar)
            writer.makeLinear(_match.joints()[match]);
        keepOnGround(clip, data);
        copyWeights(clip, data);
        return Clip::create({clip.name(), clip.form(), _to.skeleton.jointCount(), _trackCount, clip.times(),
                             std::move(data), clip.markers(), std::move(rootMotion).value(), nullptr});
    }

private:
    /// How a joint of `to` follows its counterpart.
    struct Factors
    {
        bool copiesRotation = false, copiesTranslation = false, copiesScale = false;
        bool movesBody = false;                           ///< follows the translation without copying it
        bool isTurned = false;                            ///< at rest, see RigMatch::toRest()
        glm::dquat before{1, 0, 0, 0}, after{1, 0, 0, 0}; ///< of the rotation
        glm::dmat3 translation{1.0}; ///< from the space of the source's parent to that of the joint's parent
        glm::dmat3 scale{1.0};
    };

    /// Writes the keyframes of one clip of `to`.
    class Writer
    {
    public:
        Writer(const ClipRetargeter& retargeter, const Clip& clip, std::vector<JointTransform>& data)
            : _retargeter(retargeter), _clip(clip), _data(data), _perTrack(clip.transformsPerTrack())
        {
        }

        void follow(const JointMatch& match, const Factors& factors, bool isMoved)
        {
            const glm::dvec3 ownRest(_retargeter._to.skeleton.joint(match.joint).rest.translation);
            const glm::dvec3 otherRest(_retargeter._from.skeleton.joint(match.source).rest.translation);
            const bool turns = (isMoved || factors.isTurned) && !factors.copiesRotation;
            const bool shifts = isMoved && factors.movesBody && !factors.copiesTranslation;
            const bool grows = isMoved && !factors.copiesScale && isFinite(factors.scale);
            for (std::size_t k = 0; k < _clip.keyframeCount(); ++k)
                for (std::size_t part = 0; part < _perTrack; ++part)
                {
                    const JointTransform& key = _clip.at(k, match.source)[part];
                    JointTransform& out = at(k, match.joint, part);
                    const glm::dvec3 shift(key.translation), growth(key.scale);
                    if (factors.copiesRotation) out.rotation = key.rotation;
                    if (turns)
                        out.rotation = Rotation::toFloats(
                            factors.before * Rotation::quaternion(glm::dvec4(key.rotation)) * factors.after);
                    if (factors.copiesRotation || turns) out.translation.w = key.translation.w;
                    if (factors.copiesTranslation) write(shift, out.translation);
                    if (shifts)
                        write(part == 0 ? ownRest + factors.translation * (shift - otherRest)
                                        : factors.translation * shift,
                              out.translation);
                    if (factors.copiesScale) out.scale = key.scale;
                    if (grows) write(factors.scale * growth, out.scale);
                }
        }

        /// For a joint whose difference from rest depends on several joints of `from`.
        void followFromAfar(std::size_t keyframe, const JointPlaces& pose, const JointMatch& match,
                            const Factors& factors)
        {
            const JointPlaces &fromRest = _retargeter._match.fromRest(), &toRest = _retargeter._match.toRest();
            const Joint& own = _retargeter._to.skeleton.joint(match.joint);
            const glm::dquat parent = toRest.rotationOf(own.parent);
            const glm::dquat back = glm::conjugate(pose.turnOf(match.above, fromRest));
            const glm::dquat turn = back * pose.turnOf(static_cast<int>(match.source), fromRest);
            JointTransform& out = at(keyframe, match.joint, 0);
            out.rotation = Rotation::toFloats(glm::conjugate(parent) * turn * toRest.rotations[match.joint]);
            out.translation = glm::vec4(glm::vec3(own.rest.translation), _perTrack == 3 ? 1.0f : 0.0f);
            if (!factors.movesBody && !match.isSameRig) return;
            const glm::dvec3 way =
                back * (pose.originOf(match.source) - pose.restOriginOf(match.source, match.above, fromRest));
            const glm::dvec3 shift = glm::inverse(toRest.linearOf(own.parent)) * (match.ratio * way);
            write(glm::dvec3(own.rest.translation) + shift, out.translation);
        }

        /// after the last keyframe of followFromAfar()
        void makeLinear(const JointMatch& match)
        {
            if (_perTrack != 3) return;
            const std::size_t last = _clip.keyframeCount() - 1;
            for (std::size_t k = 0; k <= last; ++k)
            {
                at(k, match.joint, 1).rotation = at(k, match.joint, 2).rotation = glm::vec4(0.0f);
                const auto slope = [&](std::size_t from, std::size_t to)
                { return at(to, match.joint, 0).translation - at(from, match.joint, 0).translation; };
                at(k, match.joint, 1).translation = k == 0 ? glm::vec4(0.0f) : slope(k - 1, k);
                at(k, match.joint, 2).translation = k == last ? glm::vec4(0.0f) : slope(k, k + 1);
            }
        }

    private:
        JointTransform& at(std::size_t keyframe, std::size_t joint, std::size_t part)
        {
            return _data[(keyframe * _retargeter._trackCount + joint) * _perTrack + part];
        }

        const ClipRetargeter& _retargeter;
        const Clip& _clip;
        std::vector<JointTransform>& _data;
        std::size_t _perTrack;
    };

    /// Heights at which the parts of a body touch the ground.
    struct Soles
    {
        struct Part
        {
            const JointMatch* match;
            double own, other; ///< heights in model space, in `to` and in `from`
        };
        std::vector<Part> parts;
        std::size_t hips; ///< of `to`
        double ratio;     ///< of the hip heights

        /// A joint that is low at rest stands: it touches the ground at that height. Others touch it at the height of
        /// the lowest joint.
        /// lowest: see lowestHeight()
        Soles(const RigMatch& match, const BodyMatch& body, double lowest)
            : hips(match.joints()[body.hips].joint), ratio(body.ratio)
        {
            constexpr double max = std::numeric_limits<double>::max();
            double ownMin = max, ownMax = -max, otherMin = max, otherMax = -max;
            for (const std::size_t index : body.parts)
            {
                const JointMatch& joint = match.joints()[index];
                const double own = match.toRest().originOf(joint.joint).y,
                             other = match.fromRest().originOf(joint.source).y;
                parts.push_back({&joint, own, other});
                ownMin = std::min(ownMin, own);
                ownMax = std::max(ownMax, own);
                otherMin = std::min(otherMin, other);
                otherMax = std::max(otherMax, other);
            }
            constexpr double low = 0.15; // of the height: ankles and paws, not knees
            for (Part& part : parts)
            {
                const bool stands = part.own - ownMin <= low * (ownMax - ownMin) &&
                                    part.other - otherMin <= low * (otherMax - otherMin);
                if (!stands) part.own = ownMin, part.other = otherMin;
            }
            // A BVH file rests with its hips at the origin, and moves above the plane y = 0.
            const bool isAbove = otherMin < low * (otherMin - otherMax) && lowest > 0.5 * otherMin;
            for (Part& part : parts)
                if (isAbove) part.other += ownMin / ratio - otherMin;
        }

        /// By how much the body of `to` is too low.
        double shortfall(const JointPlaces& from, const JointPlaces& to) const
        {
            double own = std::numeric_limits<double>::max(), other = own;
            for (const Part& part : parts)
            {
                own = std::min(own, to.originOf(part.match->joint).y - part.own);
                other = std::min(other, from.originOf(part.match->source).y - part.other);
            }
            return ratio * other - own;
        }
    };

    /// Of all joints in all clips of the rig.
    static double lowestHeight(const Rig& from)
    {
        double lowest = std::numeric_limits<double>::max();
        for (const Clip& clip : *from.clips)
            for (std::size_t k = 0; k < clip.keyframeCount(); ++k)
            {
                const JointPlaces pose(from.skeleton, clip.at(k, 0), clip.transformsPerTrack());
                for (const glm::dmat4& place : pose.jointToModel)
                    lowest = std::min(lowest, place[3].y);
            }
        return lowest;
    }

    Factors factorsOf(const JointMatch& match) const
    {
        Factors factors;
        if (match.isSameRig)
        {
            factors.copiesRotation = factors.copiesTranslation = factors.copiesScale = true;
            return factors;
        }
        const JointPlaces &fromRest = _match.fromRest(), &toRest = _match.toRest();
        const Joint& own = _to.skeleton.joint(match.joint);
        const Joint& other = _from.skeleton.joint(match.source);
        const glm::dquat ownParent = toRest.rotationOf(own.parent), otherParent = fromRest.rotationOf(other.parent);
        const glm::dquat ownRest = glm::conjugate(ownParent) * toRest.rotations[match.joint],
                         otherRest = Rotation::unitQuaternion(other.rest.rotation);
        factors.before = glm::conjugate(ownParent) * otherParent;
        factors.after = glm::conjugate(otherRest) * glm::conjugate(otherParent) * ownParent * ownRest;
        factors.translation = match.ratio * glm::inverse(toRest.linearOf(own.parent)) * fromRest.linearOf(other.parent);
        factors.movesBody = match.movesBody && isFinite(factors.translation);
        factors.isTurned = !RestPose::areAlike(ownRest, Rotation::unitQuaternion(own.rest.rotation));

        // Squares of the cosines between the joints' axes: exact for axes in another order and for equal factors.
        const glm::dmat3 axes = glm::mat3_cast(glm::conjugate(ownParent * ownRest) * (otherParent * otherRest));
        const glm::dvec3 ownScale(own.rest.scale), otherScale(other.rest.scale);
        for (int column = 0; column < 3; ++column)
            factors.scale[column] = ownScale * axes[column] * axes[column] / otherScale[column];

        const glm::dmat3 change = factors.translation - glm::dmat3(1.0);
        const bool isSameSize =
            glm::length(change[0]) + glm::length(change[1]) + glm::length(change[2]) <= RestPose::tolerance;
        const bool hasSameFrame = RestPose::areAlike(ownParent, otherParent);
        factors.copiesRotation = hasSameFrame && RestPose::areAlike(ownRest, otherRest);
        factors.copiesTranslation =
            hasSameFrame && (!match.movesBody || isSameSize) &&
            RestPose::areAlike(own.rest.translation, other.rest.translation,
                               RestPose::tolerance * static_cast<double>(longestJoint(_to.skeleton)));
        if (match.isByName) factors.copiesRotation = factors.copiesTranslation = true;
        factors.copiesScale =
            factors.copiesRotation && RestPose::areAlike(own.rest.scale, other.rest.scale, RestPose::tolerance);
        return factors;
    }

    void keepOnGround(const Clip& clip, std::vector<JointTransform>& data) const
    {
        if (_bodies.empty()) return;
        const std::size_t perTrack = clip.transformsPerTrack(), stride = _trackCount * perTrack;
        std::vector<glm::vec4> before(_bodies.size(), glm::vec4(0.0f)); // the shifts at the keyframe before
        for (std::size_t k = 0; k < clip.keyframeCount(); ++k)
        {
            const JointPlaces from(_from.skeleton, clip.at(k, 0), perTrack);
            const JointPlaces to(_to.skeleton, &data[k * stride], perTrack);
            for (std::size_t body = 0; body < _bodies.size(); ++body)
            {
                const std::size_t hips = _bodies[body].hips;
                const glm::dvec3 up(0.0, _bodies[body].shortfall(from, to), 0.0);
                const glm::dvec3 shift = glm::inverse(to.linearOf(_to.skeleton.joint(hips).parent)) * up;
                const glm::vec4 rounded(glm::vec3(shift), 0.0f);
                const glm::vec4 added = std::isfinite(glm::dot(shift, shift)) ? rounded : glm::vec4(0.0f);
                JointTransform* key = &data[k * stride + hips * perTrack];
                key[0].translation += added;
                if (perTrack == 3 && k > 0)
                {
                    key[1].translation += added - before[body];
                    (key - stride)[2].translation += added - before[body];
                }
                before[body] = added;
            }
        }
    }

    void copyWeights(const Clip& clip, std::vector<JointTransform>& data) const
    {
        const std::vector<std::size_t> fromTracks = firstTracksOfMorphs(_from.skeleton, _from.morphs);
        const std::vector<std::size_t> toTracks = firstTracksOfMorphs(_to.skeleton, _to.morphs);
        const std::size_t perTrack = clip.transformsPerTrack();
        for (std::size_t morph = 0; morph < _to.morphs.size(); ++morph)
        {
            const int source = _match.morphCounterparts()[morph];
            if (source < 0) continue;
            const std::size_t first = fromTracks[source];
            const std::size_t count = (toTracks[morph + 1] - toTracks[morph]) * perTrack;
            for (std::size_t k = 0; k < clip.keyframeCount(); ++k)
                std::copy_n(clip.at(k, first), count, data.begin() + ((k * _trackCount + toTracks[morph]) * perTrack));
        }
    }

    /// The same curve for the joint of `to`; null if the clip has none.
    Result<std::shared_ptr<const RootMotionCurve>> rootMotionOf(const Clip& clip) const
    {
        const RootMotionCurve* curve = clip.rootMotion();
        if (!curve) return std::shared_ptr<const RootMotionCurve>();
        for (std::size_t match = 0; match < _factors.size(); ++match)
        {
            if (_match.joints()[match].source != curve->joint || !_factors[match].copiesTranslation) continue;
            auto copy = std::make_shared<RootMotionCurve>(*curve);
            copy->joint = _match.joints()[match].joint;
            return std::shared_ptr<const RootMotionCurve>(std::move(copy));
        }
        return Error{"clip \"" + clip.name() + "\": the motion of joint \"" + _from.skeleton.joint(curve->joint).name +
                     "\" was removed before, and the joint has another rest pose here; remove it from the new clips"};
    }

    Rig _from, _to;
    const RigMatch& _match;
    std::size_t _trackCount;       ///< of `to`
    std::vector<Factors> _factors; ///< one per match
    std::vector<Soles> _bodies;    ///< those that are not copied
};

} // namespace

Result<RetargetedSet> withClipsOf(const AnimationSet& set, const AnimationSet& other, const RetargetOptions& options)
{
    if (other.clips().empty()) return Error{"the other set has no clips"};
    const Rig from{other.skeleton(), other.morphs(), &other.clips()}, to{set.skeleton(), set.morphs()};
    const Result<RigMatch> match = RigMatch::create(from, to, options);
    if (!match) return match.error();
    const ClipRetargeter retargeter(from, to, match.value());
    std::vector<Clip> clips = set.clips();
    std::unordered_set<std::string> own;
    for (const Clip& clip : clips)
        own.insert(clip.name());
    std::unordered_set<std::string> taken = own;
    std::unordered_map<std::string, std::size_t> numbers; // the next one, by name
    for (const Clip& clip : other.clips())
    {
        Result<Clip> made = retargeter.retarget(clip);
        if (!made) return made.error();
        std::string name = clip.name();
        for (std::size_t& number = numbers[clip.name()]; own.count(clip.name()) > 0 && taken.count(name) > 0;)
            name = clip.name() + " " + std::to_string(2 + number++);
        taken.insert(name);
        clips.push_back(made.value().withName(name));
    }
    Result<std::shared_ptr<const AnimationSet>> made = set.withClips(std::move(clips));
    if (!made) return made.error();
    RetargetedSet result{made.value(), atRest(set, match.value()), leftOut(other, match.value())};
    for (const JointMatch& joint : match.value().joints())
    {
        result.byName += joint.isByName;
        result.retargeted += !joint.isByName && !joint.isSameRig;
    }
    return result;
}

} // namespace osgGpuAnimation
