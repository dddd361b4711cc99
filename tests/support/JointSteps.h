// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationController.h>

#include <memory>
#include <vector>

namespace osgGpuAnimation
{

/// The frame time of the crossfade tests, in seconds.
constexpr double frameSeconds = 1.0 / 60.0;

/// The current positions of the joints in the model's space.
std::vector<glm::vec3> jointPlaces(const AnimationController& controller);

/// The largest distance of a joint between the two.
double largestStep(const std::vector<glm::vec3>& before, const std::vector<glm::vec3>& after);

/// The largest step of a joint from one frame to the next while the clip plays alone for that many frames.
double stepOfClip(const std::shared_ptr<const AnimationSet>& set, std::size_t clip, int frames);

} // namespace osgGpuAnimation
