// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/file/Report.h"
#include "gltf/import/NodePlaces.h"
#include "gltf/import/NodeTree.h"

#include <osgGpuAnimation/looks/shading/PunctualLight.h>

#include <osg/LightSource>
#include <osg/Vec3d>
#include <tiny_gltf.h>

#include <vector>

namespace osgGpuAnimation::gltf
{

/// A light of the file (KHR_lights_punctual) at one of its nodes.
struct ImportedLight
{
    int light = -1; ///< the file's numbers
    int node = -1;
    osg::ref_ptr<osg::LightSource> source; ///< named after the light, else the node; null: beyond OpenGL's lights
};

/// The light's type in KHR_lights_punctual.
const char* lightTypeName(PunctualLight::Kind kind);

/// The lights at the visible nodes of the drawn part, by node, without sources.
std::vector<ImportedLight> findLights(const tinygltf::Model& model, const NodeTree& tree);

/// Makes the sources: OpenGL's lights 1 to 7 (0 is the application's), in the order of the nodes, switched on for what
/// is below root. Of more, those nearest to `middle` at rest remain, directional ones first, with a note. The sources
/// do not count for the bounds of the scene. middle: in the file's axes.
void addLights(const tinygltf::Model& model, const NodeTree& tree, const osg::Vec3d& middle, NodePlaces& places,
               osg::Group& root, std::vector<ImportedLight>& lights, Report& report);

} // namespace osgGpuAnimation::gltf
