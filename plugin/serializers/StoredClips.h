// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <vector>

namespace osgGpuAnimation::serializers
{

class ValueReader;
class ValueWriter;

void writeClips(ValueWriter& out, const std::vector<Clip>& clips);
/// A clip that is none makes the file unreadable, with its name. mayBeCompact: from version 2 of a set on.
std::vector<Clip> readClips(ValueReader& in, const Skeleton& skeleton, const std::vector<MorphWeights>& morphs,
                            bool mayBeCompact);

} // namespace osgGpuAnimation::serializers
