// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <vector>

namespace osgGpuAnimation
{

/// The largest distance of a row of the palette on the GPU, at that place of the frame's batches, from the CPU twin's;
/// huge if the sizes differ.
inline double differenceFromTwin(osg::State& state, const AnimationController& controller, const AffineMatrix& root,
                                 std::size_t slot, std::size_t instance)
{
    std::vector<AffineMatrix> twin;
    Pose::evaluate(controller.set(), controller.instruction(), root, twin);
    const auto shown = PosePipeline::of(state)->readPalette(state, controller.set(), slot, instance);
    if (shown.size() != twin.size() || twin.empty()) return 1e30;
    double largest = 0.0;
    for (std::size_t entry = 0; entry < shown.size(); ++entry)
        for (std::size_t row = 0; row < 3; ++row)
            largest =
                std::max(largest, static_cast<double>(glm::distance(shown[entry].rows[row], twin[entry].rows[row])));
    return largest;
}

} // namespace osgGpuAnimation
