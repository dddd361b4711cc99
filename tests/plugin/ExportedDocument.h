// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/Export.h"
#include "plugin/GlbParts.h"

#include <gtest/gtest.h>
#include <osg/Geometry>

#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// warnings: those that are expected.
inline GlbParts exported(const osg::Node& scene, const std::vector<std::string>& warnings = {})
{
    Messages messages;
    Report report(messages);
    const Result<std::string> glb = exportModel(scene, report);
    EXPECT_TRUE(glb) << glb.error().message;
    EXPECT_EQ(messages.warnings, warnings);
    return glb ? GlbParts(glb.value()) : GlbParts();
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
