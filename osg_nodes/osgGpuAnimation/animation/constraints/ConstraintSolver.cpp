// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/constraints/ConstraintSolver.h>

#include <osgGpuAnimation/animation/constraints/AxisTurns.h>
#include <osgGpuAnimation/math/Rotation.h>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>

// The space of all positions and axes is that of the parent of the chain's first joint, if no other is named.

namespace osgGpuAnimation
{

namespace
{

using namespace AxisTurns;

constexpr double smallestShare = 1e-5; ///< of a length: what is shorter counts as 0

struct Local
{
    glm::dvec3 translation;
    glm::dquat rotation;
    glm::dvec3 scale;

    glm::dmat4 matrix() const
    {
        glm::dmat4 m = glm::mat4_cast(rotation);
        for (int axis = 0; axis < 3; ++axis)
            m[axis] *= scale[axis];
        m[3] = glm::dvec4(translation, 1.0);
        return m;
    }
};

using Chain = std::vector<Local>;

/// The space of joint `end`'s parent: the product of the joints before it.
glm::dmat4 productOf(const Chain& chain, std::size_t end)
{
    glm::dmat4 m(1.0);
    for (std::size_t joint = 0; joint < end; ++joint)
        m *= chain[joint].matrix();
    return m;
}

bool hasInverse(const glm::dmat4& matrix)
{
    const double determinant = glm::determinant(glm::dmat3(matrix));
    return std::abs(determinant) > 1e-36 && std::isfinite(determinant);
}

glm::dvec3 position(const glm::dmat4& matrix)
{
    return glm::dvec3(matrix[3]);
}

/// The target in the space of the solver.
struct Goal
{
    glm::dvec3 position;
    glm::dvec3 pole; ///< 0: none
    double twist;
};

/// A direction within the cone around the forward axis.
glm::dvec3 limitedToCone(const glm::dvec3& wanted, const glm::dvec3& forward, const glm::dvec3& up, double cone)
{
    if (glm::dot(wanted, forward) >= std::cos(cone)) return wanted;
    glm::dvec3 side = across(wanted, forward);
    if (glm::dot(side, side) < 0.5) side = across(up, forward);
    if (glm::dot(side, side) < 0.5) side = anyAcross(forward);
    return forward * std::cos(cone) + side * std::sin(cone);
}

/// The factor of the shares of the joints before the last: beyond two thirds of a half turn they turn back, so that a
/// target may circle around the character without a jump.
double foldOf(double halfAngle)
{
    constexpr double pi = glm::pi<double>(), fold = pi / 3.0;
    return halfAngle > fold ? (pi - 2.0 * halfAngle) / halfAngle : 1.0;
}

/// Turns the joints before the last by their shares of a turn.
void share(const ConstraintChain& constraint, const glm::dquat& turn, Chain& chain)
{
    const glm::dvec3 halfTurn = logarithm(turn);
    const glm::dvec3 folded = halfTurn * foldOf(glm::length(halfTurn));
    glm::dquat parent(1, 0, 0, 0); // orientation of the joint's parent
    for (std::size_t joint = 0; joint + 1 < chain.size(); ++joint)
    {
        const glm::dquat part = exponential(folded * constraint.shares[joint]);
        chain[joint].rotation = glm::conjugate(parent) * part * parent * chain[joint].rotation;
        parent = parent * chain[joint].rotation;
    }
}

/// Turns the last joint so that the line from its offset along its forward axis meets the goal, which is in the space
/// of its parent. False: the goal is in the joint itself.
bool aim(const ConstraintChain& constraint, const Goal& goal, Local& joint)
{
    const glm::dvec3 line = goal.position - joint.translation;
    const double distance = glm::length(line);
    if (!(distance > smallestShare * (glm::length(goal.position) + glm::length(joint.translation)))) return false;
    // The forward line meets the sphere through the goal. It may miss it if the goal is nearer than the line.
    const glm::dvec3 forward = direction(joint.scale * constraint.forward, constraint.forward);
    const glm::dvec3 offset = joint.scale * constraint.offset;
    const double along = glm::dot(offset, forward);
    const double squared = distance * distance - glm::dot(offset, offset) + along * along;
    const glm::dvec3 met = offset + forward * (std::sqrt(std::max(squared, 0.0)) - along);
    const glm::dvec3 from = joint.rotation * direction(met, forward);
    const glm::dvec3 up = joint.rotation * direction(joint.scale * constraint.up, constraint.up);
    const glm::dvec3 to = line / distance;
    joint.rotation = exponential(to * (0.5 * goal.twist)) * framed(from, up, to, goal.pole) * joint.rotation;
    return true;
}

bool solveLookAt(const ConstraintChain& constraint, Goal goal, Chain& chain)
{
    const glm::dmat4 toParent = productOf(chain, chain.size());
    const glm::dmat3 linear(toParent);
    const glm::dvec3 eye(toParent * glm::dvec4(constraint.offset, 1.0));
    const glm::dvec3 forward = direction(linear * constraint.forward, constraint.forward);
    const glm::dvec3 up = direction(linear * constraint.up, constraint.up);
    const glm::dvec3 line = goal.position - eye;
    const double distance = glm::length(line);
    if (!(distance > smallestShare * (glm::length(goal.position) + glm::length(eye)))) return false;
    const glm::dvec3 wanted = limitedToCone(line / distance, forward, up, constraint.cone);
    goal.position = eye + wanted * distance;
    if (goal.pole == glm::dvec3(0.0)) goal.pole = up;
    if (chain.size() > 1)
    {
        share(constraint, framed(forward, up, wanted, goal.pole), chain);
        const glm::dmat4 parent = productOf(chain, chain.size() - 1);
        if (!hasInverse(parent)) return false;
        const glm::dmat4 inverse = glm::inverse(parent);
        goal.position = glm::dvec3(inverse * glm::dvec4(goal.position, 1.0));
        goal.pole = glm::dmat3(inverse) * goal.pole;
    }
    return aim(constraint, goal, chain.back());
}

/// The distance of the end joint from the start joint: at most the length of the limb.
double reachOf(double distance, double upper, double lower, double softReach)
{
    const double length = upper + lower;
    const double firm = softReach * length, soft = length - firm;
    if (distance > firm && soft > smallestShare * length)
    {
        const double part = 4.0 / ((distance - firm) / soft + 4.0);
        distance = firm + soft * (1.0 - part * part * part * part);
    }
    return std::min(std::max(distance, std::abs(upper - lower)), length);
}

bool solveTwoBone(const ConstraintChain& constraint, const Goal& goal, Chain& chain)
{
    const glm::dmat4 mid = productOf(chain, constraint.mid + 1), end = productOf(chain, chain.size());
    const glm::dvec3 start = chain.front().translation;
    const double upper = glm::distance(position(mid), start), lower = glm::distance(position(end), position(mid));
    const double length = upper + lower;
    if (!(std::min(upper, lower) > smallestShare * length)) return false;
    const glm::dvec3 first = (position(mid) - start) / upper, second = (position(end) - position(mid)) / lower;

    // The bend: about the normal of the limb's plane, on the side of the hinge.
    glm::dvec3 axis = across(glm::dmat3(mid) * constraint.hinge, first);
    if (glm::dot(axis, axis) < 0.5) axis = anyAcross(first);
    const glm::dvec3 normal = glm::cross(first, second);
    if (const double sine = glm::length(normal); sine > ConstraintChain::straightLimb)
        axis = normal * ((glm::dot(normal, axis) < 0.0 ? -1.0 : 1.0) / sine);
    const glm::dvec3 line = goal.position - start;
    const double distance = glm::length(line);
    const double reach = reachOf(distance, upper, lower, constraint.softReach);
    const double along = glm::dot(second, axis);
    const double twice = 2.0 * upper * lower;
    const double cosine = (reach * reach - upper * upper - lower * lower) / twice;
    const double difference = upper - lower;
    const double squared =
        (length * length - reach * reach) * (reach * reach - difference * difference) / (twice * twice);
    const glm::dvec2 bent = glm::normalize(glm::dvec2(cosine, std::sqrt(std::max(squared - along * along, 0.0))));
    const glm::dvec2 before = glm::normalize(glm::dvec2(glm::dot(first, second), glm::dot(normal, axis)));
    const glm::dquat bend = about(axis, bent.x * before.x + bent.y * before.y, bent.y * before.x - bent.x * before.y);

    // The start joint turns the end to the goal and the mid joint to the side of the pole.
    const glm::dvec3 chord = first * upper + bend * second * lower;
    const glm::dvec3 from = glm::length(chord) > smallestShare * length ? glm::normalize(chord) : first;
    const glm::dvec3 to = distance > smallestShare * length ? line / distance : from;
    const glm::dquat turn =
        goal.pole == glm::dvec3(0.0) ? shortest(from, to, axis) : framed(from, glm::cross(from, axis), to, goal.pole);

    glm::dquat parent(1, 0, 0, 0); // orientation of the mid joint's parent
    for (std::size_t joint = 0; joint < constraint.mid; ++joint)
        parent = parent * chain[joint].rotation;
    Local& bends = chain[constraint.mid];
    bends.rotation = glm::conjugate(parent) * bend * parent * bends.rotation;
    chain.front().rotation = exponential(to * (0.5 * goal.twist)) * turn * chain.front().rotation;
    return true;
}

/// Gives the end joint a rotation in model space.
void orient(const glm::dquat& rotation, const glm::dmat3& modelToParent, Chain& chain)
{
    const glm::dmat3 parent(productOf(chain, chain.size() - 1));
    if (!hasInverse(glm::dmat4(parent))) return;
    const glm::dmat3 toParent = glm::inverse(parent) * modelToParent;
    const glm::dvec3 x(1.0, 0.0, 0.0), y(0.0, 1.0, 0.0);
    chain.back().rotation =
        framed(x, y, direction(toParent * (rotation * x), x), direction(toParent * (rotation * y), y));
}

} // namespace

void solveConstraint(const ConstraintChain& constraint, const ConstraintTarget& target, const glm::dmat4& parentToModel,
                     std::vector<JointTransform>& joints)
{
    if (!(target.weight > 0.0f) || !hasInverse(parentToModel)) return;
    const glm::dmat4 modelToParent = glm::inverse(parentToModel);
    Chain chain;
    for (const JointTransform& joint : joints)
        chain.push_back(
            {glm::dvec3(joint.translation), Rotation::unitQuaternion(joint.rotation), glm::dvec3(joint.scale)});
    const Goal goal{glm::dvec3(modelToParent * glm::dvec4(glm::dvec3(target.position), 1.0)),
                    glm::dmat3(modelToParent) * glm::dvec3(target.pole), static_cast<double>(target.twist)};
    const bool isSolved =
        constraint.isLookAt ? solveLookAt(constraint, goal, chain) : solveTwoBone(constraint, goal, chain);
    if (!isSolved) return;
    if (!constraint.isLookAt && target.rotation != glm::vec4(0.0f))
        orient(Rotation::unitQuaternion(target.rotation), glm::dmat3(modelToParent), chain);
    const double weight = std::min(static_cast<double>(target.weight), 1.0);
    for (std::size_t joint = 0; joint < joints.size(); ++joint)
        joints[joint].rotation = glm::vec4(
            Rotation::slerp(glm::dvec4(joints[joint].rotation), Rotation::numbers(chain[joint].rotation), weight));
}

} // namespace osgGpuAnimation
