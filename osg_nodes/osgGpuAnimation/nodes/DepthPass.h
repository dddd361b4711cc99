// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Camera>
#include <osg/State>
#include <osg/StateSet>
#include <osgUtil/CullVisitor>

namespace osgGpuAnimation
{

/// While it lives: where the camera that is culled for has a depth buffer and no colour buffer attached, as osgShadow's
/// have, the state of all that is culled has the shader define POSE_DEPTH_ONLY. Programs may leave out what makes
/// colours then; the kit's own does. Levels of detail take such a camera, where it is absolute, for that of a shadow
/// map, though it may draw a height map or depths to pick by: see DetailView.
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

} // namespace osgGpuAnimation
