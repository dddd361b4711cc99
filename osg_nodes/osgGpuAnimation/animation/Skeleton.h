// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/JointTransform.h>
#include <osgGpuAnimation/animation/Result.h>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <string>
#include <unordered_map>
#include <variant>
#include <vector>

namespace osgGpuAnimation
{

/// The morph weights of one mesh instance: one node of the file with a mesh that has morph targets. The GPU treats them
/// like joints: twelve weights form a **weight block**, which takes the 48 bytes of a joint transform in a keyframe and
/// the 48 bytes of a palette entry in the output.
///
/// A group of numbers without a node, named by a glTF JSON pointer, is a **property** of the file that clips animate,
/// for example `/materials/0/pbrMetallicRoughness/baseColorFactor`. Clips, layers and masks treat it like weights, but
/// no vertex depends on it: it has no palette entry, and Pose::properties() computes it on the CPU.
struct MorphWeights
{
    static constexpr std::size_t weightsPerBlock = 12; ///< the numbers of one JointTransform

    std::string name;            ///< not necessarily unique
    int sourceNode = -1;         ///< number of the node in the file
    std::vector<float> defaults; ///< one per target: the weights of the node, else of the mesh, else 0

    /// True for a property: no source node, and a name that begins with a slash.
    bool isProperty() const { return sourceNode < 0 && !name.empty() && name.front() == '/'; }
    /// blocks that hold all weights; the last may be partly used
    std::size_t blockCount() const { return (defaults.size() + weightsPerBlock - 1) / weightsPerBlock; }
};

/// A node of the file that moves, or that carries a node or mesh that moves.
struct Joint
{
    std::string name;    ///< not necessarily unique
    int parent = -1;     ///< index of the parent joint, -1 for a root
    JointTransform rest; ///< used if no clip animates the joint
    int sourceNode = -1; ///< number of the node in the file, -1 if it has none
};

/// The joints of an AnimationSet in **level order**: all roots, then all their children, and so on. Parents come before
/// children, and each level is one contiguous range (one flat draw on the GPU).
class Skeleton
{
public:
    /// Sorts the joints by depth; the order within a level stays. Normalizes rest rotations (a quaternion of length 0
    /// becomes the identity). Errors: a parent out of range, a cycle, a rest transform that is not finite.
    static Result<Skeleton> create(std::vector<Joint> joints);

    std::size_t jointCount() const { return _joints.size(); }              ///< number of joints
    const std::vector<Joint>& joints() const { return _joints; }           ///< in level order
    const Joint& joint(std::size_t index) const { return _joints[index]; } ///< index: below jointCount()

    /// jointCount() depths; the depth of a root is 0.
    const std::vector<int>& depths() const { return _depths; }
    std::size_t levelCount() const; ///< number of different depths

    /// The joint that was at this index in the input of create().
    int jointOfInput(std::size_t inputIndex) const { return _jointOfInput[inputIndex]; }
    /// The first joint of that node of the file; -1 if there is none.
    int jointOfSourceNode(int node) const;
    /// The first joint of that name; -1 if there is none.
    int findJoint(const std::string& name) const;
    /// The first joint of that name. Error: no joint has the name; the message lists the existing names.
    Result<std::size_t> jointNamed(const std::string& name) const;

private:
    Skeleton() = default;

    std::vector<Joint> _joints;
    std::vector<int> _depths;
    std::vector<int> _jointOfInput;
    std::unordered_map<int, int> _jointOfSourceNode;
};

/// The first track of each morph's weight blocks, and at the end the number of all tracks. Joints have the first
/// tracks.
std::vector<std::size_t> firstTracksOfMorphs(const Skeleton& skeleton, const std::vector<MorphWeights>& morphs);

/// One JointTransform per track: the rest transforms of the joints, then the default weights as weight blocks.
std::vector<JointTransform> restPose(const Skeleton& skeleton, const std::vector<MorphWeights>& morphs);

/// A declaration of a look-at: the last joint of a chain points its forward axis at a target, and the joints before it
/// take shares of the turn. The chain may leave out joints, which then keep the pose of the clips.
struct LookAt
{
    std::string name;                ///< unique among the constraints of a set
    std::vector<std::string> joints; ///< from the trunk to the tip, such as spine, neck, head; the last one looks
    /// One per joint, at least 0: the parts of the turn; their sum counts as 1. The last joint turns what is left, so
    /// that it always meets the target. Empty: equal parts.
    std::vector<float> shares{};
    glm::vec3 forward{0, 0, 1}; ///< in the last joint's space, of any length
    /// In the last joint's space, of any length, not parallel to forward. It keeps its side of the line to the target,
    /// or turns to the target's pole: the joint does not roll.
    glm::vec3 up{0, 1, 0};
    glm::vec3 offset{0, 0, 0}; ///< where the line to the target begins, in the last joint's space: an eye, a muzzle
    /// The largest angle between the forward axis of the clips' pose and the line to the target, seen from the offset
    /// before the turn: radians in [0, pi]. A target outside the cone is followed on its edge.
    float cone = 3.14159265f;
    float turnSpeed = 0.0f; ///< the largest angle by which the line to the target turns, radians a second; 0: no limit
};

/// A declaration of two-bone inverse kinematics: hip, knee and ankle, or shoulder, elbow and wrist. The start joint and
/// the mid joint turn so that the end joint reaches a target. It is exact if the joints of the limb have uniform
/// scales.
struct TwoBoneIk
{
    std::string name;  ///< unique among the constraints of a set
    std::string start; ///< the hip or shoulder
    std::string mid;   ///< the knee or elbow; a descendant of the start joint
    std::string end;   ///< the ankle or wrist; a descendant of the mid joint
    /// The axis about which the mid joint bends, in its own space, of any length: a positive turn bends the limb. 0:
    /// the axis of the bend at rest.
    glm::vec3 hinge{0, 0, 0};
    /// The share of the limb's length, in [0, 1], beyond which the limb stretches slower than its target moves away, so
    /// that the mid joint does not snap straight. 1: no such range.
    float softReach = 1.0f;
};

/// What changes the mixed pose: it turns the joints of a chain towards a target. A set solves its constraints in the
/// order of their declaration, each with the result of those before it (see AnimationSet::withConstraints()).
using Constraint = std::variant<LookAt, TwoBoneIk>;

/// The target of one constraint of one character, in model space. 48 bytes, as on the GPU.
struct ConstraintTarget
{
    glm::vec3 position{0, 0, 0}; ///< finite
    float weight = 0.0f;         ///< in [0, 1]: the share of the turn of each joint of the chain; 0: no effect
    /// Where the look-at's up axis, or the limb's mid joint, points to: finite, of any length. 0: as in the clips'
    /// pose.
    glm::vec3 pole{0, 0, 0};
    float twist = 0.0f;             ///< radians: a further turn about the line to the target
    glm::vec4 rotation{0, 0, 0, 0}; ///< of the limb's end joint: a unit quaternion; 0: as in the clips' pose
};

static_assert(sizeof(ConstraintTarget) == 48, "a target is 48 bytes on the GPU");

/// Joints with their inverse bind matrices (glTF 2.0, section 3.7.3).
struct Skin
{
    std::string name;                       ///< not necessarily unique
    std::vector<int> joints;                ///< joints of the skeleton
    std::vector<AffineMatrix> inverseBinds; ///< one per joint: from the mesh's space at bind time to joint space
};

/// One joint with one inverse bind matrix, or one block of morph weights. The GPU computes 48 bytes for each entry.
///
/// Entries are stored level by level. The GPU computes each entry from its parent's *entry*, so that it writes and
/// reads a single 3x4 matrix per joint:
///
///     entry = parentEntry · parentBind · T·R·S · inverseBind        parentBind = (the parent entry's inverseBind)⁻¹
///
/// Every joint has one main entry. A joint has further entries if several skins bind it differently or if it is skinned
/// and also carries a rigid mesh. Further entries are children of the main entry and have no track. Those of garments
/// come after all levels (see AnimationSet::withGarments()).
///
/// The main entry takes the inverse bind matrix of the first skin that contains the joint if that matrix can be
/// inverted without loss (see PaletteBuilder.cpp), else the identity. Equal matrices of one joint share an entry.
struct PaletteEntry
{
    /// The source of an entry's values.
    enum class Kind
    {
        Joint,   ///< T·R·S comes from the track
        Static,  ///< no track: T·R·S is the identity
        Weights, ///< the track's twelve numbers unchanged; no parent, no matrices
    };

    Kind kind = Kind::Joint;  ///< the source of the values
    int joint = -1;           ///< the joint of the entry; -1 for weights
    int parent = -1;          ///< an entry of an earlier level; -1: the instance's root matrix
    int track = -1;           ///< index in a keyframe; -1 for Static
    AffineMatrix parentBind;  ///< from the space of the parent entry's joint to the model at bind time
    AffineMatrix inverseBind; ///< from the model at bind time to joint space
};

/// All palette entries of an AnimationSet and how to find them.
struct PaletteLayout
{
    std::vector<PaletteEntry> entries;         ///< level by level, then those of garments
    std::vector<std::size_t> levels;           ///< level count + 1 entry indices: level l is [levels[l], levels[l + 1])
    std::vector<std::vector<int>> entryOfSkin; ///< by skin, then by index in Skin::joints
    std::vector<int> entryOfRigidJoint;        ///< by joint; -1 if no rigid mesh hangs on the joint
    std::vector<int> mainEntry;                ///< by joint
    std::vector<int> entryOfMorph; ///< by morph: its first weight block; -1 without weights and for properties
};

} // namespace osgGpuAnimation
