// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/ImportOptions.h"
#include "gltf/OptionSpelling.h"

#include <osgGpuAnimation/animation/Result.h>

#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// All options that parseOptions() knows.
const std::vector<OptionHelp>& optionHelp();

/// Reads osgDB's option string: words apart by spaces, `name` or `name=value`, a value with spaces in quotation marks
/// (`clip="Walk fast"`). Words of other names are other readers' and are passed over.
/// Errors: a value that is missing or no number where one is needed.
Result<ImportOptions> parseOptions(const std::string& text);

} // namespace osgGpuAnimation::gltf
