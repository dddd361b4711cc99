// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/ClipBuilder.h>

#include <optional>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

class AnimationController;

/// When the clips of one set plant a foot: from its touch markers to its leave markers, or, in clips without such
/// markers, as findFootContacts() says.
class PlantedTimes
{
public:
    /// contact: the joint at the sole. The markers' names may be empty.
    PlantedTimes(std::size_t contact, std::string touchMarker, std::string leaveMarker)
        : _contact(contact), _touchMarker(std::move(touchMarker)), _leaveMarker(std::move(leaveMarker))
    {
    }

    /// True if the clips that move the foot plant it now, by at least half of their weight. Without such a clip the
    /// foot stands, as in the rest pose. controller: always of the same set.
    bool isPlanted(const AnimationController& controller);

private:
    const std::vector<FootContact>& contactsOf(const AnimationSet& set, int clip);

    std::size_t _contact;
    std::string _touchMarker, _leaveMarker;
    std::vector<std::optional<std::vector<FootContact>>> _contacts; ///< by clip; empty: not computed yet
};

} // namespace osgGpuAnimation
