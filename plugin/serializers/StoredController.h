// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationController.h>

namespace osgGpuAnimation::serializers
{

class ValueReader;
class ValueWriter;

/// All layers of a controller, as they are at that moment.
void writeController(ValueWriter& out, const AnimationController& controller);
/// Into a controller of the same set. A state that is none of that set's leaves the layer as it was, with a warning.
void readController(ValueReader& in, AnimationController& controller);

} // namespace osgGpuAnimation::serializers
