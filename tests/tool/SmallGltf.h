// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace osgGpuAnimation
{

/// A complete .gltf. Clip "Swing" (animation 0) turns node 0 "hinge" about +Z from 0 to 90 degrees in 2 seconds; clip
/// "Rise" (animation 1) lifts it by 1 in 1 second. Its child, node 1 "flag" at (0, 1, 0), is a rigid square of 2 x 2 in
/// its XY plane.
std::string swingingFlag();

/// With these names of the nodes.
std::string renamedFlag(const char* hinge, const char* flag);

/// With two cameras before it, "film" on the hinge, which follows it, and "plan", which stands still (orthographic, 8
/// units high), and a directional light, "sun".
std::string filmedFlag();

} // namespace osgGpuAnimation
