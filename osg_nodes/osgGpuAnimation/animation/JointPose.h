// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <glm/gtc/quaternion.hpp>

#include <atomic>
#include <memory>
#include <vector>

namespace osgGpuAnimation
{

class PosedKeyframe;
struct PoseExtent;

/// A pose that the application writes: the local translation, rotation and scale of any joints, and any morph weights.
/// What is not set shows the layers below. An AnimationLayer shows it in place of a clip.
///
///     JointPose& pose = fox->getController().layer(1).pose();
///     pose.setRotation(head, glm::angleAxis(0.3f, glm::vec3(0, 1, 0)));
///
/// Values are relative to the parent joint, in the file's axes. Joints are numbered as in Skeleton. A value that is not
/// finite or beyond ±maxNumber is refused, and the pose stays as it is. Changes take effect at once. A copy is an
/// independent pose.
///
/// Not thread-safe: it belongs to the update thread. Frames that are drawn keep the pose of their time.
class JointPose
{
public:
    static constexpr float maxNumber = 1e18f; ///< the largest absolute value of a number

    /// Starts with nothing set. set: null counts as an empty one.
    explicit JointPose(std::shared_ptr<const AnimationSet> set);
    JointPose(const JointPose& other);            ///< Copies all values.
    JointPose& operator=(const JointPose& other); ///< Copies all values.

    const AnimationSet& set() const { return *_set; } ///< the set whose joints are posed

    // Of one joint. False, without a change: there is no such joint, or a value is refused.
    bool setTranslation(std::size_t joint, const glm::vec3& translation); ///< in the units of the parent
    /// rotation: of any length above 0.
    bool setRotation(std::size_t joint, const glm::quat& rotation);
    bool setScale(std::size_t joint, const glm::vec3& scale); ///< per axis
    /// All three parts. rotation: of any length above 0.
    bool setTransform(std::size_t joint, const JointTransform& transform);
    /// One weight of a morph; the others keep what they show. target: below the number of the morph's weights. weight:
    /// not limited to [0, 1]. False, without a change: no such morph or target, or the weight is refused.
    bool setMorphWeight(std::size_t morph, std::size_t target, float weight);

    /// Sets all joints, as motion capture does in every frame. transforms: one per joint.
    /// Errors, without a change: a wrong number of transforms; a value is refused; the message names the joint.
    Result<void> setTransforms(const std::vector<JointTransform>& transforms);
    /// The same for matrices to the model's space, as a physics engine has them. jointToModel: one per joint, in the
    /// file's axes. A joint shows its translation, rotation and scale; a shear between it and its parent is dropped.
    /// The joints below a sheared joint keep their places in the model. Further error: a matrix has no inverse.
    Result<void> setModelTransforms(const std::vector<AffineMatrix>& jointToModel);

    void reset();                       ///< Nothing is set any more.
    bool reset(std::size_t joint);      ///< The joint shows the layers below. False: no such joint.
    bool resetMorph(std::size_t morph); ///< The morph's weights show the layers below. False: no such morph.

    bool isEmpty() const; ///< true if nothing is set
    /// The values of the joint; parts that are not set have those of the rest pose. joint: below the set's
    /// jointCount().
    JointTransform transform(std::size_t joint) const;

    /// The values of one track, see AnimationSet: for storing a pose.
    struct Track
    {
        std::uint32_t track = 0;   ///< index: joints, then weight blocks
        std::uint32_t numbers = 0; ///< one bit per number that is set, in the order of JointTransform::number()
        JointTransform values;     ///< 0 where nothing is set
    };
    std::vector<Track> tracks() const; ///< all tracks with values
    /// Replaces the pose by stored values. Errors, without a change: no such track; a joint of which a part is set only
    /// partly; a value is refused.
    Result<void> setTracks(const std::vector<Track>& tracks);

    /// The content, for the mix stage.
    const PosedKeyframe& keyframe() const { return *_keyframe; }
    /// The same, shared: it never changes, as the next change of the pose begins a new one. Safe to call from several
    /// threads while the pose does not change.
    std::shared_ptr<const PosedKeyframe> sharedKeyframe() const;
    /// The space that the pose may take, for bounds: another object whenever bounds change.
    const std::shared_ptr<const PoseExtent>& extent() const { return _extent; }

private:
    bool hasJoint(std::size_t joint) const { return joint < _set->skeleton().jointCount(); }
    PosedKeyframe& change();
    void setPart(std::size_t joint, std::size_t part, const glm::vec4& value);
    void growExtent(std::size_t firstJoint, std::size_t endJoint);
    void growExtent(float weight);
    void renewExtent();

    std::shared_ptr<const AnimationSet> _set; ///< never null
    std::shared_ptr<PosedKeyframe> _keyframe; ///< never null
    mutable std::atomic<bool> _isShared{false};
    std::shared_ptr<const PoseExtent> _extent; ///< never null
};

} // namespace osgGpuAnimation
