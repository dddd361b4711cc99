// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/feet/FeetState.h>

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/nodes/callbacks/WorldTargets.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace osgGpuAnimation
{

namespace
{

constexpr double settleSeconds = 0.15;                      ///< time constant of the character's height
constexpr double foresight = 1.5 * FeetState::blendSeconds; ///< the ground of a landing within this time counts
constexpr double minMove = 1e-5;   ///< of a leg's length: the application has not moved the character by less
constexpr double minUpright = 0.5; ///< z of the character's up axis: lower ones have no feet on the ground

/// The angle of a matrix about +Z.
double headingOf(const osg::Matrixd& matrix)
{
    return std::atan2(matrix(0, 1), matrix(0, 0));
}

osg::Vec3d upOf(const osg::Matrixd& matrix)
{
    osg::Vec3d up(matrix(2, 0), matrix(2, 1), matrix(2, 2));
    up.normalize();
    return up;
}

osg::Matrixd atHeight(osg::Matrixd matrix, double height)
{
    matrix(3, 2) = height;
    return matrix;
}

} // namespace

void FeetState::stop(AnimatedCharacter& character)
{
    reset();
    if (!legs || !std::exchange(_hasTargets, false)) return;
    for (const Leg& leg : legs->legs)
        static_cast<void>(character.getController().constraint(leg.constraint).clear());
}

void FeetState::update(AnimatedCharacter& character, const osg::NodePath& path, const osg::FrameStamp& stamp,
                       const FeetSettings& settings, GroundProbe& probe)
{
    const osg::Matrixd given = osg::computeLocalToWorld(path);
    const double time = stamp.getSimulationTime();
    if (!given.valid() || !std::isfinite(time)) return;
    if (!(upOf(given).z() >= minUpright)) return stop(character);
    // A character with several places has one pose: that of the first.
    if (_time == time && _frame == stamp.getFrameNumber()) return;
    _frame = stamp.getFrameNumber();
    begin(given, time, settings, probe);
    takePose(character, atHeight(given, _height));
    standOnGround(settings, probe);
    moveHeight(settings);
    const osg::Matrixd parentToWorld = osg::computeLocalToWorld({path.begin(), std::prev(path.end())});
    const double own = given(3, 2) - addedHeight(character, parentToWorld);
    const double rise = settings.weight * (_height - own);
    place(character, parentToWorld, rise, own + rise - given(3, 2));
    aim(character, atHeight(given, own + rise), settings.weight);
}

void FeetState::begin(const osg::Matrixd& given, double time, const FeetSettings& settings, GroundProbe& probe)
{
    _seconds = _time ? time - *_time : -1.0;
    _time = time;
    const osg::Matrixd motion = osg::Matrixd::inverse(_groundToWorld) * settings.groundToWorld;
    _groundToWorld = settings.groundToWorld;
    if (_seconds >= 0.0 && !motion.isIdentity() && motion.valid())
    {
        osg::Vec3d carried = osg::Vec3d(_place.x(), _place.y(), _height) * motion;
        _place = carried;
        _lowest += carried.z() - _height;
        _height = carried.z();
        for (GroundedFoot& foot : _feet)
            foot.carry(motion, headingOf(motion));
    }
    _way = given.getTrans() - _place;
    _way.z() = 0.0;
    _place = given.getTrans();
    _heading = headingOf(given);
    _isNew =
        !(_seconds >= 0.0 && _seconds <= maxStep) || _feet.size() != legs->legs.size() || _way.length() > _longestLeg;
    if (!_isNew) return;
    _seconds = 0.0;
    _feet.assign(legs->legs.size(), GroundedFoot(blendSeconds));
    const std::optional<GroundPoint> start =
        settings.ground ? probe.nearest(*settings.ground, settings.traversalMask, _place) : std::nullopt;
    _height = start ? start->place.z() : _place.z();
    _groundAbove = 0.0;
}

void FeetState::takePose(const AnimatedCharacter& character, const osg::Matrixd& nodeToWorld)
{
    const AnimationController& controller = character.getController();
    _instruction = controller.instruction();
    for (const Leg& leg : legs->legs)
        if (leg.number < _instruction.targets.size()) _instruction.targets[leg.number].weight = 0.0f;
    const auto hasEffect = [](const ConstraintTarget& target) { return target.weight > 0.0f; };
    if (std::none_of(_instruction.targets.begin(), _instruction.targets.end(), hasEffect)) _instruction.targets.clear();
    const osg::Matrixd fileToWorld = character.getFileToNode() * nodeToWorld;
    const auto toWorld = [&](std::size_t joint)
    { return toOsg(Pose::jointToModel(*legs->set, _instruction, joint)) * fileToWorld; };
    _longestLeg = 0.0;
    for (std::size_t i = 0; i < _feet.size(); ++i)
    {
        const Leg& leg = legs->legs[i];
        LegPose pose{toWorld(leg.hip).getTrans(), toWorld(leg.knee).getTrans(),
                     toWorld(leg.ankle),          {},
                     upOf(nodeToWorld),           osg::Vec3d(0.0, 0.0, leg.sole) * nodeToWorld};
        pose.contact = leg.contact == leg.ankle ? pose.ankle.getTrans() : toWorld(leg.contact).getTrans();
        _feet[i].takePose(pose);
        _longestLeg = std::max(_longestLeg, _feet[i].length());
    }
    _planted.resize(_feet.size());
    _landings.assign(_feet.size(), std::nullopt);
    for (std::size_t i = 0; i < _feet.size(); ++i)
    {
        PlantedTimes::Now& planted = _planted[i] = legs->legs[i].planted.now(controller);
        if (!(planted.secondsToTouch <= foresight) || !(_seconds > 0.0)) continue;
        const osg::Vec3d way = _way * (planted.secondsToTouch / _seconds);
        const auto then = [&](const glm::dvec3& place)
        { return osg::Vec3d(place.x, place.y, place.z) * fileToWorld + way; };
        _landings[i] = GroundedFoot::Probes{then(planted.ankle), then(planted.contact)};
    }
}

void FeetState::standOnGround(const FeetSettings& settings, GroundProbe& probe)
{
    _lines.clear();
    for (std::size_t i = 0; i < _feet.size(); ++i)
    {
        GroundedFoot& foot = _feet[i];
        foot.lock(_planted[i].isPlanted, _heading, _seconds, settings.lockDistance * foot.length());
        const double reach = settings.reach * foot.length();
        const auto add = [&](const GroundedFoot::Probes& probes)
        {
            for (const osg::Vec3d& place : {probes.heel, probes.toe})
                _lines.push_back({{place.x(), place.y(), _height + _groundAbove + reach}, 2.0 * reach});
        };
        add(foot.probes());
        if (_landings[i]) add(*_landings[i]);
    }
    _points.assign(_lines.size(), std::nullopt);
    if (settings.ground) probe.highest(*settings.ground, settings.traversalMask, _lines, _points);
    auto point = _points.begin();
    const auto next = [&]
    {
        point += 2;
        return GroundedFoot::Ground{point[-2], point[-1]};
    };
    for (std::size_t i = 0; i < _feet.size(); ++i)
    {
        const GroundedFoot::Ground below = next();
        _feet[i].standOn(below, _landings[i] ? next() : GroundedFoot::Ground(), _seconds, _isNew);
    }
}

void FeetState::moveHeight(const FeetSettings& settings)
{
    double lowest = std::numeric_limits<double>::infinity(), sum = 0.0, rise = 0.0, grounded = 0.0;
    for (GroundedFoot& foot : _feet)
    {
        foot.solve(settings.maxTilt);
        if (!foot.isGrounded()) continue;
        const double wanted = foot.wantedHeight(_height);
        lowest = std::min(lowest, wanted);
        sum += wanted;
        rise += foot.riseOver(_way);
        grounded += 1.0;
    }
    _groundAbove = 0.0;
    if (grounded == 0.0) return;
    const double slope = _isNew ? 0.0 : rise / grounded, before = _lowest + slope;
    double height = lowest;
    if (!_isNew && _seconds > 0.0)
    {
        // The solution for a height that changes evenly during the step: it does not depend on the frame rate.
        const double lag = (lowest - before) * settleSeconds / _seconds;
        const double left = std::exp(-_seconds / settleSeconds);
        height = lowest - lag + (_height + slope - before + lag) * left;
    }
    else if (!_isNew)
        height = _height + slope;
    _lowest = lowest;
    for (std::size_t i = 0; i < _feet.size(); ++i)
        height = _feet[i].limitedHeight(_height, height, legs->legs[i].reach, _planted[i].isPlanted, _seconds);
    for (GroundedFoot& foot : _feet)
        foot.follow(height - _height);
    _height = height;
    _groundAbove = sum / grounded - height;
}

double FeetState::addedHeight(const AnimatedCharacter& character, const osg::Matrixd& parentToWorld) const
{
    const auto heightOf = [&](const osg::Vec3d& way) { return osg::Matrixd::transform3x3(way, parentToWorld).z(); };
    const double change = heightOf(character.getMatrix().getTrans() - _placed);
    return std::abs(change) <= minMove * _longestLeg ? heightOf(_rise) : 0.0;
}

void FeetState::place(AnimatedCharacter& character, const osg::Matrixd& parentToWorld, double rise, double step)
{
    const osg::Matrixd fromWorld = osg::Matrixd::inverse(parentToWorld);
    const osg::Vec3d up = osg::Matrixd::transform3x3(osg::Vec3d(0.0, 0.0, 1.0), fromWorld);
    if (!std::isfinite(up.length() * step)) return;
    if (step != 0.0) character.setMatrix(character.getMatrix() * osg::Matrixd::translate(up * step));
    _rise = up * rise;
    _placed = character.getMatrix().getTrans();
}

void FeetState::aim(AnimatedCharacter& character, const osg::Matrixd& nodeToWorld, double weight)
{
    const osg::Matrixd worldToFile = osg::Matrixd::inverse(character.getFileToNode() * nodeToWorld);
    for (std::size_t i = 0; i < _feet.size(); ++i)
    {
        const WorldTargets::Target ankle{nullptr, false, {}, osg::Quat()};
        ConstraintHandle constraint = character.getController().constraint(legs->legs[i].constraint);
        // The controller refuses positions that are not finite: the previous target remains.
        if (!setPlace(constraint, ankle, _feet[i].target() * worldToFile)) continue;
        static_cast<void>(constraint.setWeight(static_cast<float>(weight)));
        _hasTargets = true;
    }
}

} // namespace osgGpuAnimation
