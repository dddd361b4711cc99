// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/import/Meshes.h"

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <osg/Array>

#include <vector>

namespace osgGpuAnimation::gltf
{

/// The palette entries that move each vertex and their weights, four to a set, as SkinnedGeometry takes them.
struct InfluenceSet
{
    osg::ref_ptr<osg::Vec4usArray> entries;
    osg::ref_ptr<osg::Vec4Array> weights;
};

/// JOINTS_n and WEIGHTS_n of a primitive for one skin (glTF 2.0, section 3.7.3.3). The validation has mended weights
/// and joints (see ValidateMeshes.h). A vertex keeps its eight largest influences, scaled to the sum of all; dropping
/// others gives a warning.
std::vector<InfluenceSet> readInfluences(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                         const MeshPrimitive& mesh, const AnimationSet& set, std::size_t skin,
                                         Report& report);

} // namespace osgGpuAnimation::gltf
