// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/Skinning.h>

namespace osgGpuAnimation
{

struct FlagOptions
{
    std::size_t morphTargets = 0;
    bool hasNormals = true;
    Skinning skinning = Skinning::Once;
};

/// A lit strip of 9 x 9 vertices, two units high, whose upper half goes over from one joint to the other.
osg::ref_ptr<AnimatedCharacter> makeFlag(const FlagOptions& options);

} // namespace osgGpuAnimation
