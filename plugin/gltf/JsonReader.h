// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/ImportOptions.h"
#include "gltf/JsonTree.h"
#include "gltf/Report.h"

#include <osgGpuAnimation/animation/Result.h>

#include <string_view>

namespace osgGpuAnimation::gltf
{

/// Parses a JSON text within the limits of the options, without recursion: strict syntax, UTF-8 and numbers that fit a
/// double (section 2.7). Of two members with one key the last counts, with a warning.
/// Errors: what and where the fault in the text is; a limit on depth, elements or values that is exceeded; a root that
/// is no object.
Result<JsonTree> readJson(std::string_view text, const ImportOptions& options, Report& report);

} // namespace osgGpuAnimation::gltf
