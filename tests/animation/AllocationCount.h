// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace osgGpuAnimation
{

/// How often this test program has called operator new so far.
std::size_t allocationCount();

} // namespace osgGpuAnimation
