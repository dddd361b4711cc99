// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/ImportOptions.h"

#include <osgGpuAnimation/animation/Result.h>

#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// An option that readers of osgDB may be given, with a line on what it does.
using OptionHelp = std::pair<const char*, const char*>;

/// All options that parseOptions() knows.
const std::vector<OptionHelp>& optionHelp();

/// Reads osgDB's option string: words apart by spaces, `name` or `name=value`, a value with spaces in quotation marks
/// (`clip="Walk fast"`). Words of other names are other readers' and are passed over.
/// Errors: a value that is missing or no number where one is needed.
Result<ImportOptions> parseOptions(const std::string& text);

/// A sentence about each word that is nearly one of the options, but for the case of its letters or one wrong
/// letter: `"cliq" is unknown; is "clip" meant?`. Other words are taken for other readers': osgDB hands all to all.
std::vector<std::string> misspeltOptions(const std::string& text);

} // namespace osgGpuAnimation::gltf
