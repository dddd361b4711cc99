// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Array>

namespace osgGpuAnimation::gltf
{

/// What one morph target adds to a primitive's vertices at weight 1; null where it adds nothing.
struct MorphTarget
{
    osg::ref_ptr<osg::Vec3Array> positions;
    osg::ref_ptr<osg::Vec3Array> normals;
};

} // namespace osgGpuAnimation::gltf
