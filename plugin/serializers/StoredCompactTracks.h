// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/ClipParts.h>

#include <cstddef>

namespace osgGpuAnimation::serializers
{

class ValueReader;
class ValueWriter;

/// The keyframes of a compact clip: where each joint's numbers lie, what it holds still, its weights, and the packed
/// numbers, x, y and z + place * 2^20 (see PackedTriple).
void writeCompactKeyframes(ValueWriter& out, const Clip& clip);

/// Fills data and compactTracks; the times and the numbers of joints and tracks are in. Compact clips may be far larger
/// in memory than in the file. bytesLeft: for keyframes, counted down; more make the file unreadable.
void readCompactKeyframes(ValueReader& in, ClipParts& parts, std::size_t& bytesLeft);

} // namespace osgGpuAnimation::serializers
