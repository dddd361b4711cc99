// SPDX-License-Identifier: MIT
#pragma once

#include <osg/BoundingBox>
#include <osg/Camera>
#include <osg/Texture2D>

namespace osgGpuAnimation
{

/// The shadow map of the studio's key light: an orthographic camera that draws depths into a texture, before the camera
/// that it is culled for. Characters draw lean there, see DepthPass. Its space is that of the group whose children
/// cast.
class KeyShadow : public osg::Camera
{
public:
    static constexpr int mapSide = 1024; ///< texels

    /// casters: the group; it must exist whenever this camera is culled.
    explicit KeyShadow(osg::Group& casters);

    /// Lets the map cover the box. box: valid, in the group's space. towardsLight: in that space, of length 1.
    void fit(const osg::BoundingBoxd& box, const osg::Vec3d& towardsLight);

    /// From the group's space to the map, [0, 1] each way and in depth.
    osg::Matrixd toMap() const;
    /// The extent of the map, in units of the group's space: width, height, depth.
    const osg::Vec3d& getSize() const { return _size; }
    osg::Texture2D& getMap() const { return *_map; } ///< depths, without comparison

protected:
    ~KeyShadow() override = default;

private:
    osg::ref_ptr<osg::Texture2D> _map;
    osg::Vec3d _size;
};

} // namespace osgGpuAnimation
