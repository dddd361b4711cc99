// SPDX-License-Identifier: MIT
#pragma once

#include <osg/PrimitiveSet>

#include <cstddef>

namespace osgGpuAnimation
{

/// True if all indices of the primitive set are below the number of vertices. False for null, and for sets that read
/// their ranges from buffers. Check it before the indices are collected: a DrawArrays may count any number of them.
bool isWithin(const osg::PrimitiveSet* primitives, std::size_t vertices);

} // namespace osgGpuAnimation
