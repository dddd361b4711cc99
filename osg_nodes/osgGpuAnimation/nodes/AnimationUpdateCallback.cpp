// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/AnimationUpdateCallback.h>

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/NodeVisitor>

namespace osgGpuAnimation
{

AnimationUpdateCallback::AnimationUpdateCallback(const AnimationUpdateCallback& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), osg::Callback(other, copyop), osg::NodeCallback(other, copyop)
{
}

void AnimationUpdateCallback::operator()(osg::Node* node, osg::NodeVisitor* visitor)
{
    if (const osg::FrameStamp* stamp = visitor->getFrameStamp())
    {
        if (auto* character = dynamic_cast<AnimatedCharacter*>(node)) character->update(stamp->getSimulationTime());
        if (auto* crowd = dynamic_cast<AnimatedCrowd*>(node)) crowd->update(stamp->getSimulationTime());
    }
    traverse(node, visitor);
}

} // namespace osgGpuAnimation
