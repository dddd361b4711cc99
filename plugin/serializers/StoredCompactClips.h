// SPDX-License-Identifier: MIT
#pragma once

#include "serializers/ValueStream.h"

#include <osgGpuAnimation/animation/Clip.h>

namespace osgGpuAnimation::serializers
{

// The keyframes of compact clips in files of stored scenes. clip: has its times and numbers of tracks; reading adds its
// data and compact tracks, which Clip::create() checks. bytesLeft: the memory for the data of all compact clips of a
// set; reading subtracts from it, and beyond it the file is unreadable.

/// See CompactTracks: its tracks and records, the transforms of joints at rest, and the morph weights.
void transferCompactKeyframes(ValueStream& stream, ClipParts& clip, std::size_t& bytesLeft);

} // namespace osgGpuAnimation::serializers
