// SPDX-License-Identifier: MIT
#pragma once

#include "GpuPage.h"

#include <osg/State>

#include <cstddef>

namespace osgGpuAnimation::benchmark
{

// Passes by themselves that stand for parts of a frame: what they measure would need much code in the kit before a
// device had judged it. Each throws if a result is wrong or GL reports an error.

/// Copies between two buffers. Returns the bytes a second, read and written. bytes: of each buffer.
double copySpeedOf(osg::State& state, std::size_t bytes);

constexpr std::size_t texelsOfLayout = 150; ///< of the palette of an instance in measureLayouts()
/// Vertices that read four palette entries each: palettes with the instances of an entry side by side (as the kit's)
/// and with the entries of an instance side by side; instances drawn in order and level by level.
/// instances: of which the texels fit a buffer texture.
void measureLayouts(osg::State& state, std::size_t instances, GpuPage& page);

/// 16 bytes an instance that change in each step and that a pass reads: by glBufferSubData into the buffer in use (as
/// the kit does when at most half has changed), into new storage (as when more has), and by a mapped ring of three
/// (GL 4.4).
void measureUploads(osg::State& state, std::size_t instances, GpuPage& page);

} // namespace osgGpuAnimation::benchmark
