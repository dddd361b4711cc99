// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <osg/Node>

#include <cstddef>
#include <vector>

namespace osgGpuAnimation
{

/// Plain geometries as meshes that follow one palette entry.
struct RigidMeshes
{
    static constexpr std::size_t maxVertices = 1u << 24; ///< of all

    std::vector<osg::ref_ptr<SkinnedGeometry>> meshes;
    /// Geometries without osg::Vec3Array vertices, those that their transforms flatten, and those beyond maxVertices.
    std::size_t leftOut = 0;

    /// The geometries at and below a node, with the state of the nodes above them; the most detailed level of each
    /// osg::LOD. toEntry: from the node's space to that of the entry's vertices. A mesh has the name of its node, else
    /// that of the file's mesh. Copies vertices unless their transform is the identity.
    static RigidMeshes of(osg::Node& node, unsigned short entry, const osg::Matrixd& toEntry);
};

} // namespace osgGpuAnimation
