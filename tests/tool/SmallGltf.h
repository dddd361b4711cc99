// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace osgGpuAnimation
{

/// A complete .gltf. Clip "Swing" (animation 0) turns node 0 "hinge" about +Z from 0 to 90 degrees in 2 seconds; clip
/// "Rise" (animation 1) lifts it by 1 in 1 second. Its child, node 1 "flag" at (0, 1, 0), is a rigid square of 2 x 2 in
/// its XY plane.
std::string swingingFlag();

} // namespace osgGpuAnimation
