// SPDX-License-Identifier: MIT
#pragma once

namespace osgGpuAnimation
{

/// What a layer does.
enum class PlayState
{
    Stopped, ///< it shows nothing: what lies below it is seen, in the end the rest pose
    Playing, ///< advance() moves the time
    Paused,  ///< the pose of the current time is held, and fades stand still
    Ended,   ///< Once came to its end: that end's pose is held
};

} // namespace osgGpuAnimation
