// SPDX-License-Identifier: MIT
#pragma once

namespace osgGpuAnimation
{

/// The behaviour of a clip at its ends.
enum class LoopMode
{
    Once,     ///< time stops at duration (backwards: at 0) and the layer becomes PlayState::Ended
    Loop,     ///< time == duration shows the first keyframe (backwards: time continues from duration)
    PingPong, ///< time reverses at duration and at 0; both ends are shown
};

} // namespace osgGpuAnimation
