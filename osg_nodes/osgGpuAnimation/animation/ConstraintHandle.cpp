// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/ConstraintHandle.h>

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/constraints/AxisTurns.h>
#include <osgGpuAnimation/animation/constraints/ConstraintGoals.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/math/Rotation.h>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace osgGpuAnimation
{

namespace
{

/// True if the number is finite and small enough for the squares of shaders.
bool isNear(float number)
{
    return std::abs(number) <= ConstraintHandle::maxCoordinate;
}

/// The fault of a vector of a constraint; empty: there is none.
std::string faultOf(const char* what, const glm::vec3& v)
{
    if (isNear(v.x) && isNear(v.y) && isNear(v.z)) return {};
    return std::string(what) + " (" + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " + std::to_string(v.z) +
           "), in the file's axes, is not finite or beyond 1e12";
}

} // namespace

ConstraintHandle::ConstraintHandle(const AnimationSet& set, std::unique_ptr<ConstraintGoals>& goals,
                                   const std::string& name, Instruction instruction)
    : _set(&set), _goals(&goals), _index(set.constraintNamed(name)), _instruction(std::move(instruction))
{
}

/// fault: empty if the change is allowed.
template <typename Change>
Result<void> ConstraintHandle::change(const std::string& fault, Change change)
{
    if (!_index) return _index.error();
    const std::vector<ConstraintChain>& chains = _set->constraintChains();
    if (!fault.empty()) return Error{"constraint \"" + chain().name + "\": " + fault};
    if (!*_goals) *_goals = std::make_unique<ConstraintGoals>(chains.size());
    change((*_goals)->goal(_index.value()));
    if (chain().turnSpeed > 0.0) (*_goals)->advance(chains, 0.0);
    return {};
}

Result<void> ConstraintHandle::setTarget(const glm::vec3& position)
{
    return change(faultOf("its target", position),
                  [&](ConstraintGoal& goal)
                  {
                      goal.target.position = position;
                      goal.hasTarget = true;
                  });
}

Result<void> ConstraintHandle::setWeight(float weight)
{
    return change(std::isnan(weight) ? "its weight is nan" : "",
                  [&](ConstraintGoal& goal) { goal.target.weight = std::min(std::max(weight, 0.0f), 1.0f); });
}

Result<void> ConstraintHandle::setPole(const glm::vec3& direction)
{
    const glm::dvec3 unit = AxisTurns::direction(glm::dvec3(direction), glm::dvec3(0.0));
    return change(faultOf("its pole", direction), [&](ConstraintGoal& goal) { goal.target.pole = glm::vec3(unit); });
}

Result<void> ConstraintHandle::setTwist(float radians)
{
    // The nearest equal angle: shaders compute sines of small angles only.
    const auto angle = [&] { return std::remainder(static_cast<double>(radians), glm::two_pi<double>()); };
    return change(std::isfinite(radians) ? "" : "its twist is " + std::to_string(radians) + ", not finite",
                  [&](ConstraintGoal& goal) { goal.target.twist = static_cast<float>(angle()); });
}

Result<void> ConstraintHandle::setRotation(const glm::vec4& rotation)
{
    std::string fault;
    if (_index && chain().isLookAt)
        fault = "a look-at has no target rotation";
    else if (!isNear(rotation.x) || !isNear(rotation.y) || !isNear(rotation.z) || !isNear(rotation.w))
        fault = "its rotation (" + std::to_string(rotation.x) + ", " + std::to_string(rotation.y) + ", " +
                std::to_string(rotation.z) + ", " + std::to_string(rotation.w) + ") is not finite or beyond 1e12";
    return change(fault,
                  [&](ConstraintGoal& goal)
                  {
                      const bool isNone = rotation == glm::vec4(0.0f);
                      goal.target.rotation = isNone ? rotation : glm::vec4(Rotation::unit(glm::dvec4(rotation)));
                  });
}

Result<void> ConstraintHandle::clear()
{
    return change("", [](ConstraintGoal& goal) { goal = ConstraintGoal(); });
}

const ConstraintGoal* ConstraintHandle::find() const
{
    const std::unique_ptr<ConstraintGoals>& goals = *_goals;
    return _index && goals ? &std::as_const(*goals).goal(_index.value()) : nullptr;
}

ConstraintTarget ConstraintHandle::target() const
{
    const ConstraintGoal* goal = find();
    return goal ? goal->target : ConstraintGoal().target;
}

bool ConstraintHandle::hasTarget() const
{
    const ConstraintGoal* goal = find();
    return goal && goal->hasTarget;
}

glm::vec3 ConstraintHandle::shownTarget() const
{
    const ConstraintGoal* goal = find();
    return goal && goal->shown ? *goal->shown : target().position;
}

Result<void> ConstraintHandle::setShownTarget(const glm::vec3& position)
{
    return change(faultOf("its shown target", position),
                  [&](ConstraintGoal& goal)
                  {
                      if (chain().turnSpeed > 0.0) goal.shown = position;
                  });
}

const ConstraintChain& ConstraintHandle::chain() const
{
    return _set->constraintChains()[_index.value()];
}

glm::dmat4 ConstraintHandle::jointToModel(std::size_t place) const
{
    const auto joint = static_cast<std::size_t>(chain().joints[place]);
    return Pose::jointToModel(*_set, _instruction(), joint).toColumns();
}

Result<double> ConstraintHandle::distance(const glm::dmat3& toSpace) const
{
    if (!_index) return _index.error();
    if (!hasTarget()) return Error{"constraint \"" + chain().name + "\" has no target"};
    const glm::dmat4 end = jointToModel(chain().joints.size() - 1);
    const glm::dvec3 from(end * glm::dvec4(chain().offset, 1.0));
    const glm::dvec3 line = toSpace * (glm::dvec3(target().position) - from);
    if (!chain().isLookAt) return glm::length(line);
    const glm::dvec3 forward = toSpace * glm::dmat3(end) * chain().forward;
    return std::atan2(glm::length(glm::cross(forward, line)), glm::dot(forward, line));
}

Result<double> ConstraintHandle::reach(const glm::dmat3& toSpace) const
{
    if (!_index) return _index.error();
    if (chain().isLookAt) return chain().cone;
    const glm::dvec3 start(jointToModel(0)[3]), mid(jointToModel(chain().mid)[3]),
        end(jointToModel(chain().joints.size() - 1)[3]);
    return glm::length(toSpace * (mid - start)) + glm::length(toSpace * (end - mid));
}

bool ConstraintHandle::isReached() const
{
    constexpr double tolerance = 0.001;
    const Result<double> left = distance();
    return left && left.value() <= tolerance * (chain().isLookAt ? 1.0 : reach().value());
}

} // namespace osgGpuAnimation
