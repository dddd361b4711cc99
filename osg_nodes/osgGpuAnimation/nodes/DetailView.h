// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Camera>
#include <osg/Matrix>
#include <osg/Vec4>
#include <osgUtil/CullVisitor>

namespace osgGpuAnimation
{

/// How large things are in the picture that levels of detail go by: what is being culled for; or, while that is an
/// absolute camera for depths alone (see DepthPass), the picture of the camera above it, for which it is taken to be a
/// shadow map. Which that is, and where from, is the same for all that a camera sees: it is kept until another one's
/// turn. Of one cull visitor.
class DetailView
{
public:
    /// At the beginning of a cull traversal: cameras may have moved.
    void clear() { _projection = nullptr; }

    /// As osg::CullingSet::getPixelSizeVector(), for where the visitor is now. OSG divides a radius by the vector's
    /// product with the place and has a diameter in pixels.
    osg::Vec4 pixelSizeVector(osgUtil::CullVisitor& visitor);

private:
    void find(osgUtil::CullVisitor& visitor);

    osg::ref_ptr<const osg::RefMatrix> _projection; ///< what it was found for: each camera culled for has one anew
    const osg::Camera* _culled = nullptr;           ///< likewise
    const osg::Camera* _eye = nullptr;              ///< null: the picture is that of what is culled for
    const osg::Viewport* _viewport = nullptr;       ///< the eye's
    osg::Matrix _toEye;                             ///< from the space of the camera that is culled for
};

} // namespace osgGpuAnimation
