// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/document/JsonTree.h"
#include "gltf/document/MemoryBudget.h"
#include "gltf/file/Report.h"
#include "gltf/file/Uri.h"

#include <tiny_gltf.h>

namespace osgGpuAnimation::gltf
{

/// Fills model.images from the document's: with encoded bytes (as_is) from buffer view, data URI or file, and with the
/// MIME type and size from the picture's header. Takes both the encoded and the decoded bytes from the budget. A
/// picture that cannot be read, or that exceeds the budget, stays empty with a warning: the model is shown without it.
/// Images that only KHR_texture_basisu, MSFT_texture_dds or EXT_texture_avif name stay empty too. model.textures has
/// the textures, their source the picture to show; one without a source gets a warning that names the format.
void loadImages(const JsonValue& document, const ModelFolder& folder, MemoryBudget& budget, Report& report,
                tinygltf::Model& model);

} // namespace osgGpuAnimation::gltf
