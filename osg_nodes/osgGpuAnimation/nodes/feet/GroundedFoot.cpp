// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/feet/GroundedFoot.h>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

namespace
{

constexpr double minJump = 1e-4; ///< of the leg's length: smaller changes of the ground's height are no jumps
constexpr double minTurn = 1e-3; ///< of the ground's normal, for the same
constexpr double maxPivot = 0.8; ///< radians by which a character turns over a locked foot

const osg::Vec3d upwards(0.0, 0.0, 1.0);

/// The ground of a foot that enters it neither at the heel nor at the toe.
std::optional<GroundPoint> supportOf(const GroundedFoot::Ground& ground, double tolerance)
{
    const auto& [heel, toe] = ground;
    if (!heel || !toe) return toe ? toe : heel;
    if (heel->place.z() <= toe->heightAt(heel->place) + tolerance) return toe;
    if (toe->place.z() <= heel->heightAt(toe->place) + tolerance) return heel;
    osg::Vec3d along = toe->place - heel->place;
    along.normalize();
    osg::Vec3d normal = heel->normal + toe->normal;
    normal -= along * (normal * along);
    normal.normalize();
    return normal.z() > 0.1 ? std::optional<GroundPoint>({toe->place, normal}) : toe;
}

/// The direction, at most so far from the vertical.
osg::Vec3d limitedTilt(osg::Vec3d direction, double max)
{
    direction.normalize();
    osg::Vec3d side(direction.x(), direction.y(), 0.0);
    if (direction.z() >= std::cos(max) || !(side.normalize() > 0.0)) return direction;
    return upwards * std::cos(max) + side * std::sin(max);
}

/// The share of a difference that is left after a step, if it vanishes within `left` seconds.
double remainder(double seconds, double& left)
{
    const double before = left;
    left = std::max(left - seconds, 0.0);
    return before > 0.0 ? left / before : 0.0;
}

} // namespace

void GroundedFoot::takePose(const LegPose& pose)
{
    _pose = pose;
    _below = onClipsGround(pose.contact);
    _length = (pose.knee - pose.hip).length() + (pose.ankle.getTrans() - pose.knee).length();
}

void GroundedFoot::lock(bool isPlanted, double heading, double seconds, double maxShift)
{
    if (!_isLocked)
    {
        const double share = remainder(seconds, _shiftLeft);
        _shift *= share;
        _pivot *= share;
    }
    const bool wasLocked = _isLocked;
    if (!isPlanted || (!_isLocked && _shiftLeft == 0.0)) _mayLock = true;
    if (!_isLocked && isPlanted && _mayLock && maxShift > 0.0)
    {
        _isLocked = true;
        _lockPlace = place();
        _lockHeading = heading + _pivot;
    }
    if (_isLocked)
    {
        const osg::Vec3d shift(_lockPlace.x() - _below.x(), _lockPlace.y() - _below.y(), 0.0);
        const double pivot = std::remainder(_lockHeading - heading, 2.0 * osg::PI);
        _isLocked = isPlanted && shift.length() <= maxShift && std::abs(pivot) <= maxPivot;
        if (_isLocked)
        {
            _shift = shift;
            _pivot = pivot;
        }
        else
        {
            _mayLock = !isPlanted;
            _shiftLeft = _blendSeconds;
        }
    }
    if (_isLocked && wasLocked) return;
    _probes.toe = place();
    _probes.heel = _probes.toe + osg::Quat(_pivot, _pose.up) * (onClipsGround(_pose.ankle.getTrans()) - _below);
}

void GroundedFoot::standOn(const Ground& below, const Ground& landing, double seconds, bool isNew)
{
    std::optional<GroundPoint> support = supportOf(below, minJump * _length);
    const std::optional<GroundPoint> next = supportOf(landing, minJump * _length);
    if (next && (!support || next->heightAt(place()) > support->heightAt(place()))) support = next;
    const GroundPoint ground = support ? *support : GroundPoint{place(), _pose.up};
    const double share = remainder(seconds, _liftLeft);
    _lift *= share;
    _lean *= share;
    const double jump = isNew ? 0.0 : _ground.heightAt(place()) - ground.heightAt(place());
    const osg::Vec3d turn = isNew ? osg::Vec3d() : _ground.normal - ground.normal;
    if (std::abs(jump) > minJump * _length || turn.length() > minTurn)
    {
        _lift += jump;
        _lean += turn;
        _liftLeft = _blendSeconds;
    }
    _ground = ground;
    _isGrounded = support.has_value();
}

void GroundedFoot::solve(double maxTilt)
{
    const osg::Vec3d shown = _ground.normal + _lean;
    const bool isTilted = _isGrounded || _liftLeft > 0.0;
    osg::Quat tilt;
    if (isTilted) tilt.makeRotate(_pose.up, limitedTilt(shown, maxTilt));
    _target = _pose.ankle * osg::Matrixd::translate(-_pose.contact) *
              osg::Matrixd::rotate(osg::Quat(_pivot, _pose.up)) * osg::Matrixd::translate(_pose.contact - _below) *
              osg::Matrixd::rotate(tilt) *
              osg::Matrixd::translate(place().x(), place().y(), _ground.heightAt(place()) + _lift);
}

double GroundedFoot::limitedHeight(double height, double wanted, double reach, bool isPlanted, double seconds)
{
    if (!_isGrounded) return wanted;
    const osg::Vec3d way = _target.getTrans() - _pose.hip;
    const double longest = reach * _length;
    const double squared = longest * longest - way.x() * way.x() - way.y() * way.y();
    const double limit = height + way.z() + std::sqrt(std::max(squared, 0.0));
    if (!isPlanted)
    {
        _beyond = std::max(wanted - limit, 0.0);
        _beyondLeft = _blendSeconds;
        return wanted;
    }
    _beyond *= remainder(seconds, _beyondLeft);
    return std::min(wanted, limit + _beyond);
}

void GroundedFoot::follow(double rise)
{
    if (!_isGrounded) _target.postMultTranslate(osg::Vec3d(0.0, 0.0, rise));
}

void GroundedFoot::carry(const osg::Matrixd& motion, double turn)
{
    for (osg::Vec3d* place : {&_lockPlace, &_probes.toe, &_probes.heel, &_ground.place})
        *place = *place * motion;
    _lockHeading += turn;
    const osg::Vec3d normal = osg::Matrixd::transform3x3(osg::Matrixd::inverse(motion), _ground.normal);
    if (normal.z() > 0.0) _ground.normal = normal;
    _ground.normal.normalize();
}

} // namespace osgGpuAnimation
