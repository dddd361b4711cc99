// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Clip.h>
#include <osgGpuAnimation/authoring/retarget/RigMatch.h>

#include <memory>
#include <vector>

namespace osgGpuAnimation
{

/// One per joint of the skeleton: true if any of the clips moves it away from its rest pose, apart from rounding.
std::vector<bool> movedJoints(const Skeleton& skeleton, const std::vector<Clip>& clips);

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
/// their parent. Where joints of `from` without a counterpart move between two that have one, D is computed from all
/// joints of each keyframe; between keyframes such rotations are slerped.
///
/// Legs of other proportions would take the feet off the ground. Where a body is not copied, its hips are therefore
/// shifted along +Y at each keyframe, so that the body is as high above the ground as in the clip, times the ratio of
/// the hip heights. A body touches the ground with a joint that is as low as the lowest one at rest; or, with ankles,
/// toes and paws, as low as that joint itself at rest.
class ClipRetargeter
{
public:
    /// The rigs must outlive the retargeter. Errors: those of RigMatch::create().
    static Result<ClipRetargeter> create(const Rig& from, const Rig& to, const RetargetOptions& options);

    /// Errors: a number of the result is not finite; the clip's root motion was removed and its joint's rest pose
    /// differs.
    Result<Clip> retarget(const Clip& clip) const;

    const RigMatch& match() const { return _match; }

private:
    /// How a joint of `to` follows its counterpart.
    struct Factors
    {
        bool copiesRotation = false, copiesTranslation = false, copiesScale = false;
        bool movesBody = false;                           ///< follows the translation without copying it
        glm::dquat before{1, 0, 0, 0}, after{1, 0, 0, 0}; ///< of the rotation
        glm::dmat3 translation{1.0}; ///< from the space of the source's parent to that of the joint's parent
        glm::dmat3 scale{1.0};
    };

    class Writer;
    struct Soles;

    ClipRetargeter(const Rig& from, const Rig& to, RigMatch match);
    Factors factorsOf(const JointMatch& match) const;
    void keepOnGround(const Clip& clip, std::vector<JointTransform>& data) const;
    void copyWeights(const Clip& clip, std::vector<JointTransform>& data) const;
    Result<std::shared_ptr<const RootMotionCurve>> rootMotionOf(const Clip& clip) const;

    Rig _from, _to;
    RigMatch _match;
    std::size_t _trackCount;       ///< of `to`
    std::vector<Factors> _factors; ///< one per match
};

} // namespace osgGpuAnimation
