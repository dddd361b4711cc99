// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/math/Result.h>

#include <cstddef>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// A time during which a joint touches the ground.
struct FootContact
{
    double touch = 0.0; ///< seconds, in [0, duration)
    double leave = 0.0; ///< seconds, above touch; beyond the duration: in the next round of a loop
};

/// Finds the times at which a joint touches and leaves the ground, for example for markers of footsteps:
///
///     auto steps = findFootContacts(set, "Walk", "toes.l");
///     for (const FootContact& step : steps.value()) markers.push_back({step.touch, "left foot"});
///
/// The joint is on the ground where it is in the lowest fifth of its lift and moves about as fast as at its lowest
/// places; contacts and gaps below 3 % of the clip do not count. The clip is sampled 240 times a second, with +Y up. A
/// joint that lifts by less than 1 % of the skeleton's height has one contact, the whole clip. Joints at the sole
/// (toes) give better times than ankles. A clip of duration 0 has no contacts. Contacts are in the order of touch.
/// Errors: no such clip, no such joint.
Result<std::vector<FootContact>> findFootContacts(const AnimationSet& set, const std::string& clip,
                                                  const std::string& joint);
/// The same by number.
Result<std::vector<FootContact>> findFootContacts(const AnimationSet& set, std::size_t clip, std::size_t joint);

} // namespace osgGpuAnimation
