// SPDX-License-Identifier: MIT
// Old include path until data/ and scene/ have moved.
#pragma once

#include "gltf/scene/TransformBound.h"

namespace osgGpuAnimation::gltf
{

using Reach = TransformBound;
inline std::vector<Reach> reachAtRest(const Skeleton& skeleton)
{
    return boundsAtRest(skeleton);
}
inline std::vector<Reach> reachOfEntries(const AnimationSet& set)
{
    return boundsOfEntries(set);
}

} // namespace osgGpuAnimation::gltf
