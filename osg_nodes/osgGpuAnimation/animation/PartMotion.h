// SPDX-License-Identifier: MIT
#pragma once

namespace osgGpuAnimation
{

/// How a translation or a scale of a track changes in the clips of a set; it decides what the mix stage fetches.
enum class PartMotion
{
    Fixed,  ///< equal to the rest pose in every clip: an attribute, nothing is fetched
    Held,   ///< constant in every clip: one value per clip
    Moving, ///< one value per keyframe
};

} // namespace osgGpuAnimation
