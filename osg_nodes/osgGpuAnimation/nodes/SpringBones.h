// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/math/Result.h>

#include <osg/Callback>
#include <osg/Vec3>

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// One joint of a spring chain. Lengths are in the units of the set's file; a scale of the character scales them.
struct SpringJoint
{
    std::string joint;      ///< its name
    float stiffness = 1.0f; ///< how strongly it returns to its rest rotation: length per second, at least 0
    float drag = 0.4f;      ///< the share of its speed that it loses per substep, in [0, 1]
    float gravity = 0.0f;   ///< length per second
    osg::Vec3 gravityDirection{0, 0, -1}; ///< in world space, of length 1
    float radius = 0.0f;                  ///< of the sphere round the next joint that hits colliders, at least 0
};

/// A sphere or capsule that spring joints do not enter.
struct SpringCollider
{
    std::string joint;             ///< the name of the joint that carries it
    osg::Vec3 center;              ///< in the joint's space
    std::optional<osg::Vec3> tail; ///< the other end of a capsule, in the joint's space; empty: a sphere
    float radius = 0.0f;           ///< in the units of the set's file, at least 0
};

/// A tail, a lock of hair or the hem of a coat.
struct SpringChain
{
    /// From the root to the tip, each a descendant of the one before it. The last joint only gives the length of the
    /// one before it and does not turn.
    std::vector<SpringJoint> joints;
    std::vector<std::size_t> colliders; ///< indices of the colliders that the chain hits
};

/// Lets chains of joints of its AnimatedCharacter swing: they follow the character's motion with inertia, return to
/// their rest rotations, hang by gravity and avoid colliders (the algorithm of VRMC_springBone 1.0).
///
///     osg::ref_ptr<SpringBones> springs = new SpringBones;
///     if (succeeded(springs->setChains(fox->getAnimationSet(), {{{{"Tail1"}, {"Tail2"}, {"Tail3"}}, {}}})))
///         fox->addUpdateCallback(springs);
///
/// After each update of the character it writes the joints' rotations to the pose of one layer, which belongs to it. It
/// integrates in substeps at fixed times and takes the pose of the clips at each of them, so that equal times show
/// equal poses at any frame rate. Jumps of the time, and seek() on a layer, reset the chains to rest.
///
/// Characters may share a SpringBones; each has a state of its own.
class SpringBones : public osg::NodeCallback
{
public:
    static constexpr double substep = 1.0 / 60.0; ///< seconds
    static constexpr double longestStep = 1.0;    ///< seconds; a longer step of the time resets the chains
    static constexpr double seekSeconds = 0.1;    ///< a clip that has jumped by more resets the chains

    SpringBones();
    /// Copies the settings; the copy starts with all chains at rest.
    SpringBones(const SpringBones& other, const osg::CopyOp& copyop);
    META_Object(osgGpuAnimation, SpringBones)

    /// Replaces all chains. Errors, without a change: a joint that the set has not; a joint that is no descendant of
    /// the one before it, or has the same place; a joint in two chains; those of the next function. The message names
    /// the chain and the joint.
    Result<void> setChains(const AnimationSet& set, std::vector<SpringChain> chains,
                           std::vector<SpringCollider> colliders = {});
    /// The same without a set, for scene files: each character's set is checked at its first update, and a character
    /// whose set does not fit stays as it is, with a warning. Errors, without a change: a chain of less than two
    /// joints; a collider that does not exist; a value out of range or not finite.
    Result<void> setChains(std::vector<SpringChain> chains, std::vector<SpringCollider> colliders = {});
    const std::vector<SpringChain>& getChains() const { return _chains; }          ///< see setChains()
    const std::vector<SpringCollider>& getColliders() const { return _colliders; } ///< see setChains()

    /// Selects the layer that shows the pose. layer: clamped to maxLayers - 1. Default: maxLayers - 1, the top.
    void setLayer(std::size_t layer);
    std::size_t getLayer() const { return _layer; } ///< see setLayer()

    /// Stops the chains of characters that no camera has drawn within this distance in the last frame: they fade to the
    /// pose of the clips. Distances are measured by the callback as a cull callback, so add it as one, too:
    ///
    ///     springs->setMaxDistance(30.0);
    ///     fox->addCullCallback(springs);
    ///
    /// distance: from the eye to the character's origin, in world units. Default: infinity, no cull callback needed.
    void setMaxDistance(double distance) { _maxDistance = distance; }
    double getMaxDistance() const { return _maxDistance; } ///< see setMaxDistance()

    /// Puts all chains to rest at the next update, for example after a character was moved to another place.
    void reset();

    /// During update: moves the chains to the simulation time. During cull: measures the distance. Then continues the
    /// traversal.
    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override;

protected:
    ~SpringBones() override;

private:
    class States;

    std::vector<SpringChain> _chains;
    std::vector<SpringCollider> _colliders;
    std::size_t _layer;
    double _maxDistance = std::numeric_limits<double>::infinity();
    std::unique_ptr<States> _states; ///< one per character
};

} // namespace osgGpuAnimation
