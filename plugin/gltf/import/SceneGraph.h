// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Geometry>
#include <osg/Group>
#include <osg/Matrixd>
#include <tiny_gltf.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace osgGpuAnimation
{
class AnimatedCharacter;
}

namespace osgGpuAnimation::gltf
{

class MemoryBudget;
class Drawables;
class Report;
struct Joints;
struct Morphs;
struct NodeTree;

/// One primitive of one mesh node of the scene, as it is in the graph, or several that are drawn together.
struct ImportedPrimitive
{
    int node = -1; ///< the file's numbers
    int mesh = -1;
    int skin = -1;                        ///< -1: none
    int morph = -1;                       ///< index into the set's morphs, -1: none
    std::size_t targets = 0;              ///< morph targets
    std::size_t vertexCount = 0;          ///< of the file's POSITION accessor
    std::size_t influences = 0;           ///< joints a vertex can name: 4 a JOINTS_n set
    osg::ref_ptr<osg::Geometry> geometry; ///< a SkinnedGeometry if it is drawn from the palette
    /// The file's numbers within the mesh, ascending: more than one if they are drawn together, see Meshes.
    std::shared_ptr<const std::vector<int>> primitives;
    /// vertexCount numbers: the vertex of `geometry` for each of the file's vertices; null if they are the same.
    std::shared_ptr<const std::vector<std::uint32_t>> geometryVertex;
    /// Of a plain geometry: its mesh-to-world transform at rest, in the file's axes; identity for a SkinnedGeometry.
    osg::Matrixd toModel;
};

/// The input of buildSceneGraph().
struct SceneParts
{
    const tinygltf::Model& model;
    const NodeTree& tree;
    const Joints& joints;
    const Morphs& morphs;
    const std::vector<bool>& carries; ///< by node: it stands still and carries something besides a mesh
    Drawables& drawables;
    MemoryBudget& budget;
    Report& report;
};

/// Fills `still`, the character and `primitives`. Everything drawn from the palette becomes a child of the character;
/// the rest becomes MatrixTransforms below `still`, one a node of the file that carries something or is above such a
/// node, with geometries. Levels of detail are below an osg::LOD, by size on screen. Nodes that mirror set the winding
/// in their state, so that front faces stay front faces. Returns these transforms, one per node of the file, null where
/// there is none.
std::vector<osg::ref_ptr<osg::Group>> buildSceneGraph(const SceneParts& parts, osg::Group& still,
                                                      AnimatedCharacter* character,
                                                      std::vector<ImportedPrimitive>& primitives);

} // namespace osgGpuAnimation::gltf
