// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace osgGpuAnimation
{

/// The number of calls of operator new in this test program so far.
std::size_t allocationCount();

} // namespace osgGpuAnimation
