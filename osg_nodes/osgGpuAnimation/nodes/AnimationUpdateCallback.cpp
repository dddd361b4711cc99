// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/AnimationUpdateCallback.h>

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <osg/NodeVisitor>

namespace osgGpuAnimation
{

AnimationUpdateCallback::AnimationUpdateCallback(const AnimationUpdateCallback& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), osg::Callback(other, copyop), osg::NodeCallback(other, copyop)
{
}

void AnimationUpdateCallback::operator()(osg::Node* node, osg::NodeVisitor* visitor)
{
    auto* character = dynamic_cast<AnimatedCharacter*>(node);
    if (character && visitor->getFrameStamp()) character->update(visitor->getFrameStamp()->getSimulationTime());
    traverse(node, visitor);
}

} // namespace osgGpuAnimation
