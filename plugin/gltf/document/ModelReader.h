// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/document/JsonTree.h"
#include "gltf/document/MemoryBudget.h"
#include "gltf/file/ModelFolder.h"
#include "gltf/file/Report.h"

#include <osgGpuAnimation/animation/Result.h>

#include <tiny_gltf.h>

#include <optional>
#include <string_view>

namespace osgGpuAnimation::gltf
{

/// Fills a model from a document that has passed checkSchema() and checkDocumentRules(), without tinygltf's own parser:
/// no text is written and parsed a second time. Buffers, images and cameras are not read; accessors have no minValues
/// and maxValues.
tinygltf::Model readModel(const JsonValue& document);

/// Fills model.buffers, each with byteLength bytes exactly: from its data URI, its external file (which may be longer),
/// or the BIN chunk (glTF 2.0, section 3.6.1). A buffer without any of them stays empty; validateAccessors() refuses
/// references to it.
/// Returns the first fault that the document must be refused for.
std::optional<Error> loadBuffers(const JsonValue& buffers, const std::optional<std::string_view>& binary,
                                 const ModelFolder& folder, MemoryBudget& budget, Report& report,
                                 tinygltf::Model& model);

} // namespace osgGpuAnimation::gltf
