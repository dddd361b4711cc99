// SPDX-License-Identifier: MIT
#pragma once

#include "fbx/Scene.h"
#include "gltf/file/Report.h"

#include <assimp/scene.h>

#include <string>

namespace osgGpuAnimation::assimp
{

/// What the conversion knows of a node beyond Assimp's scene, in the node's metadata.
///
///     mark(node, {"geo", false});      // the names of aiNodes are unique, those of the file need not be
///     nodes[i]["name"] = marksOf(node).name;
struct NodeMarks
{
    std::string name;      ///< in the file
    bool isHidden = false; ///< neither it nor what is below it is drawn
};

inline void mark(aiNode& node, const NodeMarks& marks)
{
    delete node.mMetaData;
    node.mMetaData = aiMetadata::Alloc(2);
    node.mMetaData->Set(0, "osgGpuAnimation.name", aiString(marks.name));
    node.mMetaData->Set(1, "osgGpuAnimation.hidden", marks.isHidden);
}

inline NodeMarks marksOf(const aiNode& node)
{
    NodeMarks marks{node.mName.C_Str(), false};
    aiString name;
    if (node.mMetaData && node.mMetaData->Get("osgGpuAnimation.name", name)) marks.name = name.C_Str();
    if (node.mMetaData) node.mMetaData->Get("osgGpuAnimation.hidden", marks.isHidden);
    return marks;
}

/// Adds to a scene that Assimp read from fbx.bytesForAssimp what Assimp loses: places each node where its pivots put
/// it, moves meshes by their geometric offsets, sets the weights of shapes at rest, marks hidden nodes (see
/// NodeMarks), and writes all takes as animations of seconds.
///
/// Tracks have the keys of the file, and more where interpolation between two keys would deviate from the curves: by
/// 0.001 radians in rotations, by 1/10,000 of the largest value elsewhere. Each take begins at 0 and ends at its
/// duration; a stepped key becomes two keys at neighbouring times.
///
/// Segment Scale Compensate becomes a node between the parent, where that is scaled, and the model.
void completeFbx(aiScene& scene, const fbx::Scene& fbx, gltf::Report& report);

} // namespace osgGpuAnimation::assimp
