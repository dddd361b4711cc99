// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/JsonTree.h"

#include <string>

namespace osgGpuAnimation::gltf
{

/// The text of a value and all below it that was not left out. Numbers without a fraction are written as integers
/// (8.0 as 8), which is how tinygltf wants them.
std::string writeJson(const JsonValue& value);

} // namespace osgGpuAnimation::gltf
