// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/frame/crowd/InstanceVisits.h>

#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/mesh/geometry/PosedMesh.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <osgUtil/IntersectionVisitor>

#include <vector>

namespace osgGpuAnimation
{

namespace
{

/// An instance for intersectors, posed only if its sphere is hit. It is no part of the hits' node paths.
class IntersectedInstance : public osg::Node
{
public:
    IntersectedInstance(const CrowdInstances& instances, const std::vector<osg::Node*>& children)
        : _instances(instances), _children(children)
    {
    }

    void setIndex(std::size_t index)
    {
        _index = index;
        dirtyBound();
    }

    void traverse(osg::NodeVisitor& visitor) override
    {
        const VisitedInstance visited(_index);
        auto& intersection = static_cast<osgUtil::IntersectionVisitor&>(visitor);
        intersection.pushModelMatrix(new InstanceMatrix(*intersection.getModelMatrix(), _instances.handleOf(_index)));
        for (osg::Node* child : _children)
            child->accept(visitor);
        intersection.popModelMatrix();
    }

    osg::BoundingSphere computeBound() const override
    {
        const glm::vec4& sphere = _instances.sphere(_index);
        return {osg::Vec3(sphere.x, sphere.y, sphere.z), sphere.w};
    }

private:
    const CrowdInstances& _instances;
    const std::vector<osg::Node*>& _children;
    std::size_t _index = 0;
};

osg::Node* childAt(const osg::Group& group, unsigned int child)
{
    return const_cast<osg::Node*>(group.getChild(child));
}

} // namespace

void visitInstances(const osg::Group& crowd, const CrowdInstances& instances, osg::NodeVisitor& visitor)
{
    std::vector<osg::Node*> ofInstances;
    for (unsigned int i = 0; i < crowd.getNumChildren(); ++i)
    {
        bool hasMesh = false;
        forEachMeshBelow(*childAt(crowd, i), [&](const SkinnedGeometry&) { hasMesh = true; });
        hasMesh ? ofInstances.push_back(childAt(crowd, i)) : childAt(crowd, i)->accept(visitor);
    }
    const osg::ref_ptr<IntersectedInstance> intersected = new IntersectedInstance(instances, ofInstances);
    for (std::size_t index = 0; index < instances.size(); ++index)
    {
        const VisitedInstance visited(index);
        intersected->setIndex(index);
        if (dynamic_cast<osgUtil::IntersectionVisitor*>(&visitor))
            visitor.apply(*intersected);
        else
            for (osg::Node* child : ofInstances)
                child->accept(visitor);
    }
}

void visitMeshesPerInstance(const osg::Group& crowd, std::size_t instances, osg::NodeVisitor& visitor)
{
    for (unsigned int i = 0; i < crowd.getNumChildren(); ++i)
    {
        osg::Node& child = *childAt(crowd, i);
        for (std::size_t times = dynamic_cast<SkinnedGeometry*>(&child) ? instances : 1; times > 0; --times)
            child.accept(visitor);
    }
}

} // namespace osgGpuAnimation
