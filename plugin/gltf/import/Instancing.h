// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/document/MemoryBudget.h"
#include "gltf/file/Report.h"

#include <osg/Matrixd>
#include <tiny_gltf.h>

#include <vector>

namespace osgGpuAnimation::gltf
{

/// True if the node repeats its mesh (EXT_mesh_gpu_instancing).
bool isInstanced(const tinygltf::Node& node);

/// From each instance to the node. A fault of the extension leaves one instance, at the node itself, with a warning.
std::vector<osg::Matrixd> readInstances(const tinygltf::Model& model, std::size_t node, MemoryBudget& budget,
                                        Report& report);

} // namespace osgGpuAnimation::gltf
