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

/// Those of the versions 2 to 4 of a stored set: columns of three numbers of 20 bits. If they do not fit into a record,
/// the clip becomes exact.
void readFormerCompactKeyframes(ValueStream& stream, ClipParts& clip, std::size_t& bytesLeft);

} // namespace osgGpuAnimation::serializers
