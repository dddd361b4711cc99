// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/Meshes.h"

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

/// JOINTS_n and WEIGHTS_n of a primitive for one skin (glTF 2.0, section 3.7.3.3). Weights are taken as they are, and
/// only three things are mended, each with a warning: a vertex that nothing moves follows the first joint it names; of
/// more than eight influences the eight largest are kept and scaled to the sum of all; a joint that the skin does not
/// have loses its weight.
std::vector<InfluenceSet> readInfluences(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                         const MeshPrimitive& mesh, const AnimationSet& set, std::size_t skin,
                                         Report& report);

/// How many JOINTS_n with WEIGHTS_n there are, counted from 0.
std::size_t influenceSetCount(const tinygltf::Primitive& primitive);

} // namespace osgGpuAnimation::gltf
