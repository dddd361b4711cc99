// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/gpu/buffers/PosePalette.h>
#include <osgGpuAnimation/gpu/PoseBatch.h>

namespace osgGpuAnimation
{

/// The CPU twin in place of all passes, for drivers whose transform feedback does not work: computes the palettes of
/// the chunk's instances and uploads them. memory: kept from call to call.
void evaluateOnCpu(const PoseBatch& batch, PosePalette::Chunk& chunk, std::vector<AffineMatrix>& memory);

} // namespace osgGpuAnimation
