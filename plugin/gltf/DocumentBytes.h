// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/JsonTree.h"

#include <osgGpuAnimation/animation/Result.h>

#include <cstddef>
#include <optional>

namespace osgGpuAnimation::gltf
{

/// What one value takes as text, in the tree and while tinygltf parses it.
constexpr std::size_t bytesOfJsonValue = 128;
/// The same for each letter of strings and keys.
constexpr std::size_t bytesOfJsonLetter = 6;

/// Is there room for what a document says about its parts (ImportOptions::maxDocumentBytes)? Two letters, `{}`, are a
/// material of two kilobytes, so that sizes have to be looked at before anything is made. To be called first: expects
/// nothing of the document but that its root is an object.
/// Error: names the list at which the limit is passed.
std::optional<Error> checkDocumentBytes(JsonTree& json, std::size_t limit);

} // namespace osgGpuAnimation::gltf
