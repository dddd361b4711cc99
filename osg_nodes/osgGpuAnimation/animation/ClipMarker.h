// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace osgGpuAnimation
{

/// A named time of a clip, for example when a foot touches the ground.
struct ClipMarker
{
    double time = 0.0; ///< seconds on the clip's time line, in [0, duration]
    std::string name;
};

} // namespace osgGpuAnimation
