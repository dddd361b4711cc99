// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/math/Result.h>
#include <osgGpuAnimation/nodes/GroundLeg.h>

#include <osg/Callback>
#include <osg/Node>
#include <osg/observer_ptr>

#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

/// Keeps the feet of its AnimatedCharacter on the scene below: on slopes, stairs and uneven ground.
///
///     auto set = fox->getAnimationSet().withConstraints({TwoBoneIk{"left", "thigh.l", "shank.l", "foot.l"}, …});
///     fox->setAnimationSet(set.value());
///     osg::ref_ptr<GroundFeet> feet = new GroundFeet(*scene);
///     if (succeeded(feet->setLegs(fox->getAnimationSet(), {{"left", "toes.l"}, {"right", "toes.r"}})))
///         fox->addUpdateCallback(feet);
///
/// After each update of the character it samples the feet of the clips and the ground below them (world space, +Z up),
/// and sets the targets of the legs: each foot has the height above the ground, and the angle to it, that it has above
/// the sole's plane in the clips. A foot that the clips plant keeps its place in the world until they lift it; the
/// ground's height and angle, and the place of a lifted foot, change within blendSeconds. A foot is ready for a higher
/// ground, such as a stair, when it comes down.
///
/// **It sets the height of the character's matrix**: the lowest foot reaches its ground, and the hips sink no further.
/// The application and root motion move the character in x and y; add this callback after theirs. At the first update,
/// after reset(), a jump of the time, and after a move by more than a leg, the character starts on the ground nearest
/// to its matrix. Where there is no ground within reach of any foot the height stays, and the feet are those of the
/// clips.
///
/// Characters may share a GroundFeet; each has a state of its own. Characters whose set does not have the legs stay as
/// they are, with a warning.
class GroundFeet : public osg::NodeCallback
{
public:
    /// The ground is the whole scene above the character.
    GroundFeet();
    /// ground: held weakly, see setGround().
    explicit GroundFeet(osg::Node& ground);
    /// Copies the settings; the copy starts anew.
    GroundFeet(const GroundFeet& other, const osg::CopyOp& copyop);
    META_Object(osgGpuAnimation, GroundFeet)

    /// Sets the node that is the ground, with everything below it except characters and crowds. It is held weakly:
    /// after its end there is no ground. Feet follow a ground that moves if the node itself, or one above it, moves.
    /// Scene files keep its name. Null (the default): the whole scene.
    void setGround(osg::Node* ground);
    osg::ref_ptr<osg::Node> getGround() const; ///< see setGround(); null after its end
    /// Selects the first node of this name in the character's scene as ground. Each frame looks it up until it is
    /// there, and again after its end; without such a node there is no ground. Empty: the whole scene.
    void setGroundName(const std::string& name);
    /// The name of setGroundName(), else of the ground (after its end: at setGround()); empty: the whole scene, or a
    /// ground without a name.
    std::string getGroundName() const;
    /// Nodes are ground if (node mask & mask) is not 0, as in any traversal. Default: all.
    void setTraversalMask(osg::Node::NodeMask mask) { _traversalMask = mask; }
    osg::Node::NodeMask getTraversalMask() const { return _traversalMask; } ///< see setTraversalMask()

    /// Replaces all legs. Errors, without a change: a constraint that the set has not, or that is a look-at; a toe that
    /// is not below the ankle; those of the next function. The message names the leg.
    Result<void> setLegs(const AnimationSet& set, std::vector<GroundLeg> legs);
    /// The same without a set, for scene files: each character's set is checked at its first update. Errors, without a
    /// change: two legs with one constraint; a sole that is not finite; one of the two markers alone.
    Result<void> setLegs(std::vector<GroundLeg> legs);
    const std::vector<GroundLeg>& getLegs() const { return _legs; } ///< see setLegs()

    // The following setters return false, without a change, if a number is out of range or NaN.

    /// Sets the largest height of the ground below a foot above or below the mean ground of all feet, in lengths of the
    /// leg. Ground beyond it does not count. reach: above 0, finite. Default: 0.6.
    bool setReach(double reach);
    double getReach() const { return _reach; } ///< see setReach()
    /// Sets the largest angle by which the ground turns a foot, in radians in [0, pi / 2]. Default: 0.7.
    bool setMaxTilt(double radians);
    double getMaxTilt() const { return _maxTilt; } ///< see setMaxTilt()
    /// Sets the distance from its place in the clips at which a planted foot loses its place in the world, in lengths
    /// of the leg: at least 0, finite. 0: feet never keep their places. Default: 0.3.
    bool setLockDistance(double distance);
    double getLockDistance() const { return _lockDistance; } ///< see setLockDistance()
    /// Sets the share of the ground in the pose and in the character's height, in [0, 1], for example 0 in a jump. The
    /// rest of the height is the one that the application has given the matrix. At 0 the height stays; above 0 after 0
    /// the character starts anew. Default: 1.
    bool setWeight(double weight);
    double getWeight() const { return _weight; } ///< see setWeight()
    /// Stops for characters that no camera has drawn within this distance in the last frame: nothing is sampled, the
    /// legs have no targets and the height stays. Distances are measured by the callback as a cull callback, so add it
    /// as one, too:
    ///
    ///     feet->setMaxDistance(30.0);
    ///     fox->addCullCallback(feet);
    ///
    /// distance: from the eye to the character's origin, in world units, at least 0. Default: infinity, no cull
    /// callback needed.
    bool setMaxDistance(double distance);
    double getMaxDistance() const { return _maxDistance; } ///< see setMaxDistance()

    /// All characters start anew at the next update, for example after they were moved to another floor.
    void reset();

    /// During update: sets the targets of the legs and the character's height. During cull: measures the distance. Then
    /// continues the traversal.
    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override;

protected:
    ~GroundFeet() override;

private:
    class States;

    osg::ref_ptr<osg::Node> groundIn(osg::Node& scene, unsigned int frame);

    osg::observer_ptr<osg::Node> _ground;
    bool _isWholeScene = true;
    std::string _groundName;                               ///< of setGroundName()
    std::string _nodeName;                                 ///< of the node of setGround() at that time
    bool _hasWarned = false;                               ///< there was no node of this name
    std::pair<const osg::Node*, unsigned int> _lastSearch; ///< without success: the scene and the frame
    osg::Node::NodeMask _traversalMask = ~0u;
    std::vector<GroundLeg> _legs;
    double _reach = 0.6, _maxTilt = 0.7, _lockDistance = 0.3, _weight = 1.0;
    double _maxDistance = std::numeric_limits<double>::infinity();
    std::unique_ptr<States> _states; ///< one per character
};

} // namespace osgGpuAnimation
