// SPDX-License-Identifier: MIT
#pragma once

#include "serializers/ValueStream.h"

#include <osgGpuAnimation/mesh/SkinnedGeometry.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

namespace osgGpuAnimation::serializers
{

/// The levels of detail of a mesh, so that reading creates none. Levels with a fault (a warning names it) or of other
/// vertices or primitives than the mesh's are dropped and created anew when they are needed.
void transferLodLevels(ValueStream& stream, SkinnedGeometry& mesh);
/// The same for a crowd's levels of the character as a whole, before the crowd's pixel error is set.
void transferCharacterLevels(ValueStream& stream, AnimatedCrowd& crowd);

} // namespace osgGpuAnimation::serializers
