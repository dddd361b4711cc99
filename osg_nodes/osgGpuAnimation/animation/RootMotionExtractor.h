// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/RootMotionCurve.h>
#include <osgGpuAnimation/animation/RootMotionExtraction.h>

#include <osgGpuAnimation/animation/Rotation.h>

namespace osgGpuAnimation
{

/// Removes the motion of one joint from clips, see withRootMotion().
class RootMotionExtractor
{
public:
    RootMotionExtractor(const Skeleton& skeleton, std::size_t joint, const RootMotionAxes& axes);

    Result<Clip> extract(const Clip& clip);

private:
    bool isStill(const Clip& clip, std::size_t joint) const;
    Result<bool> findParent(const Clip& clip);
    double yawOf(const glm::dquat& rotation) const;
    void takeOutTranslation(Clip& clip, RootMotionCurve& curve) const;
    void takeOutYaw(Clip& clip, RootMotionCurve& curve) const;

    const Skeleton& _skeleton;
    std::size_t _joint;
    RootMotionAxes _axes; ///< up is unit
    // From the space of the joint's parent to model space.
    glm::dmat4 _parentToModel{1.0};
    glm::dquat _parentRotation = glm::identity<glm::dquat>();
};

} // namespace osgGpuAnimation
