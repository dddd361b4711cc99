// SPDX-License-Identifier: MIT
#pragma once

#include "../GltfDocument.h"
#include "../Rig.h"

namespace osgGpuAnimation::scenes
{

/// Body, head, jaw, eyes and fins in one primitive with vertex colours.
PrimitiveArrays serpentArrays(const Rig& rig);

} // namespace osgGpuAnimation::scenes
