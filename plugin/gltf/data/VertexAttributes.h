// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/data/TextureCoordinates.h"

#include <osgGpuAnimation/mesh/MorphTarget.h>

#include <osg/Array>
#include <tiny_gltf.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

// A primitive's vertex attributes as OSG's arrays (glTF 2.0, section 3.7.2.1); the validation has checked their types.
// Null where the primitive has no such attribute.

osg::ref_ptr<osg::Vec3Array> readVectors(const tinygltf::Model& model, const std::map<std::string, int>& attributes,
                                         const char* name);

/// COLOR_0, as displayed, see displayColor().
osg::ref_ptr<osg::Vec4Array> readColors(const tinygltf::Model& model, const tinygltf::Primitive& primitive);

/// TEXCOORD_n, transformed.
osg::ref_ptr<osg::Vec2Array> readTextureCoordinates(const tinygltf::Model& model,
                                                    const std::map<std::string, int>& attributes,
                                                    const TextureCoordinates& coordinates);

/// TANGENT: w is 1 or -1.
osg::ref_ptr<osg::Vec4Array> readTangents(const tinygltf::Model& model, const tinygltf::Primitive& primitive);

/// One per target of the primitive. Colours are offsets to those of readColors(); since displayColor() is not linear,
/// they are exact at weight 1 only. Texture coordinates are offsets to `coordinates`; null: none are read.
std::vector<MorphTarget> readMorphTargets(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                          const TextureCoordinates* coordinates, bool withTangents);

/// Of these indices or vertices, the number that form whole points, lines or triangles. mode: of a primitive.
std::size_t wholeCount(int mode, std::size_t count);

/// The number of consecutive JOINTS_n with WEIGHTS_n of the primitive, from n = 0.
std::size_t influenceSetCount(const tinygltf::Primitive& primitive);

/// JOINTS_n and WEIGHTS_n of a primitive, four numbers a vertex.
struct FileInfluences
{
    std::vector<std::uint32_t> joints;
    std::vector<float> weights;
};

std::vector<FileInfluences> readFileInfluences(const tinygltf::Model& model, const tinygltf::Primitive& primitive);

} // namespace osgGpuAnimation::gltf
