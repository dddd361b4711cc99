// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Geometry>

namespace osgGpuAnimation
{

class SkinnedGeometry;

/// A node above SkinnedGeometry that has a present pose. Intersectors and writers of other file formats meet its posed
/// meshes in place of the meshes below it.
class PosedMeshSource
{
public:
    /// The mesh in the present pose, in the node's own space. withNormals: with normals and colours, if the mesh has
    /// them.
    virtual osg::ref_ptr<osg::Geometry> getPosedMesh(const SkinnedGeometry& mesh, bool withNormals) const = 0;

protected:
    ~PosedMeshSource() = default;
};

} // namespace osgGpuAnimation
