// SPDX-License-Identifier: MIT
#pragma once

#include "../Motion.h"

namespace osgGpuAnimation::scenes
{

/// Strong sideways waves that run from head to tail.
Motion serpentSwim();
/// Slow drifting: a gentle up and down, the fins spread, the jaw opening once.
Motion serpentGlide();

} // namespace osgGpuAnimation::scenes
