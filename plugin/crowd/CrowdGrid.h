// SPDX-License-Identifier: MIT
#pragma once

#include "crowd/CrowdOptions.h"

#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

namespace osgGpuAnimation::crowd
{

/// Makes a crowd of the model's first AnimatedCharacter: columns and rows around its place in the model, each instance
/// with the model's orientation and scale, and with a random clip, time and outfit. Other nodes of the model are left
/// out. Errors: the model has no animated character; no such clip; a placement that a crowd refuses; outfits that do
/// not fit.
Result<osg::ref_ptr<AnimatedCrowd>> makeCrowd(osg::Node& model, const CrowdOptions& options);

} // namespace osgGpuAnimation::crowd
