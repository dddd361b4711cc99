// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/constraints/ConstraintGoals.h>

#include <osgGpuAnimation/animation/constraints/AxisTurns.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

namespace
{

/// The target as far as the turn speed allows, seen from the offset at rest.
glm::vec3 turnedTowards(const ConstraintChain& chain, const ConstraintGoal& goal, double maxAngle)
{
    using namespace AxisTurns;
    const glm::dvec3 wanted = glm::dvec3(goal.target.position) - chain.restEye;
    const glm::dvec3 to = direction(wanted, chain.restForward);
    const glm::dvec3 from =
        goal.shown ? direction(glm::dvec3(*goal.shown) - chain.restEye, chain.restForward) : chain.restForward;
    const double angle = std::atan2(glm::length(glm::cross(from, to)), glm::dot(from, to));
    if (angle <= maxAngle) return goal.target.position;
    const glm::dvec3 side = across(chain.restUp, from);
    const glm::dvec3 halfTurn = logarithm(shortest(from, to, glm::dot(side, side) > 0.5 ? side : anyAcross(from)));
    const glm::dvec3 line = exponential(halfTurn * (maxAngle / angle)) * from;
    return glm::vec3(chain.restEye + line * glm::length(wanted));
}

} // namespace

bool ConstraintGoal::isDefault() const
{
    const ConstraintGoal unset;
    return !hasTarget && target.weight == unset.target.weight && target.pole == unset.target.pole &&
           target.twist == unset.target.twist && target.rotation == unset.target.rotation;
}

bool ConstraintGoals::isDefault() const
{
    return std::all_of(_goals.begin(), _goals.end(), [](const ConstraintGoal& goal) { return goal.isDefault(); });
}

void ConstraintGoals::advance(const std::vector<ConstraintChain>& chains, double seconds)
{
    for (std::size_t c = 0; c < chains.size(); ++c)
        if (chains[c].turnSpeed > 0.0 && _goals[c].hasTarget)
            _goals[c].shown = turnedTowards(chains[c], _goals[c], chains[c].turnSpeed * std::abs(seconds));
}

void ConstraintGoals::write(std::vector<ConstraintTarget>& outTargets) const
{
    outTargets.clear();
    const auto hasEffect = [](const ConstraintGoal& goal) { return goal.hasTarget && goal.target.weight > 0.0f; };
    if (std::none_of(_goals.begin(), _goals.end(), hasEffect)) return;
    for (const ConstraintGoal& goal : _goals)
    {
        outTargets.push_back(goal.target);
        if (goal.shown) outTargets.back().position = *goal.shown;
        if (!goal.hasTarget) outTargets.back() = ConstraintTarget();
    }
}

} // namespace osgGpuAnimation
