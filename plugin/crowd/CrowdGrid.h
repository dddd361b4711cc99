// SPDX-License-Identifier: MIT
#pragma once

#include "crowd/CrowdOptions.h"

#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

namespace osgGpuAnimation::crowd
{

/// The crowd of a model that was read: its first AnimatedCharacter in columns and rows round the model's own place,
/// each as it stands there, with a clip and a time of its own. What else the model has is not in the crowd.
/// Errors: no animated character in the model; no such clip; a placement that a crowd refuses.
Result<osg::ref_ptr<AnimatedCrowd>> makeCrowd(osg::Node& model, const CrowdOptions& options);

} // namespace osgGpuAnimation::crowd
