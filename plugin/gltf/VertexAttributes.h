// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/MorphTarget.h>

#include <osg/Array>
#include <tiny_gltf.h>

#include <map>
#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

// A primitive's vertex attributes as OSG's arrays (glTF 2.0, section 3.7.2.1). Null where the primitive has no such
// attribute or it is not of a fitting type.

osg::ref_ptr<osg::Vec3Array> readVectors(const tinygltf::Model& model, const std::map<std::string, int>& attributes,
                                         const char* name);

/// COLOR_0 for display, see DisplayColor.h.
osg::ref_ptr<osg::Vec4Array> readColors(const tinygltf::Model& model, const tinygltf::Primitive& primitive);

/// For the material's base colour texture, see TextureCoordinates.
osg::ref_ptr<osg::Vec2Array> readTextureCoordinates(const tinygltf::Model& model, const tinygltf::Primitive& primitive);

/// One a target of the primitive. Colours and texture coordinates are what the target changes in those that the two
/// functions above give: for colours, whose way to the display is curved, the change at weight 1.
std::vector<MorphTarget> readMorphTargets(const tinygltf::Model& model, const tinygltf::Primitive& primitive);

/// The accessor of an attribute that has one of these numbers of components; -1 where there is none.
int findAccessor(const tinygltf::Model& model, const std::map<std::string, int>& attributes, const std::string& name,
                 std::initializer_list<std::size_t> components);

} // namespace osgGpuAnimation::gltf
