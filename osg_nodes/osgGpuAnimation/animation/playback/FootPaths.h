// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <glm/vec3.hpp>

#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

/// The places of joints over a round of a clip or of a mix of clips, in the model's space with +Y up, and what they say
/// about the ground: when a joint touches it, and how fast it moves below the character.
class FootPaths
{
public:
    using Path = std::vector<glm::dvec3>;
    /// Samples [first, second) of a path, the second not below the first; beyond the number of samples: in the next
    /// round.
    using Contacts = std::vector<std::pair<std::size_t, std::size_t>>;

    /// times: ascending seconds of the samples, the last is the end of the round. poseAt: the pose of each. joints: the
    /// joints whose paths are kept; empty: all.
    FootPaths(const AnimationSet& set, std::vector<double> times,
              const std::function<PoseInstruction(std::size_t)>& poseAt, std::vector<std::size_t> joints = {});

    const std::vector<double>& times() const { return _times; }
    /// The samples at which the joint is on the ground: it is in the lowest fifth of its way, and moves about as the
    /// ground does. A joint that never lifts is always on it. index: of the joints.
    Contacts contactsOf(std::size_t index) const;
    /// Joints that end a limb, come close to the lowest place of all and leave it again.
    std::vector<std::size_t> feet() const;
    /// The speed of the ground below the joints in units a second: their mean speed while they are on the ground,
    /// without moments far from the median. 0: none of them is on the ground, or they stand.
    double groundSpeed(const std::vector<std::size_t>& joints) const;

private:
    double lift(const Path& path) const;
    glm::dvec3 velocity(const Path& path, std::size_t sample) const;
    std::vector<bool> samplesOnGround(const Path& path) const;
    bool isRound(const Path& path) const;

    const AnimationSet& _set;
    std::vector<double> _times;
    std::vector<Path> _paths; ///< by index in the joints; each has as many places as there are times
    double _height = 0.0;     ///< of the skeleton in the first sample
};

} // namespace osgGpuAnimation
