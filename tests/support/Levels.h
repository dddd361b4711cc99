// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/NodeVisitor>

namespace osgGpuAnimation
{

/// Waits for the levels of detail of all characters and crowds at or below the node.
inline void waitForLevels(osg::Node& scene)
{
    struct Visitor : osg::NodeVisitor
    {
        Visitor() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
        void apply(osg::Group& group) override
        {
            if (auto* character = dynamic_cast<AnimatedCharacter*>(&group)) character->getMeshes().waitForLevels();
            if (auto* crowd = dynamic_cast<AnimatedCrowd*>(&group)) crowd->getMeshes().waitForLevels();
            traverse(group);
        }
    };
    Visitor visitor;
    scene.accept(visitor);
}

} // namespace osgGpuAnimation
