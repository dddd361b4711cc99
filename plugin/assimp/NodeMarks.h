// SPDX-License-Identifier: MIT
#pragma once

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

} // namespace osgGpuAnimation::assimp
