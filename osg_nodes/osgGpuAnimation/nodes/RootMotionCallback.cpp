// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/RootMotionCallback.h>

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <osg/NodeVisitor>

#include <glm/gtc/type_ptr.hpp>

namespace osgGpuAnimation
{

RootMotionCallback::RootMotionCallback(const RootMotionCallback& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), osg::Callback(other, copyop), osg::NodeCallback(other, copyop)
{
}

void RootMotionCallback::operator()(osg::Node* node, osg::NodeVisitor* visitor)
{
    if (auto* character = dynamic_cast<AnimatedCharacter*>(node))
    {
        const RootMotion motion = character->controller().takeRootMotion();
        // A matrix for column vectors by columns is in memory one for row vectors by rows.
        const glm::dmat4 columns = motion.matrix();
        if (!motion.isNone()) character->preMult(osg::Matrixd(glm::value_ptr(columns)));
    }
    traverse(node, visitor);
}

} // namespace osgGpuAnimation
