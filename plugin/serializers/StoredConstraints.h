// SPDX-License-Identifier: MIT
#pragma once

#include "serializers/ValueStream.h"

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/Constraint.h>

#include <vector>

namespace osgGpuAnimation::serializers
{

/// The declarations of a set.
void transferConstraints(ValueStream& stream, std::vector<Constraint>& constraints);

/// The targets of a controller. Reading expects a controller of the same set; a target that does not fit the set is
/// dropped, with a warning.
void transferTargets(ValueStream& stream, AnimationController& controller);

} // namespace osgGpuAnimation::serializers
