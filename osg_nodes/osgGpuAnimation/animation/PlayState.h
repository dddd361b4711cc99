// SPDX-License-Identifier: MIT
#pragma once

namespace osgGpuAnimation
{

/// The state of an AnimationLayer.
enum class PlayState
{
    Stopped, ///< the layer shows nothing: the layers below it are visible, and the rest pose below all
    Playing, ///< advance() moves the time
    Paused,  ///< advance() moves neither time nor fades; the layer shows the pose of its time
    Ended,   ///< a Once clip reached its end; the layer shows the pose of that end
};

} // namespace osgGpuAnimation
