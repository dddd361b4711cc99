// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/file/Report.h"
#include "gltf/ImportOptions.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/nodes/CompactCharacter.h>

#include <osg/Geometry>
#include <osg/MatrixTransform>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// One primitive of one mesh node of the scene, and its drawable in the graph.
struct ImportedPrimitive
{
    int node = -1; ///< the file's numbers
    int mesh = -1;
    int primitive = -1;                   ///< within the mesh
    int skin = -1;                        ///< -1: none
    int morph = -1;                       ///< index into the set's morphs, -1: none
    std::size_t targets = 0;              ///< morph targets
    std::size_t vertexCount = 0;          ///< of the file's POSITION accessor
    std::size_t influences = 0;           ///< joints a vertex can name: 4 a JOINTS_n set
    osg::ref_ptr<osg::Geometry> geometry; ///< a SkinnedGeometry where it is drawn from the palette
    /// vertexCount numbers: the vertex of `geometry` for each vertex of the file; null if they are the same.
    std::shared_ptr<const std::vector<std::uint32_t>> geometryVertex;
    osg::Matrixd
        toModel; ///< of a plain geometry: its place at rest, in the file's axes; identity for a SkinnedGeometry
};

/// The result of an import.
struct ImportedModel
{
    osg::ref_ptr<osg::MatrixTransform> root;   ///< turns +Y up to +Z up (identity with noRotation)
    osg::ref_ptr<AnimatedCharacter> character; ///< below root; null where nothing in the file can move
    std::shared_ptr<const AnimationSet> set;   ///< the character's; null if there is none
    std::vector<ImportedPrimitive> primitives; ///< by node, then primitive

    int scene = 0;                               ///< the imported scene, -1: the file has none
    std::vector<std::string> nodeNames;          ///< one a node of the file; empty where it has none
    std::vector<int> nodeParents;                ///< -1 for roots
    std::optional<CompactedCharacter> compacted; ///< only if the options ask for compact clips
    std::vector<int> animationOfClip;            ///< the file's animation number of each clip of the set
    std::vector<std::string> materialNames;
    std::vector<std::string> extensionsUsed;
    std::string generator; ///< asset.generator
    Messages messages;
};

/// Imports a file's content; see loadDocument() for bytes and fileName.
/// Errors: as loadDocument(); an unknown clip or scene asked for in the options.
Result<ImportedModel> importModel(const std::string& bytes, const std::string& fileName, const ImportOptions& options);

} // namespace osgGpuAnimation::gltf
