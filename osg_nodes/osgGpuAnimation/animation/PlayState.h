// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace osgGpuAnimation
{

/// The maximum number of layers of an AnimationController.
constexpr std::size_t maxLayers = 8;

/// The state of an AnimationLayer.
enum class PlayState
{
    Stopped, ///< the layer shows nothing: the layers below it are visible, and the rest pose below all
    Playing, ///< advance() moves the time
    Paused,  ///< time and fades stand still; the layer shows the pose of its time
    Ended,   ///< a Once clip reached its end; the layer shows the pose of that end
};

} // namespace osgGpuAnimation
