// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

#include <osg/NodeVisitor>

namespace osgGpuAnimation
{

/// Calls a function for every SkinnedGeometry below a node.
///
///     SkinnedGeometryVisitor visitor([&](SkinnedGeometry& mesh) { … });
///     node->accept(visitor);
template <typename Function>
class SkinnedGeometryVisitor : public osg::NodeVisitor
{
public:
    explicit SkinnedGeometryVisitor(Function function)
        : osg::NodeVisitor(osg::NodeVisitor::TRAVERSE_ALL_CHILDREN), _function(function)
    {
    }
    void apply(osg::Drawable& drawable) override
    {
        if (auto* skinned = dynamic_cast<SkinnedGeometry*>(&drawable)) _function(*skinned);
    }

private:
    Function _function;
};

} // namespace osgGpuAnimation
