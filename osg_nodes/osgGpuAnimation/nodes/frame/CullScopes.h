// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Camera>
#include <osg/Node>
#include <osg/NodeVisitor>
#include <osg/State>
#include <osg/StateSet>
#include <osgUtil/CullVisitor>

namespace osgGpuAnimation
{

/// While it lives, near and far planes come from bounding boxes where the visitor would look at primitives: those of a
/// SkinnedGeometry are its bind pose's, and a limb that reaches beyond it would be clipped. Boxes hold every pose.
class BoxNearFar
{
public:
    explicit BoxNearFar(osgUtil::CullVisitor& visitor);
    ~BoxNearFar();
    BoxNearFar(const BoxNearFar&) = delete;
    BoxNearFar& operator=(const BoxNearFar&) = delete;

private:
    osgUtil::CullVisitor& _visitor;
    osg::CullSettings::ComputeNearFarMode _mode;     ///< as it was
    osg::CullSettings::InheritanceMask _inheritance; ///< as it was: setting the mode changes it
};

/// While it lives: where the camera that is culled for has a depth buffer and no colour buffer attached, as osgShadow's
/// have, the state of all that is culled has the shader define POSE_DEPTH_ONLY. Programs may leave out what makes
/// colours then; the kit's own does. Levels of detail take such a camera, where it is absolute, for that of a shadow
/// map, though it may draw a height map or depths to pick by: see LodView.
class DepthPass
{
public:
    explicit DepthPass(osgUtil::CullVisitor& visitor);
    ~DepthPass();
    DepthPass(const DepthPass&) = delete;
    DepthPass& operator=(const DepthPass&) = delete;

    /// Whether it is such a camera.
    static bool isOf(const osg::Camera& camera);

private:
    osgUtil::CullVisitor* _visitor; ///< null: it is no such camera
};

/// Whether the define is on in the state as it is.
bool isDepthPass(osg::State& state);

/// For nodes whose vertices nobody may transform, from their traverse(): where the visitor is the Optimizer's that
/// flattens static transforms and duplicates what is shared, the transforms above are groups by now and what they did
/// is to be done to the vertices below. Instead the node gets a transform of its own in its parent. True: the visitor
/// is not to go on below the node.
bool keepFlattenedPlace(osg::Node& node, osg::NodeVisitor& visitor);

} // namespace osgGpuAnimation
