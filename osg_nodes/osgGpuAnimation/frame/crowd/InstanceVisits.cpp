// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/frame/crowd/InstanceVisits.h>

#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/mesh/geometry/PosedMesh.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <osgUtil/IntersectionVisitor>

namespace osgGpuAnimation
{

namespace
{

/// An instance for intersectors, posed only if its sphere is hit. It is no part of the hits' node paths.
class IntersectedInstance : public osg::Node
{
public:
    explicit IntersectedInstance(const CrowdInstances& instances) : _instances(instances) {}

    void set(std::size_t index, const std::vector<osg::Node*>& children)
    {
        _index = index;
        _children = &children;
        dirtyBound();
    }

    void traverse(osg::NodeVisitor& visitor) override
    {
        const VisitedInstance visited(_index);
        auto& intersection = static_cast<osgUtil::IntersectionVisitor&>(visitor);
        intersection.pushModelMatrix(new InstanceMatrix(*intersection.getModelMatrix(), _instances.handleOf(_index)));
        for (osg::Node* child : *_children)
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
    const std::vector<osg::Node*>* _children = nullptr;
    std::size_t _index = 0;
};

osg::Node* childAt(const osg::Group& group, unsigned int child)
{
    return const_cast<osg::Node*>(group.getChild(child));
}

} // namespace

void visitInstances(const osg::Group& crowd, const CrowdInstances& instances, const NodesOfOutfits& ofOutfits,
                    osg::NodeVisitor& visitor)
{
    std::vector<osg::Node*> ofInstances;
    for (unsigned int i = 0; i < crowd.getNumChildren(); ++i)
    {
        osg::Node* const child = childAt(crowd, i);
        bool hasMesh = false;
        forEachMeshBelow(*child, [&](const SkinnedGeometry&) { hasMesh = true; });
        if (!hasMesh)
            child->accept(visitor);
        else if (ofOutfits.empty() || !dynamic_cast<SkinnedGeometry*>(child))
            ofInstances.push_back(child);
    }
    NodesOfOutfits shown = ofOutfits.empty() ? NodesOfOutfits(1) : ofOutfits;
    for (std::vector<osg::Node*>& nodes : shown)
        nodes.insert(nodes.end(), ofInstances.begin(), ofInstances.end());
    const osg::ref_ptr<IntersectedInstance> intersected = new IntersectedInstance(instances);
    for (std::size_t index = 0; index < instances.size(); ++index)
    {
        const VisitedInstance visited(index);
        const std::vector<osg::Node*>& nodes = shown[ofOutfits.empty() ? 0 : instances.outfit(index)];
        intersected->set(index, nodes);
        if (dynamic_cast<osgUtil::IntersectionVisitor*>(&visitor))
            visitor.apply(*intersected);
        else
            for (osg::Node* node : nodes)
                node->accept(visitor);
    }
}

void visitMeshesPerInstance(const osg::Group& crowd, const CrowdInstances& instances, const NodesOfOutfits& ofOutfits,
                            osg::NodeVisitor& visitor)
{
    for (unsigned int i = 0; i < crowd.getNumChildren(); ++i)
    {
        osg::Node& child = *childAt(crowd, i);
        const bool isMesh = dynamic_cast<SkinnedGeometry*>(&child) != nullptr;
        if (isMesh && !ofOutfits.empty()) continue;
        for (std::size_t times = isMesh ? instances.size() : 1; times > 0; --times)
            child.accept(visitor);
    }
    for (std::size_t index = 0; index < instances.size() && !ofOutfits.empty(); ++index)
        for (osg::Node* node : ofOutfits[instances.outfit(index)])
            node->accept(visitor);
}

} // namespace osgGpuAnimation
