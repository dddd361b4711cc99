// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/Node>

namespace osgGpuAnimation
{

/// What an intersector meets of an instance of a crowd: computed only where its sphere is hit. Lives as long as the
/// crowd's traversal.
class CrowdInstanceNode : public osg::Node
{
public:
    CrowdInstanceNode(const AnimatedCrowd& crowd, std::size_t index) : _crowd(crowd), _index(index) {}

    void traverse(osg::NodeVisitor& visitor) override;
    osg::BoundingSphere computeBound() const override;

private:
    const AnimatedCrowd& _crowd;
    std::size_t _index;
};

} // namespace osgGpuAnimation
