// SPDX-License-Identifier: MIT
// Old include path until data/ and scene/ have moved.
#pragma once

#include "gltf/document/MemoryBudget.h"

namespace osgGpuAnimation::gltf
{

using DecodedBytes = MemoryBudget;

} // namespace osgGpuAnimation::gltf
