// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Constraint.h>
#include <osgGpuAnimation/math/Result.h>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

namespace osgGpuAnimation
{

struct ConstraintChain;
struct ConstraintGoal;
class AnimationSet;
class ConstraintGoals;
struct PoseInstruction;

/// A constraint of one controller, see AnimationSet::withConstraints(). A handle is used at once and not kept:
///
///     controller.constraint("look").setTarget({0.0f, 1.6f, 3.0f});
///     controller.constraint("left foot").setWeight(0.5f);
///
/// Positions, directions and rotations are in model space, in the axes of the set's file. Changes take effect at once.
/// All functions return an error, without a change, if the set has no constraint of that name or a number is not
/// finite.
class ConstraintHandle
{
public:
    static constexpr float maxCoordinate = 1e12f; ///< of each coordinate of a target

    /// Gives the constraint a target; without one it has no effect. With a turn speed the target is reached over the
    /// next advance() calls. Further error: a coordinate is beyond maxCoordinate.
    Result<void> setTarget(const glm::vec3& position);
    /// Sets the share of the constraint, clamped to [0, 1]. The default is 1.
    Result<void> setWeight(float weight);
    /// Sets the direction of the up axis or of the limb's mid joint, see ConstraintTarget::pole. 0: none.
    Result<void> setPole(const glm::vec3& direction);
    /// Sets a further turn about the line to the target, in radians.
    Result<void> setTwist(float radians);
    /// Sets the rotation of the limb's end joint: a quaternion x, y, z, w of any length, or 0 for none. Further error:
    /// the constraint is a look-at.
    Result<void> setRotation(const glm::vec4& rotation);
    /// Removes the target and restores the defaults: the clips alone move the chain.
    Result<void> clear();

    /// What was set; its weight is the application's, whether or not there is a target. Defaults without such a
    /// constraint.
    ConstraintTarget target() const;
    bool hasTarget() const; ///< true between setTarget() and clear()
    /// The target that the chain shows now: behind target() while a turn speed limits it.
    glm::vec3 shownTarget() const;
    /// Sets the target that the chain shows now, for a stored controller. Has no effect without a turn speed. Errors:
    /// those of setTarget().
    Result<void> setShownTarget(const glm::vec3& position);

    // Answers of the present pose, computed by the CPU twin at each call: constraints that nobody asks cost nothing.

    /// How far the chain is from target(). A limb: from its end joint to the target, in the file's units. A look-at:
    /// radians between its forward axis and the line to the target. toSpace: the linear part of a transform from model
    /// space; the units are then those of its result. Further error: there is no target.
    Result<double> distance(const glm::dmat3& toSpace = glm::dmat3(1.0)) const;
    /// How far the chain can reach. A limb: the length of its two bones, from the start joint, in the file's units. A
    /// look-at: its cone, radians from where the clips look. toSpace: as for distance().
    Result<double> reach(const glm::dmat3& toSpace = glm::dmat3(1.0)) const;
    /// True if distance() is at most a thousandth: of a limb's reach(), of a radian. False without a constraint of that
    /// name or without a target.
    bool isReached() const;

private:
    friend class AnimationController;
    using Instruction = std::function<const PoseInstruction&()>; ///< the controller's present one

    /// goals: of the controller; made at the first change.
    ConstraintHandle(const AnimationSet& set, std::unique_ptr<ConstraintGoals>& goals, const std::string& name,
                     Instruction instruction);
    template <typename Change>
    Result<void> change(const std::string& fault, Change change);
    const ConstraintGoal* find() const; ///< null: nothing was set
    const ConstraintChain& chain() const;
    glm::dmat4 jointToModel(std::size_t place) const; ///< place: in the chain

    const AnimationSet* _set;
    std::unique_ptr<ConstraintGoals>* _goals;
    Result<std::size_t> _index;
    Instruction _instruction;
};

} // namespace osgGpuAnimation
