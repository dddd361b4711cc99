// SPDX-License-Identifier: MIT
#pragma once

#include <osg/PrimitiveSet>
#include <osg/State>

namespace osgGpuAnimation
{

/// Draws the primitives so many times, with gl_InstanceID from 0 to count - 1, whatever number of instances they name
/// themselves. To be called where a drawable draws its primitives, its vertex arrays being set up. Primitive sets of
/// the indirect kinds, whose counts lie on the GPU, are drawn once, as they are.
/// usesBuffers: whether indices lie in buffer objects.
void drawInstanced(osg::State& state, const osg::PrimitiveSet& primitives, int count, bool usesBuffers);

} // namespace osgGpuAnimation
