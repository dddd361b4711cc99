// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Clip.h>
#include <osgGpuAnimation/animation/Skeleton.h>
#include <osgGpuAnimation/authoring/RetargetOptions.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// A skeleton, its morph weights and, of the clips' rig, the clips. All must outlive it.
struct Rig
{
    const Skeleton& skeleton;
    const std::vector<MorphWeights>& morphs;
    const std::vector<Clip>* clips = nullptr;
};

/// Where the joints of a skeleton are in one pose, in model space.
struct JointPlaces
{
    explicit JointPlaces(const Skeleton& skeleton); ///< at rest
    /// key: the first joint's transform; those of the others follow, at every `step`th place.
    JointPlaces(const Skeleton& skeleton, const JointTransform* key, std::size_t step);

    std::vector<glm::dmat4> jointToModel;
    std::vector<glm::dquat> rotations; ///< of the joints, in model space

    glm::dquat rotationOf(int joint) const; ///< the identity for -1
    glm::dmat3 linearOf(int joint) const;   ///< rotation and scale; the identity for -1
    glm::dvec3 originOf(std::size_t joint) const { return glm::dvec3(jointToModel[joint][3]); }
    /// The joint's difference from rest; the identity for -1.
    glm::dquat turnOf(int joint, const JointPlaces& rest) const
    {
        return rotationOf(joint) * glm::conjugate(rest.rotationOf(joint));
    }
    /// Where the joint would be if it kept its rest transform relative to an ancestor, -1 for the model.
    glm::dvec3 restOriginOf(std::size_t joint, int ancestor, const JointPlaces& rest) const;
};

/// Comparisons of rest poses, apart from rounding.
namespace RestPose
{

constexpr double tolerance = 1e-6; ///< radians, or a share

bool areAlike(const glm::dquat& a, const glm::dquat& b); ///< the same rotation
/// The distance of xyz is at most `most`.
bool areAlike(const glm::vec4& a, const glm::vec4& b, double max);

} // namespace RestPose

/// One per joint of the skeleton: true if any of the clips moves it away from its rest pose, apart from rounding.
std::vector<bool> movedJoints(const Skeleton& skeleton, const std::vector<Clip>& clips);

/// A joint of the rig `to` with its counterpart.
struct JointMatch
{
    std::size_t joint = 0;  ///< of `to`
    std::size_t source = 0; ///< of `from`: its counterpart
    int above = -1;         ///< of `from`: the counterpart of the joint's nearest ancestor that has one
    bool isBelow = true;    ///< the source is a descendant of `above`
    /// All joints with a counterpart that are connected with this one have the same local rest transforms: whatever
    /// moved or turned the rig as a whole, its local transforms are the same.
    bool isSameRig = false;
    bool isByName = false;  ///< takes the local transforms as they are, in spite of another rest pose
    bool movesBody = false; ///< true for the hips and the joints above them: their translations count
    double ratio = 1.0;     ///< of the hip heights, `to` by `from`
};

/// The hips and what is below them.
struct BodyMatch
{
    std::size_t hips = 0;             ///< an index of RigMatch::joints()
    std::vector<std::size_t> parts{}; ///< the same: the hips and all joints below them
    double ratio = 1.0;               ///< of the hip heights, `to` by `from`
};

/// The counterparts of one rig's joints and morphs in another one.
class RigMatch
{
public:
    /// Errors: a name in the options that does not exist; hips without a counterpart; neither a joint nor a morph has
    /// one.
    static Result<RigMatch> create(const Rig& from, const Rig& to, const RetargetOptions& options);

    const std::vector<JointMatch>& joints() const { return _matches; } ///< in level order
    const std::vector<BodyMatch>& bodies() const { return _bodies; }
    const std::vector<int>& jointCounterparts() const { return _jointCounterparts; } ///< by joint of `to`; -1: none
    const std::vector<int>& morphCounterparts() const { return _morphCounterparts; } ///< by morph of `to`; -1: none
    const JointPlaces& fromRest() const { return _fromRest; }
    /// Its rotations are those of a rest pose whose limbs point where those of fromRest() do, see turnLimbs(); its
    /// matrices are not.
    const JointPlaces& toRest() const { return _toRest; }

private:
    RigMatch(const Rig& from, const Rig& to, const RetargetOptions& options);
    void addMatches(const Rig& from, const Rig& to);
    void markSameRigs(const Rig& from, const Rig& to);
    void markByName(const Rig& from, const Rig& to, ClipMatch wanted);
    bool hasSameBones(const Rig& from, const Rig& to) const;
    void findHips(const Skeleton& skeleton, const std::string& name);
    void findBodies(const Skeleton& skeleton);
    double ratioOf(const BodyMatch& body, const std::vector<int>& legOf) const;
    void turnLimbs(const Skeleton& from, const Skeleton& to);

    JointPlaces _fromRest, _toRest;
    std::vector<int> _jointCounterparts;
    std::vector<int> _morphCounterparts;
    std::vector<JointMatch> _matches;
    std::vector<BodyMatch> _bodies;
    std::vector<bool> _areHips; ///< by joint of `to`
};

} // namespace osgGpuAnimation
