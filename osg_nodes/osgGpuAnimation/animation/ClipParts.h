// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Clip.h>

#include <memory>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

struct CompactTracks;
struct RootMotionCurve;

/// The input of Clip::create(): everything that a clip exports.
struct ClipParts
{
    std::string name;
    Clip::Form form = Clip::Form::Linear;
    std::size_t jointCount = 0;       ///< the first tracks; their transforms belong to joints
    std::size_t trackCount = 0;       ///< joints, then weight blocks
    std::vector<float> times;         ///< as Clip::times()
    std::vector<JointTransform> data; ///< as Clip::data()
    std::vector<ClipMarker> markers;
    std::shared_ptr<const RootMotionCurve> rootMotion; ///< null: none
    std::shared_ptr<const CompactTracks>
        compactTracks; ///< null: exact; else create() writes their decoded values to data
};

} // namespace osgGpuAnimation
