// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Camera>
#include <osg/Node>
#include <osg/NodeVisitor>
#include <osg/observer_ptr>
#include <osg/State>
#include <osgUtil/CullVisitor>

#include <functional>
#include <optional>
#include <string>

namespace osgGpuAnimation
{

/// RAII: near and far planes come from bounding boxes, not from primitives. The primitives of a SkinnedGeometry are in
/// bind pose, so a limb that reaches farther would be clipped; the boxes contain every pose.
class BoxNearFar
{
public:
    explicit BoxNearFar(osgUtil::CullVisitor& visitor);
    ~BoxNearFar();
    BoxNearFar(const BoxNearFar&) = delete;

private:
    osgUtil::CullVisitor& _visitor;
    osg::CullSettings::ComputeNearFarMode _mode;     ///< before
    osg::CullSettings::InheritanceMask _inheritance; ///< before: setComputeNearFarMode() changes it
};

/// RAII: sets the shader define POSE_DEPTH_ONLY for everything culled by a camera with a depth buffer but no colour
/// buffer, such as osgShadow's. Programs may then skip colours; the kit's own does. LodView takes an absolute camera of
/// this kind for a shadow map, although it may draw a height map or depths for picking.
class DepthPass
{
public:
    explicit DepthPass(osgUtil::CullVisitor& visitor);
    ~DepthPass();
    DepthPass(const DepthPass&) = delete;
    DepthPass& operator=(const DepthPass&) = delete;

    /// True if the camera has a depth buffer but no colour buffer.
    static bool isOf(const osg::Camera& camera);

private:
    osgUtil::CullVisitor* _visitor; ///< null: not a depth pass
};

/// RAII: the visitor culls nothing, such as the children of a crowd that are no meshes: the bounds of groups that an
/// application has inserted above a mesh do not contain the instances.
class UnculledScope
{
public:
    explicit UnculledScope(osgUtil::CullVisitor& visitor)
        : _visitor(visitor), _mask(visitor.getCurrentCullingSet().getCullingMask())
    {
        _visitor.getCurrentCullingSet().setCullingMask(osg::CullingSet::NO_CULLING);
    }
    ~UnculledScope() { _visitor.getCurrentCullingSet().setCullingMask(_mask); }
    UnculledScope(const UnculledScope&) = delete;

private:
    osgUtil::CullVisitor& _visitor;
    osg::CullingSet::Mask _mask; ///< before
};

/// True if the shader define is on in the present state.
bool isDefined(osg::State& state, const std::string& name);

/// The simulation time, if an update traversal visits.
inline std::optional<double> updateTimeOf(const osg::NodeVisitor& visitor)
{
    const bool isUpdate = visitor.getVisitorType() == osg::NodeVisitor::UPDATE_VISITOR && visitor.getFrameStamp();
    return isUpdate ? std::optional(visitor.getFrameStamp()->getSimulationTime()) : std::nullopt;
}

/// For the traverse() of nodes whose vertices must not be transformed. The Optimizer's visitor that flattens static
/// transforms and duplicates shared subgraphs replaces the transforms above by groups and applies their matrices to the
/// vertices below. This function instead inserts a transform above the node. True: the visitor must not continue below
/// the node; nor must the Optimizer's texture atlas, which changes textures below but not the coordinates of skins.
bool keepFlattenedPlace(osg::Node& node, osg::NodeVisitor& visitor);

/// Runs the action after the update traversal, when no group iterates over its children: below a view of osgViewer, a
/// temporary callback of the view's camera runs all actions of the frame in order. Without a viewer it runs at once.
void runAfterUpdate(osg::Node& node, std::function<void()> action);
/// action(node), unless the node no longer exists then.
template <typename Node, typename Action>
void runAfterUpdateOf(Node& node, Action action)
{
    runAfterUpdate(node,
                   [action, observed = osg::observer_ptr<Node>(&node)]
                   {
                       osg::ref_ptr<Node> present;
                       if (observed.lock(present)) action(*present);
                   });
}

} // namespace osgGpuAnimation
