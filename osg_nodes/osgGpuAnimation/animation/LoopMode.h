// SPDX-License-Identifier: MIT
#pragma once

namespace osgGpuAnimation
{

/// What a clip does at its ends.
enum class LoopMode
{
    Once,     ///< time stops at duration (backwards: at 0) and the state becomes Ended
    Loop,     ///< time == duration shows the first frame (backwards: below 0 goes on from duration)
    PingPong, ///< turns round at duration and at 0, both shown exactly
};

} // namespace osgGpuAnimation
