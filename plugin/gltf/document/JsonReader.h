// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/document/JsonTree.h"
#include "gltf/file/ImportOptions.h"
#include "gltf/file/Report.h"

#include <osgGpuAnimation/math/Result.h>

#include <string_view>

namespace osgGpuAnimation::gltf
{

/// Parses a JSON text within the limits of the options, without recursion: strict syntax, UTF-8 and numbers that fit a
/// double (section 2.7). Of two members with one key the last one is used, with a warning.
/// Errors: a fault in the text, with its position; more depth, elements or values than the limits allow; a root that is
/// not an object.
Result<JsonTree> readJson(std::string_view text, const ImportOptions& options, Report& report);

} // namespace osgGpuAnimation::gltf
