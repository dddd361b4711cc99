// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/document/JsonTree.h"

#include <string>

namespace osgGpuAnimation::gltf
{

/// The text of a value and of all values below it that were not left out. Numbers without a fraction are written as
/// integers (8.0 as 8).
std::string writeJson(const JsonValue& value);

} // namespace osgGpuAnimation::gltf
