// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Array>

namespace osgGpuAnimation
{

/// One morph target of a mesh (glTF 2.0, section 3.7.2.2): the differences that its weight multiplies and adds to each
/// vertex. Each array has one element per vertex of the mesh; a null array adds nothing.
struct MorphTarget
{
    osg::ref_ptr<osg::Vec3Array> positions;          ///< in the mesh's units
    osg::ref_ptr<osg::Vec3Array> normals;            ///< not normalized
    osg::ref_ptr<osg::Vec4Array> colors;             ///< red, green, blue, alpha
    osg::ref_ptr<osg::Vec2Array> textureCoordinates; ///< of unit 0
    osg::ref_ptr<osg::Vec3Array> tangents{};         ///< without w, which targets do not change
};

} // namespace osgGpuAnimation
