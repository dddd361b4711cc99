// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Callback>

namespace osgGpuAnimation
{

/// Moves the AnimatedCharacter it is on by the root motion of its clips: each frame, after the character has advanced,
/// the motion is put before its matrix.
///
///     fox->addUpdateCallback(new RootMotionCallback);
///
/// It has no state of its own, so copies of a character may share it.
class RootMotionCallback : public osg::NodeCallback
{
public:
    RootMotionCallback() = default;
    RootMotionCallback(const RootMotionCallback& other, const osg::CopyOp& copyop);
    META_Object(osgGpuAnimation, RootMotionCallback)

    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override;

protected:
    ~RootMotionCallback() override = default;
};

} // namespace osgGpuAnimation
