// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Array>

namespace osgGpuAnimation
{

/// One morph target of a mesh (glTF 2.0, section 3.7.2.2): what is added to each vertex, times the target's weight.
/// Arrays hold one element a vertex of the mesh; those that are null add nothing.
struct MorphTarget
{
    osg::ref_ptr<osg::Vec3Array> positions;
    osg::ref_ptr<osg::Vec3Array> normals;
    osg::ref_ptr<osg::Vec4Array> colors;
    osg::ref_ptr<osg::Vec2Array> textureCoordinates;
};

} // namespace osgGpuAnimation
