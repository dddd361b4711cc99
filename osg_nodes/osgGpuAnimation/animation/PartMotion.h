// SPDX-License-Identifier: MIT
#pragma once

namespace osgGpuAnimation
{

/// How much a translation or a scale of a track moves in the clips of a set: what the mix stage has to fetch for it.
enum class PartMotion
{
    Fixed,  ///< as at rest in every clip: an attribute, nothing is fetched
    Held,   ///< one value a clip
    Moving, ///< one value a keyframe
};

} // namespace osgGpuAnimation
