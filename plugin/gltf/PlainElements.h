// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/JsonTree.h"

#include <tiny_gltf.h>

#include <vector>

namespace osgGpuAnimation::gltf
{

// The elements that nine tenths of an animated document are made of: a few plain numbers each, which the schema has
// checked. They are taken from the tree as they are, since tinygltf takes longer for them than for everything else of
// an import. Each reader wants a document that has passed SchemaCheck and checkDocumentRules(), or nothing, for an
// empty list; accessors have no minValues and maxValues.

std::vector<tinygltf::Accessor> readAccessors(const JsonValue& accessors);
std::vector<tinygltf::BufferView> readBufferViews(const JsonValue& bufferViews);
std::vector<tinygltf::AnimationChannel> readChannels(const JsonValue& channels);
std::vector<tinygltf::AnimationSampler> readAnimationSamplers(const JsonValue& samplers);

} // namespace osgGpuAnimation::gltf
