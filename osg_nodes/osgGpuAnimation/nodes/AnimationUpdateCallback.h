// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Callback>

namespace osgGpuAnimation
{

/// Updates the AnimatedCharacter or AnimatedCrowd it is on with the frame stamp's simulation time. It has no state of
/// its own, so copies of a character may share it.
class AnimationUpdateCallback : public osg::NodeCallback
{
public:
    AnimationUpdateCallback() = default;
    AnimationUpdateCallback(const AnimationUpdateCallback& other, const osg::CopyOp& copyop);
    META_Object(osgGpuAnimation, AnimationUpdateCallback)

        void
        operator()(osg::Node* node, osg::NodeVisitor* visitor) override;

protected:
    ~AnimationUpdateCallback() override = default;
};

} // namespace osgGpuAnimation
