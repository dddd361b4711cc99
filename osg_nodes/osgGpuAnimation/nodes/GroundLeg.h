// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace osgGpuAnimation
{

/// A leg whose foot stands on the ground.
struct GroundLeg
{
    /// The name of a TwoBoneIk of the set, from the hip to the ankle. Its target belongs to the GroundFeet.
    std::string constraint;
    /// The joint at the ball of the foot, below the ankle: the ground is sampled below it and below the ankle, and a
    /// planted foot turns about it. Empty: the ankle alone.
    std::string toe{};
    /// The height of the sole of a planted foot in the clips, in the character's own space. Finite.
    double sole = 0.0;
    /// The names of the markers at which the foot touches and leaves the ground. Clips without a marker of the first
    /// name, or both empty: the times that findFootContacts() finds.
    std::string touchMarker{};
    std::string leaveMarker{}; ///< see touchMarker
};

} // namespace osgGpuAnimation
