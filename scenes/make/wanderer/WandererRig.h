// SPDX-License-Identifier: MIT
#pragma once

#include "../Rig.h"

namespace osgGpuAnimation::scenes
{

/// 33 joints in an A-pose, arms 45 degrees down, 1.7 m tall; the last one, Lantern, only carries the lantern.
Rig makeWandererRig();

} // namespace osgGpuAnimation::scenes
