// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationController.h>

#include <memory>
#include <vector>

namespace osgGpuAnimation
{

/// Seconds of the frames that the tests of crossfades go by.
constexpr double frameSeconds = 1.0 / 60.0;

/// Where the joints are now, in the model's space: one place a joint.
std::vector<glm::vec3> jointPlaces(const AnimationController& controller);

/// The longest way of a joint from one to the other.
double largestStep(const std::vector<glm::vec3>& before, const std::vector<glm::vec3>& after);

/// The largest step of a joint from one frame to the next while the clip plays alone for that many frames.
double stepOfClip(const std::shared_ptr<const AnimationSet>& set, std::size_t clip, int frames);

} // namespace osgGpuAnimation
