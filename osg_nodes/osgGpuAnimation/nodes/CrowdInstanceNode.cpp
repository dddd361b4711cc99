// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/CrowdInstanceNode.h>

#include <osgGpuAnimation/nodes/MeshesOfGroup.h>

namespace osgGpuAnimation
{

void CrowdInstanceNode::traverse(osg::NodeVisitor& visitor)
{
    const AnimatedCrowd::Instance instance = _crowd.instances().handleOf(_index);
    forEachMesh(_crowd,
                [&](const SkinnedGeometry& mesh)
                {
                    if (!visitor.validNodeMask(mesh)) return;
                    const osg::ref_ptr<osg::Geometry> posed = _crowd.posedMesh(instance, mesh);
                    // The hit's node path leads through this node, and only the drawable is kept.
                    posed->setUserData(this);
                    posed->accept(visitor);
                });
}

osg::BoundingSphere CrowdInstanceNode::computeBound() const
{
    const glm::vec4& sphere = _crowd.instances().sphere(_index);
    return {osg::Vec3(sphere.x, sphere.y, sphere.z), sphere.w};
}

} // namespace osgGpuAnimation
