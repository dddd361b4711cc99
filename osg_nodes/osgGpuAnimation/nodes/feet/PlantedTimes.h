// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/ClipMixer.h>
#include <osgGpuAnimation/authoring/FootContacts.h>

#include <limits>
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
    /// The present state of the foot in the clips, and its next landing.
    struct Now
    {
        bool isPlanted = true;
        /// Until the heaviest clip plants a lifted foot; infinity: never.
        double secondsToTouch = std::numeric_limits<double>::infinity();
        glm::dvec3 ankle{0.0}, contact{0.0}; ///< their places then, in the file's space
    };

    /// contact: the joint at the sole. The markers' names may be empty.
    PlantedTimes(std::size_t ankle, std::size_t contact, std::string touchMarker, std::string leaveMarker)
        : _ankle(ankle), _contact(contact), _touchMarker(std::move(touchMarker)), _leaveMarker(std::move(leaveMarker))
    {
    }

    /// The foot is planted if the clips that move it plant it by at least half of their weight. Without such a clip it
    /// stands, as in the rest pose. controller: always of the same set.
    Now now(const AnimationController& controller);

private:
    /// A contact in one clip.
    struct Contact
    {
        FootContact time;
        glm::dvec3 ankle, contact; ///< their places at the touch, in the file's space
    };

    const std::vector<Contact>& contactsOf(const AnimationSet& set, int clip);
    void findLanding(const AnimationSet& set, const ClipPlayback& playback, Now& now);

    std::size_t _ankle, _contact;
    std::string _touchMarker, _leaveMarker;
    std::vector<std::optional<std::vector<Contact>>> _contacts; ///< by clip; empty: not computed yet
};

} // namespace osgGpuAnimation
