// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/AnimationUpdateCallback.h>

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
        if (auto* updatable = dynamic_cast<Updatable*>(node)) updatable->update(stamp->getSimulationTime());
    traverse(node, visitor);
}

} // namespace osgGpuAnimation
