// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/document/JsonTree.h"
#include "gltf/document/MemoryBudget.h"
#include "gltf/file/Report.h"
#include "gltf/file/Uri.h"

#include <tiny_gltf.h>

namespace osgGpuAnimation::gltf
{

/// Fills model.images with encoded bytes (as_is) from buffer view, data URI or file, with the MIME type and size that
/// the picture's header gives. The budget pays for reading and decoding; nothing later counts pictures again. A picture
/// that cannot be read, or that would exceed the budget, stays empty with a warning: the model is shown without it.
void loadImages(const JsonValue& images, const ModelFolder& folder, MemoryBudget& budget, Report& report,
                tinygltf::Model& model);

} // namespace osgGpuAnimation::gltf
