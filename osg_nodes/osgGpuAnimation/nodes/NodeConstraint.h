// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/Result.h>

#include <osg/Matrixd>
#include <osg/Node>
#include <osg/Quat>
#include <osg/Vec3d>

#include <cstdint>
#include <optional>
#include <string>

namespace osgGpuAnimation
{

class AnimationController;
class WorldTargets;

/// A constraint of an AnimatedCharacter or of an instance of an AnimatedCrowd, in OSG's types. A handle is used at once
/// and not kept:
///
///     fox->constraint("look").setTarget(osg::Vec3d(0, -3, 1));
///     fox->constraint("look").follow(bird);
///
/// Positions, directions and rotations are in the character's own space, of an instance in the space of its placement
/// (OSG: +Z up), unless the function says otherwise. All functions return an error, without a change, if there is no
/// such constraint or instance, or a number is not finite. See ConstraintHandle for the limits.
class NodeConstraint
{
public:
    /// Gives the constraint a target that moves with the character (of an instance: not with its placement).
    Result<void> setTarget(const osg::Vec3d& position);
    /// Gives it a target in world space. Its place relative to the character is computed at the end of every update
    /// traversal; without a viewer by AnimatedCharacter::update().
    Result<void> setWorldTarget(const osg::Vec3d& position);
    /// Gives it a node as target, or a position in the node's space. The node is held weakly: after its end the last
    /// target remains. The target is the node's place at the end of the update traversal, so a node that an update
    /// callback moves is followed in the same frame; what moves later (a camera by its manipulator) is followed one
    /// frame later. Of several places of a node the first counts.
    /// rotation: a limb's end joint has this rotation in the node's space, as a hand that holds a handle; osg::Quat()
    /// for that of the node itself. None: the end joint keeps the rotation of setRotation() or of the clips.
    /// Errors: node is null; a rotation for a look-at.
    Result<void> follow(osg::Node* node, const osg::Vec3d& position = osg::Vec3d(),
                        const std::optional<osg::Quat>& rotation = std::nullopt);
    Result<void> setWeight(float weight); ///< See ConstraintHandle::setWeight().
    /// See ConstraintHandle::setPole().
    Result<void> setPole(const osg::Vec3d& direction);
    Result<void> setTwist(double radians); ///< See ConstraintHandle::setTwist().
    /// Sets the rotation of the limb's end joint; see ConstraintHandle::setRotation(). Replaces that of follow().
    Result<void> setRotation(const osg::Quat& rotation);
    Result<void> clear(); ///< See ConstraintHandle::clear(). Ends setWorldTarget() and follow().

    // Answers of the present pose, see ConstraintHandle: after an update traversal those of the frame that is drawn.
    // An update callback meets the world target or followed node of the frame before.

    /// How far a limb's end joint is from its target, in the units of the space above (metres, as a rule; a scale of
    /// the character's own matrix and of nodes above it does not count); of a look-at, in radians. Further error: there
    /// is no target.
    Result<double> getDistance() const;
    Result<double> getReach() const; ///< The length of the limb in those units; of a look-at its cone, in radians.
    bool isReached() const;          ///< See ConstraintHandle::isReached().

private:
    friend class AnimatedCharacter;
    friend class AnimatedCrowd;
    NodeConstraint(AnimationController* controller, const std::string& name, const osg::Matrixd& fileToSpace,
                   const osg::Matrixd& spaceToWorld, WorldTargets& worldTargets, std::uint64_t instance);
    /// node: null: the place is in world space.
    Result<void> keep(osg::Node* node, const osg::Vec3d& position, const std::optional<osg::Quat>& rotation);

    AnimationController* _controller; ///< null: there is no such instance
    std::string _name;
    osg::Matrixd _fileToSpace;
    osg::Matrixd _spaceToWorld;
    WorldTargets* _worldTargets;
    std::uint64_t _instance;
};

} // namespace osgGpuAnimation
