// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace osgGpuAnimation
{

/// A whole .gltf: node 0 "hinge", which clip "Swing" (animation 0) turns about +Z from 0 to 90 degrees in 2 seconds and
/// clip "Rise" (animation 1) lifts by 1 in 1 second; below it node 1 "flag" at (0, 1, 0), a rigid square of 2 x 2 in
/// its XY plane.
std::string swingingFlag();

} // namespace osgGpuAnimation
