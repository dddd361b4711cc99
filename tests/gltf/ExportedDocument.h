// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/GlbParts.h"
#include "serializers/RoundTrip.h"

#include <osg/Geometry>

#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// warnings: those that are expected.
inline GlbParts exported(const osg::Node& scene, const std::vector<std::string>& warnings = {})
{
    const std::string glb = glbOf(scene, warnings);
    return glb.empty() ? GlbParts() : GlbParts(glb);
}

/// A triangle in the x-z plane.
inline osg::ref_ptr<osg::Geometry> plainTriangle(const std::string& name)
{
    osg::ref_ptr<osg::Geometry> made = new osg::Geometry;
    made->setName(name);
    const osg::Vec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}};
    made->setVertexArray(new osg::Vec3Array(3, corners));
    made->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 3));
    return made;
}

} // namespace osgGpuAnimation::gltf
