// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/math/Result.h>
#include <osgGpuAnimation/nodes/SpringChain.h>

#include <osg/Callback>

#include <limits>
#include <memory>
#include <vector>

namespace osgGpuAnimation
{

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
