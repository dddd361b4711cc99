// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/constraints/ConstraintChain.h>

#include <osgGpuAnimation/animation/constraints/AxisTurns.h>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace osgGpuAnimation
{

namespace
{

bool isFinite(const glm::vec3& v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool isWithin(float value, float low, float high)
{
    return value >= low && value <= high; // false for NaN
}

/// The transform of a joint at rest, from joint space to that of an ancestor, or to model space: -1.
glm::dmat4 restMatrix(const Skeleton& skeleton, int joint, int ancestor)
{
    glm::dmat4 matrix(1.0);
    for (; joint != ancestor; joint = skeleton.joint(joint).parent)
        matrix = skeleton.joint(joint).rest.toMatrix().toColumns() * matrix;
    return matrix;
}

/// The joints from the first to the last named one, with those between. outPlaces: the place of each named joint.
Result<std::vector<int>> chainOf(const Skeleton& skeleton, const std::vector<std::string>& names,
                                 std::vector<std::size_t>& outPlaces)
{
    if (names.empty()) return Error{"it names no joint"};
    std::vector<int> named;
    for (const std::string& name : names)
    {
        const Result<std::size_t> joint = skeleton.jointNamed(name);
        if (!joint) return joint.error();
        named.push_back(static_cast<int>(joint.value()));
    }
    std::vector<int> chain;
    for (int joint = named.back(); joint >= 0 && (chain.empty() || chain.back() != named.front());
         joint = skeleton.joint(joint).parent)
        chain.push_back(joint);
    std::reverse(chain.begin(), chain.end());
    std::size_t place = 0;
    for (std::size_t i = 0; i < named.size(); ++i)
    {
        const auto found = std::find(chain.begin() + place, chain.end(), named[i]);
        if (found == chain.end() || chain.front() != named.front())
            return Error{"joint \"" + names[i == 0 ? names.size() - 1 : i] + "\" is no descendant of joint \"" +
                         names[i == 0 ? 0 : i - 1] + "\""};
        outPlaces.push_back(static_cast<std::size_t>(found - chain.begin()));
        place = outPlaces.back() + 1;
    }
    if (chain.size() > ConstraintChain::maxJoints)
        return Error{"its chain has " + std::to_string(chain.size()) + " joints from \"" + names.front() + "\" to \"" +
                     names.back() + "\", at most " + std::to_string(ConstraintChain::maxJoints)};
    return chain;
}

std::optional<Error> findFault(const LookAt& look)
{
    if (!look.shares.empty() && look.shares.size() != look.joints.size())
        return Error{std::to_string(look.shares.size()) + " shares for " + std::to_string(look.joints.size()) +
                     " joints"};
    for (std::size_t i = 0; i < look.shares.size(); ++i)
        if (!std::isfinite(look.shares[i]) || look.shares[i] < 0.0f)
            return Error{"its share " + std::to_string(i) + " is " + std::to_string(look.shares[i]) +
                         ", not at least 0 and finite"};
    if (!look.shares.empty() && std::all_of(look.shares.begin(), look.shares.end(), [](float s) { return s == 0.0f; }))
        return Error{"its shares are all 0"};
    if (!isFinite(look.forward) || !isFinite(look.up) || !isFinite(look.offset))
        return Error{"an axis or the offset is not finite"};
    const glm::dvec3 none(0.0), forward = AxisTurns::direction(glm::dvec3(look.forward), none);
    if (forward == none) return Error{"its forward axis is 0"};
    if (AxisTurns::across(glm::dvec3(look.up), forward) == none)
        return Error{"its up axis is 0 or parallel to its forward axis"};
    if (!isWithin(look.cone, 0.0f, 3.15f))
        return Error{"its cone is " + std::to_string(look.cone) + ", not in [0, pi]"};
    if (!std::isfinite(look.turnSpeed) || look.turnSpeed < 0.0f)
        return Error{"its turn speed is " + std::to_string(look.turnSpeed) + ", not at least 0 and finite"};
    return std::nullopt;
}

Result<ConstraintChain> resolved(const Skeleton& skeleton, const LookAt& look)
{
    if (auto fault = findFault(look)) return *fault;
    ConstraintChain chain;
    std::vector<std::size_t> places;
    Result<std::vector<int>> joints = chainOf(skeleton, look.joints, places);
    if (!joints) return joints.error();
    chain.joints = joints.value();
    chain.shares.assign(chain.joints.size(), 0.0);
    double sum = 0.0;
    for (std::size_t i = 0; i < places.size(); ++i)
        sum += chain.shares[places[i]] = look.shares.empty() ? 1.0 : static_cast<double>(look.shares[i]);
    for (double& share : chain.shares)
        share /= sum;
    chain.forward = glm::normalize(glm::dvec3(look.forward));
    chain.up = glm::normalize(glm::dvec3(look.up));
    chain.offset = glm::dvec3(look.offset);
    chain.cone = std::min(static_cast<double>(look.cone), glm::pi<double>());
    chain.turnSpeed = static_cast<double>(look.turnSpeed);
    const glm::dmat4 rest = restMatrix(skeleton, chain.joints.back(), -1);
    chain.restEye = glm::dvec3(rest * glm::dvec4(chain.offset, 1.0));
    chain.restForward = AxisTurns::direction(glm::dmat3(rest) * chain.forward, chain.forward);
    chain.restUp = AxisTurns::direction(glm::dmat3(rest) * chain.up, chain.up);
    return chain;
}

Result<ConstraintChain> resolved(const Skeleton& skeleton, const TwoBoneIk& limb)
{
    if (!isFinite(limb.hinge)) return Error{"its hinge is not finite"};
    if (!isWithin(limb.softReach, 0.0f, 1.0f))
        return Error{"its soft reach is " + std::to_string(limb.softReach) + ", not in [0, 1]"};
    ConstraintChain chain;
    chain.isLookAt = false;
    std::vector<std::size_t> places;
    Result<std::vector<int>> joints = chainOf(skeleton, {limb.start, limb.mid, limb.end}, places);
    if (!joints) return joints.error();
    chain.joints = joints.value();
    chain.mid = places[1];
    chain.softReach = static_cast<double>(limb.softReach);

    // In the space of the limb's parent, where the constraint is solved: spaces above may mirror.
    const int parent = skeleton.joint(chain.joints.front()).parent;
    const auto rest = [&](std::size_t place) { return restMatrix(skeleton, chain.joints[place], parent); };
    const glm::dmat4 mid = rest(chain.mid);
    const glm::dvec3 start(rest(0)[3]), middle(mid[3]), end(rest(chain.joints.size() - 1)[3]), none(0.0);
    const glm::dvec3 upper = AxisTurns::direction(middle - start, none);
    const glm::dvec3 lower = AxisTurns::direction(end - middle, none);
    if (upper == none || lower == none) return Error{"one of its two bones has no length at rest"};
    // The bend turns the lower bone from the line of the upper one.
    const glm::dvec3 bend = glm::cross(upper, lower);
    if (limb.hinge == glm::vec3(0.0f) && glm::length(bend) < ConstraintChain::straightLimb)
        return Error{"it is straight at rest, so it needs a hinge"};
    const glm::dmat3 toParent(mid);
    chain.hinge = limb.hinge == glm::vec3(0.0f) ? AxisTurns::direction(glm::inverse(toParent) * bend, none)
                                                : glm::normalize(glm::dvec3(limb.hinge));
    if (chain.hinge == none) return Error{"its hinge has no direction in the space of the mid joint"};
    const glm::dvec3 hinge = AxisTurns::direction(toParent * chain.hinge, none); // 0: a scale of 0 flattens it
    if (hinge != none && AxisTurns::across(hinge, upper) == none)
        return Error{"its hinge is parallel to the upper bone at rest"};
    return chain;
}

} // namespace

Result<ConstraintChain> ConstraintChain::create(const Skeleton& skeleton, const Constraint& declaration)
{
    const auto nameOf = [](const auto& constraint) { return constraint.name; };
    const std::string name = std::visit(nameOf, declaration);
    Result<ConstraintChain> chain =
        std::visit([&](const auto& constraint) { return resolved(skeleton, constraint); }, declaration);
    if (!chain) return Error{"constraint \"" + name + "\": " + chain.error().message};
    ConstraintChain named = std::move(chain).value();
    named.name = name;
    return named;
}

} // namespace osgGpuAnimation
