// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/authoring/retarget/RigMatch.h>

#include <osgGpuAnimation/authoring/retarget/JointNames.h>
#include <osgGpuAnimation/math/Rotation.h>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <optional>

namespace osgGpuAnimation
{

namespace
{

/// "upperleg_l", "leftupleg": one of two.
bool isOfOneSide(const std::string& name)
{
    const auto has = [&](const char* word) { return name.find(word) != std::string::npos; };
    const std::size_t size = name.size();
    const auto isPlain = [](char letter) { return std::isalnum(static_cast<unsigned char>(letter)) != 0; };
    const bool endsInSide = size >= 2 && (name[size - 1] == 'l' || name[size - 1] == 'r') && !isPlain(name[size - 2]);
    return has("left") || has("right") || endsInSide;
}

bool isCalledHips(const std::string& jointName)
{
    const std::string name = caselessJointName(jointName);
    const bool isHips = name.find("hip") != std::string::npos || name.find("pelvis") != std::string::npos;
    return isHips && !isOfOneSide(name);
}

/// Of the longest joint: exporters round, and files in other units are scaled.
constexpr double boneTolerance = 1e-4;

bool isNear(const glm::dquat& a, const glm::dquat& b)
{
    return std::abs(glm::dot(a, b)) > 1.0 - 1e-6; // some 0.2 degrees
}

/// True if the rest pose of these joints is the first keyframe of the clip, and no mere turn of the whole body, which
/// has no channel.
bool isFirstFrame(const Clip& clip, const Skeleton& skeleton, const std::vector<const JointMatch*>& joints)
{
    bool anyTurns = false;
    for (const JointMatch* match : joints)
    {
        const glm::dquat rest = Rotation::unitQuaternion(skeleton.joint(match->source).rest.rotation);
        const auto isAtRest = [&](std::size_t keyframe)
        { return isNear(Rotation::unitQuaternion(clip.at(keyframe, match->source)->rotation), rest); };
        if (!isAtRest(0)) return false;
        bool turns = false;
        for (std::size_t k = 1; k < clip.keyframeCount() && !turns; ++k)
            turns = !isAtRest(k);
        if (match->movesBody && !turns) return false;
        anyTurns = anyTurns || turns;
    }
    return anyTurns;
}

std::optional<Error> findFault(const Rig& from, const Rig& to, const RetargetOptions& options)
{
    for (const auto& [name, counterpart] : options.counterparts)
    {
        const Result<std::size_t> own = to.skeleton.jointNamed(name);
        if (!own) return own.error();
        if (counterpart.empty()) continue;
        const Result<std::size_t> other = from.skeleton.jointNamed(counterpart);
        if (!other) return Error{"the counterpart of \"" + name + "\": " + other.error().message};
    }
    return std::nullopt;
}

} // namespace

JointPlaces::JointPlaces(const Skeleton& skeleton) : JointPlaces(skeleton, restPose(skeleton, {}).data(), 1) {}

JointPlaces::JointPlaces(const Skeleton& skeleton, const JointTransform* key, std::size_t step)
{
    for (const Joint& joint : skeleton.joints())
    {
        const glm::dmat4 local = key->toMatrix().toColumns();
        jointToModel.push_back(joint.parent < 0 ? local : jointToModel[joint.parent] * local);
        rotations.push_back(rotationOf(joint.parent) * Rotation::unitQuaternion(key->rotation));
        key += step;
    }
}

glm::dquat JointPlaces::rotationOf(int joint) const
{
    return joint < 0 ? glm::dquat(1, 0, 0, 0) : rotations[joint];
}

glm::dmat3 JointPlaces::linearOf(int joint) const
{
    return joint < 0 ? glm::dmat3(1.0) : glm::dmat3(jointToModel[joint]);
}

glm::dvec3 JointPlaces::restOriginOf(std::size_t joint, int ancestor, const JointPlaces& rest) const
{
    const glm::dvec3 origin = rest.originOf(joint);
    if (ancestor < 0) return origin;
    return glm::dvec3(jointToModel[ancestor] * (glm::inverse(rest.jointToModel[ancestor]) * glm::dvec4(origin, 1.0)));
}

namespace RestPose
{

bool areAlike(const glm::dquat& a, const glm::dquat& b)
{
    return std::abs(glm::dot(a, b)) > 1.0 - tolerance * tolerance;
}

bool areAlike(const glm::vec4& a, const glm::vec4& b, double max)
{
    return glm::length(glm::dvec3(a) - glm::dvec3(b)) <= max;
}

} // namespace RestPose

std::vector<bool> movedJoints(const Skeleton& skeleton, const std::vector<Clip>& clips)
{
    const double nearby = RestPose::tolerance * static_cast<double>(longestJoint(skeleton));
    const auto isLike = [&](const JointTransform& a, const JointTransform& b, bool isTangent)
    {
        const bool isTurnedAlike =
            isTangent ? glm::length(glm::dvec4(a.rotation)) <= RestPose::tolerance
                      : RestPose::areAlike(Rotation::unitQuaternion(a.rotation), Rotation::unitQuaternion(b.rotation));
        return isTurnedAlike && RestPose::areAlike(a.translation, b.translation, nearby) &&
               RestPose::areAlike(a.scale, b.scale, RestPose::tolerance);
    };
    std::vector<bool> isMoved(skeleton.jointCount(), false);
    for (const Clip& clip : clips)
        for (std::size_t k = 0; k < clip.keyframeCount(); ++k)
            for (std::size_t joint = 0; joint < isMoved.size(); ++joint)
                for (std::size_t part = 0; part < clip.transformsPerTrack() && !isMoved[joint]; ++part)
                    isMoved[joint] =
                        !isLike(clip.at(k, joint)[part], part == 0 ? skeleton.joint(joint).rest : noTangent, part != 0);
    return isMoved;
}

RigMatch::RigMatch(const Rig& from, const Rig& to, const RetargetOptions& options)
    : _fromRest(from.skeleton), _toRest(to.skeleton),
      _jointCounterparts(
          findCounterparts(namesIn(to.skeleton.joints()), namesIn(from.skeleton.joints()), options.counterparts, true)),
      _morphCounterparts(findCounterparts(namesIn(to.morphs), namesIn(from.morphs), {})),
      _areHips(to.skeleton.jointCount())
{
    for (std::size_t morph = 0; morph < to.morphs.size(); ++morph)
    {
        int& source = _morphCounterparts[morph];
        if (source < 0) continue;
        const MorphWeights& counterpart = from.morphs[source];
        if (counterpart.defaults.size() != to.morphs[morph].defaults.size() ||
            counterpart.isProperty() != to.morphs[morph].isProperty())
            source = -1;
    }
}

Result<RigMatch> RigMatch::create(const Rig& from, const Rig& to, const RetargetOptions& options)
{
    if (std::optional<Error> fault = findFault(from, to, options)) return *fault;
    RigMatch match(from, to, options);
    const auto isNone = [](int counterpart) { return counterpart < 0; };
    const std::vector<int>&joints = match._jointCounterparts, &morphs = match._morphCounterparts;
    if (std::all_of(joints.begin(), joints.end(), isNone) && std::all_of(morphs.begin(), morphs.end(), isNone))
        return Error{"no joint has a counterpart: the joints are " + quotedNames(to.skeleton.joints()) +
                     "; those of the clips are " + quotedNames(from.skeleton.joints())};
    match.addMatches(from, to);
    match.markSameRigs(from, to);
    match.findHips(to.skeleton, options.hips);
    if (!options.hips.empty() && std::find(match._areHips.begin(), match._areHips.end(), true) == match._areHips.end())
        return Error{"the hips \"" + options.hips + "\" are no joint with a counterpart; the joints are " +
                     quotedNames(to.skeleton.joints())};
    match.findBodies(to.skeleton);
    match.markByName(from, to, options.match);
    match.turnLimbs(from.skeleton, to.skeleton);
    return match;
}

void RigMatch::addMatches(const Rig& from, const Rig& to)
{
    std::vector<int> aboveOf; // by joint: the counterpart of the nearest ancestor that has one
    for (std::size_t joint = 0; joint < _jointCounterparts.size(); ++joint)
    {
        const int parent = to.skeleton.joint(joint).parent;
        const auto up = static_cast<std::size_t>(std::max(parent, 0));
        aboveOf.push_back(parent < 0 ? -1 : _jointCounterparts[up] >= 0 ? _jointCounterparts[up] : aboveOf[up]);
        if (_jointCounterparts[joint] < 0) continue;
        JointMatch match;
        match.joint = joint;
        match.source = static_cast<std::size_t>(_jointCounterparts[joint]);
        match.above = aboveOf[joint];
        int ancestor = from.skeleton.joint(match.source).parent;
        while (ancestor >= 0 && ancestor != match.above)
            ancestor = from.skeleton.joint(ancestor).parent;
        match.isBelow = ancestor == match.above;
        _matches.push_back(match);
    }
}

void RigMatch::markSameRigs(const Rig& from, const Rig& to)
{
    std::vector<int> topOf; // by joint: the highest joint with a counterpart, itself or above
    for (std::size_t joint = 0; joint < _jointCounterparts.size(); ++joint)
    {
        const int parent = to.skeleton.joint(joint).parent;
        topOf.push_back(parent < 0 ? -1 : topOf[parent]);
        if (topOf.back() < 0 && _jointCounterparts[joint] >= 0) topOf.back() = static_cast<int>(joint);
    }
    std::vector<bool> isSame(_jointCounterparts.size(), true); // by top
    const double nearby = RestPose::tolerance * static_cast<double>(longestJoint(to.skeleton));
    for (const JointMatch& match : _matches)
    {
        const Joint& own = to.skeleton.joint(match.joint);
        const Joint& other = from.skeleton.joint(match.source);
        const auto top = static_cast<std::size_t>(topOf[match.joint]);
        const bool isChildInBoth =
            own.parent >= 0 && other.parent >= 0 && _jointCounterparts[own.parent] == other.parent;
        const bool isRestAlike = RestPose::areAlike(Rotation::unitQuaternion(own.rest.rotation),
                                                    Rotation::unitQuaternion(other.rest.rotation)) &&
                                 RestPose::areAlike(own.rest.translation, other.rest.translation, nearby) &&
                                 RestPose::areAlike(own.rest.scale, other.rest.scale, RestPose::tolerance);
        if (!isRestAlike || !(top == match.joint || isChildInBoth)) isSame[top] = false;
    }
    for (JointMatch& match : _matches)
        match.isSameRig = isSame[topOf[match.joint]];
}

/// True if the joints with a counterpart have the same offsets from their parents; those that move the body may be
/// anywhere.
bool RigMatch::hasSameBones(const Rig& from, const Rig& to) const
{
    const double nearby = boneTolerance * static_cast<double>(longestJoint(to.skeleton));
    return std::all_of(_matches.begin(), _matches.end(),
                       [&](const JointMatch& match)
                       {
                           const Joint& own = to.skeleton.joint(match.joint);
                           const Joint& other = from.skeleton.joint(match.source);
                           if (match.movesBody || own.parent < 0) return true;
                           return other.parent >= 0 && _jointCounterparts[own.parent] == other.parent &&
                                  RestPose::areAlike(own.rest.translation, other.rest.translation, nearby);
                       });
}

void RigMatch::markByName(const Rig& from, const Rig& to, ClipMatch wanted)
{
    if (wanted == ClipMatch::Retarget) return;
    if (wanted == ClipMatch::Automatic)
    {
        if (!from.clips || !hasSameBones(from, to)) return;
        std::vector<const JointMatch*> others; // those whose counterparts have other rest rotations
        for (const JointMatch& match : _matches)
            if (!isNear(Rotation::unitQuaternion(to.skeleton.joint(match.joint).rest.rotation),
                        Rotation::unitQuaternion(from.skeleton.joint(match.source).rest.rotation)))
                others.push_back(&match);
        if (std::none_of(from.clips->begin(), from.clips->end(),
                         [&](const Clip& clip) { return isFirstFrame(clip, from.skeleton, others); }))
            return;
    }
    for (JointMatch& match : _matches)
        match.isByName = !match.isSameRig;
}

/// The joints of that name; without a name those that are called so, else the first joint below which the body
/// branches, else the first joint of all. Several characters in one skeleton have several.
void RigMatch::findHips(const Skeleton& skeleton, const std::string& name)
{
    std::vector<int> sizes(skeleton.jointCount(), 0);    // joints with a counterpart, at or below
    std::vector<int> branches(skeleton.jointCount(), 0); // children with at least two of those
    for (std::size_t joint = skeleton.jointCount(); joint-- > 0;)
    {
        sizes[joint] += _jointCounterparts[joint] >= 0;
        if (skeleton.joint(joint).parent < 0) continue;
        const auto parent = static_cast<std::size_t>(skeleton.joint(joint).parent);
        sizes[parent] += sizes[joint];
        branches[parent] += sizes[joint] >= 2;
    }
    std::string wanted = name;
    const auto find = [&](const auto& isIt)
    {
        if (!wanted.empty()) return;
        const auto found = std::find_if(_matches.begin(), _matches.end(), isIt);
        if (found != _matches.end()) wanted = skeleton.joint(found->joint).name;
    };
    find([&](const JointMatch& match) { return isCalledHips(skeleton.joint(match.joint).name); });
    find([&](const JointMatch& match) { return branches[match.joint] >= 2; });
    find([](const JointMatch&) { return true; });
    for (const JointMatch& match : _matches)
        _areHips[match.joint] = bareJointName(skeleton.joint(match.joint).name) == bareJointName(wanted);
}

/// The ratio of the lengths of the legs: from the first joint below the hips down to the lowest one at rest. Of
/// skeletons without legs, the ratio of their sizes. legOf: by joint of `to`, the highest joint with a counterpart
/// below the hips.
double RigMatch::ratioOf(const BodyMatch& body, const std::vector<int>& legOf) const
{
    glm::dvec3 ownMin(std::numeric_limits<double>::max()), ownMax(-ownMin);
    glm::dvec3 otherMin(ownMin), otherMax(ownMax);
    const JointMatch* lowest = &_matches[body.hips];
    for (const std::size_t part : body.parts)
    {
        const glm::dvec3 own = _toRest.originOf(_matches[part].joint),
                         other = _fromRest.originOf(_matches[part].source);
        if (own.y < _toRest.originOf(lowest->joint).y) lowest = &_matches[part];
        ownMin = glm::min(ownMin, own);
        ownMax = glm::max(ownMax, own);
        otherMin = glm::min(otherMin, other);
        otherMax = glm::max(otherMax, other);
    }
    const int leg = legOf[lowest->joint];
    const bool isLeg = leg >= 0 && static_cast<std::size_t>(leg) != lowest->joint;
    const std::size_t top = isLeg ? static_cast<std::size_t>(leg) : _matches[body.hips].joint;
    const auto topSource = static_cast<std::size_t>(_jointCounterparts[top]);
    const double own = glm::distance(_toRest.originOf(top), _toRest.originOf(lowest->joint));
    const double other = glm::distance(_fromRest.originOf(topSource), _fromRest.originOf(lowest->source));
    const double ownSize = glm::length(ownMax - ownMin), otherSize = glm::length(otherMax - otherMin);
    constexpr double minShare = 0.01; // of the size: less is no leg
    if (own > minShare * ownSize && other > minShare * otherSize) return own / other;
    return ownSize > 0.0 && otherSize > 0.0 ? ownSize / otherSize : 1.0;
}

void RigMatch::findBodies(const Skeleton& skeleton)
{
    std::vector<int> bodyOf(skeleton.jointCount(), -1), legOf(skeleton.jointCount(), -1);
    auto match = _matches.begin();
    for (std::size_t joint = 0; joint < skeleton.jointCount(); ++joint)
    {
        const int parent = skeleton.joint(joint).parent;
        if (parent >= 0)
        {
            bodyOf[joint] = bodyOf[parent];
            legOf[joint] = legOf[parent];
        }
        if (match == _matches.end() || match->joint != joint) continue;
        const auto index = static_cast<std::size_t>(match++ - _matches.begin());
        if (_areHips[joint])
        {
            bodyOf[joint] = static_cast<int>(_bodies.size());
            legOf[joint] = -1;
            _bodies.push_back({index});
        }
        else if (bodyOf[joint] >= 0 && legOf[joint] < 0)
            legOf[joint] = static_cast<int>(joint);
        if (bodyOf[joint] >= 0) _bodies[bodyOf[joint]].parts.push_back(index);
    }
    for (BodyMatch& body : _bodies)
        body.ratio = ratioOf(body, legOf);
    // The hips and the joints above them move the body.
    std::vector<double> ratios(skeleton.jointCount(), 0.0); // 0: not marked
    for (const BodyMatch& body : _bodies)
        for (int joint = static_cast<int>(_matches[body.hips].joint); joint >= 0 && ratios[joint] == 0.0;
             joint = skeleton.joint(joint).parent)
            ratios[joint] = body.ratio;
    for (JointMatch& match : _matches)
    {
        match.movesBody = ratios[match.joint] != 0.0;
        if (match.movesBody) match.ratio = ratios[match.joint];
    }
}

/// Characters rest in a T, in an A or with spread legs: upper and lower arms and legs of a known rig are turned in
/// model space, the shortest way, until they point where their counterparts do. Hands turn with the arms; feet with a
/// counterpart stay flat.
void RigMatch::turnLimbs(const Skeleton& from, const Skeleton& to)
{
    const std::vector<int> bones = limbBones(namesIn(to.joints()));
    std::vector<int> boneAt, ends(bones.size(), -1); // by joint: the nearest bone of a limb up there; the next bone
    for (std::size_t joint = 0; joint < bones.size(); ++joint)
    {
        const int parent = to.joint(joint).parent, above = parent < 0 ? -1 : boneAt[parent];
        if (above >= 0 && bones[joint] == bones[above] + 2) ends[above] = static_cast<int>(joint);
        boneAt.push_back(bones[joint] >= 0 ? static_cast<int>(joint) : above);
    }
    const auto unscaled = [](const Skeleton& skeleton) // rotations know no mirrors
    {
        std::vector<JointTransform> keys = restPose(skeleton, {});
        for (JointTransform& key : keys)
            key.scale = glm::vec4(1, 1, 1, 0);
        return JointPlaces(skeleton, keys.data(), 1);
    };
    const JointPlaces ownRest = unscaled(to), otherRest = unscaled(from);
    const double ownMin = RestPose::tolerance * static_cast<double>(longestJoint(to)),
                 otherMin = RestPose::tolerance * static_cast<double>(longestJoint(from));
    std::vector<glm::dquat> turns;
    for (std::size_t joint = 0; joint < bones.size(); ++joint)
    {
        const int parent = to.joint(joint).parent, source = _jointCounterparts[joint], end = ends[joint];
        const bool isFoot = bones[joint] / 2 == 5 && source >= 0;
        turns.push_back(parent < 0 || isFoot ? glm::dquat(1, 0, 0, 0) : turns[parent]);
        if (end >= 0 && source >= 0 && _jointCounterparts[end] >= 0)
        {
            const glm::dvec3 own = turns[joint] * (ownRest.originOf(end) - ownRest.originOf(joint));
            const glm::dvec3 other = otherRest.originOf(_jointCounterparts[end]) - otherRest.originOf(source);
            if (glm::length(own) > ownMin && glm::length(other) > otherMin)
                turns[joint] = glm::dquat(glm::normalize(own), glm::normalize(other)) * turns[joint];
        }
        _toRest.rotations[joint] = turns[joint] * _toRest.rotations[joint];
    }
}

} // namespace osgGpuAnimation
