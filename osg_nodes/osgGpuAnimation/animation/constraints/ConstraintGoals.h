// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/constraints/ConstraintChain.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace osgGpuAnimation
{

/// The application's settings of one constraint of one character.
struct ConstraintGoal
{
    ConstraintTarget target{{}, 1.0f, {}, 0.0f, {}}; ///< the weight is the application's
    bool hasTarget = false;                          ///< false: no effect
    std::optional<glm::vec3> shown;                  ///< of a look-at with a turn speed: the target so far

    bool isDefault() const; ///< true if nothing was set since the last clear
};

/// The goals of one character, one per constraint of its set.
class ConstraintGoals
{
public:
    explicit ConstraintGoals(std::size_t count) : _goals(count) {}

    /// For a change: the pose instruction is then out of date.
    ConstraintGoal& goal(std::size_t constraint)
    {
        ++_changeCount;
        return _goals[constraint];
    }
    const ConstraintGoal& goal(std::size_t constraint) const { return _goals[constraint]; }
    bool isDefault() const; ///< true if all goals are

    std::uint64_t changeCount() const { return _changeCount; } ///< calls of goal() for a change

    /// Turns the lines to the targets by at most the turn speeds. seconds: finite; negative counts as positive.
    void advance(const std::vector<ConstraintChain>& chains, double seconds);
    /// The targets of a pose instruction; none if no constraint has an effect.
    void write(std::vector<ConstraintTarget>& outTargets) const;

private:
    std::vector<ConstraintGoal> _goals;
    std::uint64_t _changeCount = 0;
};

} // namespace osgGpuAnimation
