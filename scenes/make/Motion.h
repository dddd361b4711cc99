// SPDX-License-Identifier: MIT
#pragma once

#include "RigPose.h"

#include <functional>
#include <string>
#include <vector>

namespace osgGpuAnimation::scenes
{

/// A named moment of a clip.
struct MotionMarker
{
    double phase = 0.0; ///< [0, 1]
    std::string name;
};

/// A clip to be sampled: `pose` sets the pose at a phase; at phase 1 it must be the one of phase 0.
struct Motion
{
    std::string name;
    double seconds = 1.0;
    int samples = 24; ///< keyframes in the clip, less the last one, which repeats the first
    std::function<void(double phase, RigPose& pose)> pose;
    std::vector<MotionMarker> markers = {};
};

class GltfDocument;

/// Samples the motion and adds it as an animation; joints that stay at rest get no channel.
/// nodeOfJoint: one node for each joint of the rig.
void addClip(GltfDocument& document, const Rig& rig, const std::vector<int>& nodeOfJoint, const Motion& motion);

} // namespace osgGpuAnimation::scenes
