// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/feet/GroundedFoot.h>
#include <osgGpuAnimation/nodes/feet/PlantedTimes.h>

#include <osg/FrameStamp>
#include <osg/Node>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

// All places, directions and heights are in world space if no other is named.

/// A leg in one set.
struct Leg
{
    std::string constraint;
    std::size_t number; ///< of the constraint
    std::size_t hip, knee, ankle;
    std::size_t contact; ///< the toe, or the ankle
    double sole;         ///< in the character's own space
    double reach;        ///< share of the leg's length
    PlantedTimes planted;
};

/// The legs in one set, for all its characters.
struct Legs
{
    std::shared_ptr<const AnimationSet> set;
    std::vector<Leg> legs;
};

/// The settings of the callback, for all its characters.
struct FeetSettings
{
    osg::ref_ptr<osg::Node> ground; ///< null: none
    osg::Matrixd groundToWorld;
    osg::Node::NodeMask traversalMask;
    double reach, maxTilt, lockDistance, weight;
};

/// The feet of one character.
class FeetState
{
public:
    static constexpr double blendSeconds = 0.1; ///< until a change of the ground below a foot is followed completely
    static constexpr double maxStep = 1.0;      ///< seconds; a longer step of the time starts anew

    std::shared_ptr<const AnimationSet> set; ///< for which the legs were looked up
    std::shared_ptr<Legs> legs;              ///< null: the set does not have them

    void reset() { _time.reset(); }

    void stop(AnimatedCharacter& character);
    void update(AnimatedCharacter& character, const osg::NodePath& path, const osg::FrameStamp& stamp,
                const FeetSettings& settings, GroundProbe& probe);

private:
    /// Sets the length of the step and the character's place before it.
    void begin(const osg::Matrixd& given, double time, const FeetSettings& settings, GroundProbe& probe);
    /// The pose of the clips, without the targets of the legs.
    void takePose(const AnimatedCharacter& character, const osg::Matrixd& nodeToWorld);
    void standOnGround(const FeetSettings& settings, GroundProbe& probe);
    /// The character follows the slope and approaches the height at which its lowest foot stands.
    void moveHeight(const FeetSettings& settings);
    /// The part of the character's height that earlier updates have added; 0 if the application has changed it since.
    double addedHeight(const AnimatedCharacter& character, const osg::Matrixd& parentToWorld) const;
    /// rise: of the character's own height. step: of its present one.
    void place(AnimatedCharacter& character, const osg::Matrixd& parentToWorld, double rise, double step);
    void aim(AnimatedCharacter& character, const osg::Matrixd& nodeToWorld, double weight);
    std::optional<double> _time; ///< of the last update, seconds; empty: the next one starts anew
    unsigned int _frame = 0;
    bool _hasTargets = true;         ///< copies of characters and scene files have the targets of the original
    std::vector<GroundedFoot> _feet; ///< by leg
    double _longestLeg = 0.0;
    double _height = 0.0;      ///< of the character's origin
    double _lowest = 0.0;      ///< the height at which the lowest foot stands
    double _groundAbove = 0.0; ///< mean height of the ground below the feet, above the character's origin
    osg::Vec3d _place;         ///< of the character's origin, without that height
    // In the space above the character:
    osg::Vec3d _rise;   ///< from the height that the application has given
    osg::Vec3d _placed; ///< the character's origin after the last update
    osg::Matrixd _groundToWorld;
    // Of the present step:
    double _seconds = 0.0;
    bool _isNew = true;
    osg::Vec3d _way; ///< of the character relative to the ground, horizontal
    double _heading = 0.0;
    PoseInstruction _instruction;
    std::vector<PlantedTimes::Now> _planted;                    ///< by leg
    std::vector<std::optional<GroundedFoot::Probes>> _landings; ///< by leg: of feet that come down soon
    std::vector<GroundProbe::Line> _lines; ///< of each foot those of its probes, then of its landing
    std::vector<std::optional<GroundPoint>> _points;
};

} // namespace osgGpuAnimation
