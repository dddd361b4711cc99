// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/MorphTarget.h>

#include <osg/Array>
#include <osg/Vec4>
#include <tiny_gltf.h>

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// glTF's factors and vertex colours are linear (section 3.9.2), its pictures sRGB. OSG's fixed pipeline and our
/// character program shade in display space and take pictures as they are; so linear colours are converted by the
/// sRGB transfer function (IEC 61966-2-1). Alpha is linear in both. Clamped to [0, 1].
osg::Vec4 displayColor(double red, double green, double blue, double alpha);

// A primitive's vertex attributes as OSG's arrays (glTF 2.0, section 3.7.2.1); the validation has checked their types.
// Null where the primitive has no such attribute.

osg::ref_ptr<osg::Vec3Array> readVectors(const tinygltf::Model& model, const std::map<std::string, int>& attributes,
                                         const char* name);

/// COLOR_0, see displayColor().
osg::ref_ptr<osg::Vec4Array> readColors(const tinygltf::Model& model, const tinygltf::Primitive& primitive);

/// For the material's base colour texture, see TextureCoordinates.
osg::ref_ptr<osg::Vec2Array> readTextureCoordinates(const tinygltf::Model& model, const tinygltf::Primitive& primitive);

/// One per target of the primitive. Colours and texture coordinates are offsets to the results of the two functions
/// above; since displayColor() is not linear, colours are exact at weight 1 only.
std::vector<MorphTarget> readMorphTargets(const tinygltf::Model& model, const tinygltf::Primitive& primitive);

/// The number of consecutive JOINTS_n with WEIGHTS_n of the primitive, from n = 0.
std::size_t influenceSetCount(const tinygltf::Primitive& primitive);

} // namespace osgGpuAnimation::gltf
