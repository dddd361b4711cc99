// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/import/NodeTree.h"

#include <osg/CameraView>
#include <tiny_gltf.h>

#include <vector>

namespace osgGpuAnimation::gltf
{

/// A camera of the file at one of its nodes.
struct ImportedCamera
{
    int camera = -1; ///< the file's numbers
    int node = -1;
    /// Looks along its -Z with +Y up, as glTF's and OSG's cameras do. Perspective: with the vertical field of view.
    /// Parallel: with the user value orthographicHeightName, and UNCONSTRAINED. Its name is the camera's, else the
    /// node's, else "camera N"; of equal names, later ones get a number.
    osg::ref_ptr<osg::CameraView> view;
};

/// The cameras at the nodes of the drawn part, by node.
std::vector<ImportedCamera> makeCameras(const tinygltf::Model& model, const NodeTree& tree);

} // namespace osgGpuAnimation::gltf
