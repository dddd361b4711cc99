// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/AttributeSemantic.h"

#include <tiny_gltf.h>

#include <string>

namespace osgGpuAnimation::gltf
{

/// Where an attribute stands: its accessor may have other types in a morph target, and more with
/// KHR_mesh_quantization.
struct AttributePlace
{
    bool isMorphTarget = false;
    bool isQuantized = false;
};

/// Empty where the accessor's type and components are those of the attribute (glTF 2.0, section 3.7.2.1 and 3.7.2.2;
/// KHR_mesh_quantization), else what is expected: `VEC3 of float`.
std::string wrongAttributeFormat(const tinygltf::Accessor& accessor, AttributeSemantic::Kind kind,
                                 AttributePlace place);

/// What an accessor holds: `VEC2 of normalized unsigned short`.
std::string formatText(const tinygltf::Accessor& accessor);

} // namespace osgGpuAnimation::gltf
