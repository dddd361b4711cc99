// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/file/Report.h"

#include <osgGpuAnimation/math/Result.h>

#include <osg/Node>

#include <string>

namespace osgGpuAnimation::gltf
{

/// A scene graph (+Z up) as GLB (+Y up): the inverse of importModel(). An AnimatedCharacter becomes nodes, skins,
/// meshes with morph targets, material variants, and its set's clips with markers; an AnimatedCrowd is written as its
/// first instance. Other geometry, PunctualLights, CameraViews and what is attached to joints become nodes with their
/// transforms. Clips are written as they are in the set: compact ones as the values that they show. Hidden meshes are
/// written as hidden (KHR_node_visibility). Of levels of detail only the finest is written.
///
/// What is left out has a warning each: constraints, root motion that was taken out of clips, the curves of animated
/// properties, hidden and other lights, compressed pictures, vertex arrays of other kinds than floats, cameras and what
/// else has a reference frame of its own.
/// Errors: there is nothing to write; the file would be larger than a GLB can be (4 GiB).
Result<std::string> exportModel(const osg::Node& scene, Report& report);

} // namespace osgGpuAnimation::gltf
