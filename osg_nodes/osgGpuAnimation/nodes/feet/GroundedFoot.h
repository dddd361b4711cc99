// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/feet/GroundProbe.h>

#include <osg/Matrixd>
#include <osg/Vec3d>

#include <optional>

namespace osgGpuAnimation
{

/// The leg of one character in the pose of the clips, to world space.
struct LegPose
{
    osg::Vec3d hip, knee;
    osg::Matrixd ankle;
    osg::Vec3d contact; ///< the place of the toe, or of the ankle
    osg::Vec3d up;      ///< the normal of the clips' ground
    osg::Vec3d origin;  ///< a place on the clips' ground
};

/// A foot on uneven ground. A rigid motion takes the clips' ground below the foot to the tangent plane of the real one,
/// and the ankle with it, so that the sole has its distance from the ground, and its angle to it, of the clips. A
/// planted foot keeps the place at which it came down. All places, directions and heights are in world space.
///
/// In each step: takePose(), lock(), probes, standOn(), solve(), limitedHeight().
class GroundedFoot
{
public:
    /// blendSeconds: until the foot has followed a change of its ground or place completely.
    explicit GroundedFoot(double blendSeconds) : _blendSeconds(blendSeconds) {}

    void takePose(const LegPose& pose);
    double length() const { return _length; } ///< of the leg

    /// Keeps the place of a planted foot until it lifts. heading: of the character, radians. maxShift: between the
    /// places in the clips and in the world; beyond it the foot loses its place.
    void lock(bool isPlanted, double heading, double seconds, double maxShift);

    /// Places of a foot to sample the ground below.
    struct Probes
    {
        osg::Vec3d heel, toe; ///< heel: below the ankle
    };
    const Probes& probes() const { return _probes; } ///< of a locked foot those where it came down
    /// The ground below two probes; empty: none.
    struct Ground
    {
        std::optional<GroundPoint> heel, toe;
    };
    /// Without any ground the clips' ground takes its place. landing: where a lifted foot comes down soon: it is there
    /// in time if that is higher. isNew: without a blend.
    void standOn(const Ground& ground, const Ground& landing, double seconds, bool isNew);
    bool isGrounded() const { return _isGrounded; } ///< false: there is no ground
    /// The height of the character at which the foot is as far below the hips as in the clips. height: the present one.
    double wantedHeight(double height) const { return height + _ground.heightAt(place()) - place().z(); }
    /// The change of the ground's height along its slope.
    double riseOver(const osg::Vec3d& way) const { return _ground.heightAt(_ground.place + way) - _ground.place.z(); }

    /// Computes the target. maxTilt: radians.
    void solve(double maxTilt);
    const osg::Matrixd& target() const { return _target; } ///< of the ankle, to world space
    /// The wanted height of the character, or the largest one at which the leg of a planted foot reaches its target. A
    /// foot that comes down out of reach takes blendSeconds. height: the present one. reach: share of the leg's length.
    double limitedHeight(double height, double wanted, double reach, bool isPlanted, double seconds);
    /// Moves the target of a foot without ground with the character.
    void follow(double rise);

    /// Moves with the ground. turn: of the motion about +Z, radians.
    void carry(const osg::Matrixd& motion, double turn);

private:
    osg::Vec3d onClipsGround(const osg::Vec3d& place) const
    {
        return place - _pose.up * ((place - _pose.origin) * _pose.up);
    }
    osg::Vec3d place() const { return _below + _shift; }

    double _blendSeconds;
    LegPose _pose;
    osg::Vec3d _below; ///< the contact on the clips' ground
    double _length = 0.0;

    // The place: until _shiftLeft seconds have passed, or as long as it is locked, it is not that of the clips.
    bool _isLocked = false, _mayLock = true;
    osg::Vec3d _lockPlace;
    double _lockHeading = 0.0;
    osg::Vec3d _shift;   ///< horizontal
    double _pivot = 0.0; ///< about the contact, radians
    double _shiftLeft = 0.0;
    Probes _probes;

    // The ground: until _liftLeft seconds have passed the foot stands elsewhere.
    bool _isGrounded = false;
    GroundPoint _ground{{}, {0.0, 0.0, 1.0}};
    double _lift = 0.0; ///< above the ground
    osg::Vec3d _lean;   ///< of the ground's normal
    double _liftLeft = 0.0;

    osg::Matrixd _target;
    double _beyond = 0.0; ///< the reach of the leg, until _beyondLeft seconds have passed
    double _beyondLeft = 0.0;
};

} // namespace osgGpuAnimation
