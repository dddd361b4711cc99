// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/RootMotionCallback.h>

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

namespace osgGpuAnimation
{

void RootMotionCallback::operator()(osg::Node* node, osg::NodeVisitor* visitor)
{
    if (auto* character = dynamic_cast<AnimatedCharacter*>(node))
    {
        const osg::Matrixd motion = character->takeRootMotion();
        if (!motion.isIdentity()) character->preMult(motion);
    }
    traverse(node, visitor);
}

} // namespace osgGpuAnimation
