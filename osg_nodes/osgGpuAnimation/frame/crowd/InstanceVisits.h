// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>

#include <osg/Group>
#include <osg/NodeVisitor>

#include <cstddef>
#include <vector>

namespace osgGpuAnimation
{

/// RAII: the instance of a crowd whose meshes this thread visits.
class VisitedInstance
{
public:
    explicit VisitedInstance(std::size_t index) : _outer(_current) { _current = index; }
    ~VisitedInstance() { _current = _outer; }
    VisitedInstance(const VisitedInstance&) = delete;
    VisitedInstance& operator=(const VisitedInstance&) = delete;

    static std::size_t current() { return _current; } ///< its index; CrowdInstances::none: no visit

private:
    static inline thread_local std::size_t _current = CrowdInstances::none;
    std::size_t _outer;
};

/// By the number of an outfit: the meshes that its instances show in place of the crowd's own. Empty: no outfits.
using NodesOfOutfits = std::vector<std::vector<osg::Node*>>;

/// The visitor visits the children with meshes once per instance, and the others once. Intersectors meet an instance
/// only if they hit its sphere; hits have an InstanceMatrix.
void visitInstances(const osg::Group& crowd, const CrowdInstances& instances, const NodesOfOutfits& ofOutfits,
                    osg::NodeVisitor& visitor);

/// The visitor visits each mesh as often as instances show it, for statistics, and the other children once.
void visitMeshesPerInstance(const osg::Group& crowd, const CrowdInstances& instances, const NodesOfOutfits& ofOutfits,
                            osg::NodeVisitor& visitor);

} // namespace osgGpuAnimation
