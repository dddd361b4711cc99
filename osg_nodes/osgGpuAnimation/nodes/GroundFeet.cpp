// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/GroundFeet.h>

#include <osgGpuAnimation/animation/constraints/ConstraintChain.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/callbacks/CharacterStates.h>
#include <osgGpuAnimation/nodes/callbacks/WorldTargets.h>
#include <osgGpuAnimation/nodes/feet/GroundedFoot.h>
#include <osgGpuAnimation/nodes/feet/PlantedTimes.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>
#include <osgGpuAnimation/scene/traversal/SceneVisitor.h>

#include <osg/Notify>
#include <osg/Transform>
#include <osgUtil/CullVisitor>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

// All places, directions and heights are in world space if no other is named.

namespace osgGpuAnimation
{

namespace
{

constexpr double straightest = 0.9999; ///< of a leg's length: the hips sink until planted feet are within it
constexpr double foresight = 1.5 * GroundFeet::blendSeconds; ///< the ground of a landing within this time counts
constexpr double smallestMove = 1e-5; ///< of a leg's length: the application has not moved the character by less
constexpr double leastUpright = 0.5;  ///< z of the character's up axis: lower ones have no feet on the ground

std::string nameOf(const GroundLeg& leg)
{
    return "feet: leg \"" + leg.constraint + "\": ";
}

/// The error of legs that fit no set; empty: there is none.
std::optional<Error> faultOf(const std::vector<GroundLeg>& legs)
{
    for (const GroundLeg& leg : legs)
    {
        const auto isSame = [&](const GroundLeg& other) { return other.constraint == leg.constraint; };
        if (std::count_if(legs.begin(), legs.end(), isSame) > 1) return Error{nameOf(leg) + "it is there twice"};
        if (!std::isfinite(leg.sole))
            return Error{nameOf(leg) + "its sole is " + std::to_string(leg.sole) + ", not finite"};
        if (leg.touchMarker.empty() != leg.leaveMarker.empty())
            return Error{nameOf(leg) + "it has one marker, not two or none"};
    }
    return std::nullopt;
}

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

Result<Leg> resolve(const AnimationSet& set, const GroundLeg& leg)
{
    const Result<std::size_t> number = set.constraintNamed(leg.constraint);
    if (!number) return Error{nameOf(leg) + number.error().message};
    const ConstraintChain& chain = set.constraintChains()[number.value()];
    if (chain.isLookAt) return Error{nameOf(leg) + "it is a look-at, not two-bone inverse kinematics"};
    const int ankle = chain.joints.back();
    int contact = ankle;
    if (!leg.toe.empty())
    {
        const Result<std::size_t> toe = set.skeleton().jointNamed(leg.toe);
        if (!toe) return Error{nameOf(leg) + toe.error().message};
        contact = static_cast<int>(toe.value());
        int above = contact;
        while (above >= 0 && above != ankle)
            above = set.skeleton().joint(static_cast<std::size_t>(above)).parent;
        if (above < 0) return Error{nameOf(leg) + "its toe \"" + leg.toe + "\" is not below its ankle"};
    }
    const auto index = [](int joint) { return static_cast<std::size_t>(joint); };
    return Leg{leg.constraint,
               number.value(),
               index(chain.joints.front()),
               index(chain.joints[chain.mid]),
               index(ankle),
               index(contact),
               leg.sole,
               std::min(chain.softReach, straightest),
               PlantedTimes(index(ankle), index(contact), leg.touchMarker, leg.leaveMarker)};
}

/// The legs in one set, for all its characters.
struct Legs
{
    std::shared_ptr<const AnimationSet> set;
    std::vector<Leg> legs;
};

Result<std::shared_ptr<Legs>> resolve(std::shared_ptr<const AnimationSet> set, const std::vector<GroundLeg>& legs)
{
    const auto resolved = std::make_shared<Legs>();
    for (const GroundLeg& leg : legs)
    {
        Result<Leg> found = resolve(*set, leg);
        if (!found) return found.error();
        resolved->legs.push_back(std::move(found).value());
    }
    resolved->set = std::move(set);
    return resolved;
}

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

/// The settings of the callback, for all its characters.
struct Settings
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
    std::shared_ptr<const AnimationSet> set; ///< for which the legs were looked up
    std::shared_ptr<Legs> legs;              ///< null: the set does not have them

    void reset() { _time.reset(); }

    void stop(AnimatedCharacter& character)
    {
        reset();
        if (!legs || !std::exchange(_hasTargets, false)) return;
        for (const Leg& leg : legs->legs)
            static_cast<void>(character.getController().constraint(leg.constraint).clear());
    }

    void update(AnimatedCharacter& character, const osg::NodePath& path, const osg::FrameStamp& stamp,
                const Settings& settings, GroundProbe& probe)
    {
        const osg::Matrixd given = osg::computeLocalToWorld(path);
        const double time = stamp.getSimulationTime();
        if (!given.valid() || !std::isfinite(time)) return;
        if (!(upOf(given).z() >= leastUpright)) return stop(character);
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

private:
    /// Sets the length of the step and the character's place before it.
    void begin(const osg::Matrixd& given, double time, const Settings& settings, GroundProbe& probe)
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
        _isNew = !(_seconds >= 0.0 && _seconds <= GroundFeet::longestStep) || _feet.size() != legs->legs.size() ||
                 _way.length() > _longestLeg;
        if (!_isNew) return;
        _seconds = 0.0;
        _feet.assign(legs->legs.size(), GroundedFoot(GroundFeet::blendSeconds));
        const std::optional<GroundPoint> start =
            settings.ground ? probe.nearest(*settings.ground, settings.traversalMask, _place) : std::nullopt;
        _height = start ? start->place.z() : _place.z();
        _groundAbove = 0.0;
    }

    /// The pose of the clips, without the targets of the legs.
    void takePose(const AnimatedCharacter& character, const osg::Matrixd& nodeToWorld)
    {
        const AnimationController& controller = character.getController();
        _instruction = controller.instruction();
        for (const Leg& leg : legs->legs)
            if (leg.number < _instruction.targets.size()) _instruction.targets[leg.number].weight = 0.0f;
        const auto hasEffect = [](const ConstraintTarget& target) { return target.weight > 0.0f; };
        if (std::none_of(_instruction.targets.begin(), _instruction.targets.end(), hasEffect))
            _instruction.targets.clear();
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

    void standOnGround(const Settings& settings, GroundProbe& probe)
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

    /// The character follows the slope and approaches the height at which its lowest foot stands.
    void moveHeight(const Settings& settings)
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
            const double lag = (lowest - before) * GroundFeet::settleSeconds / _seconds;
            const double left = std::exp(-_seconds / GroundFeet::settleSeconds);
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

    /// The part of the character's height that earlier updates have added; 0 if the application has changed it since.
    double addedHeight(const AnimatedCharacter& character, const osg::Matrixd& parentToWorld) const
    {
        const auto heightOf = [&](const osg::Vec3d& way) { return osg::Matrixd::transform3x3(way, parentToWorld).z(); };
        const double change = heightOf(character.getMatrix().getTrans() - _placed);
        return std::abs(change) <= smallestMove * _longestLeg ? heightOf(_rise) : 0.0;
    }

    /// rise: of the character's own height. step: of its present one.
    void place(AnimatedCharacter& character, const osg::Matrixd& parentToWorld, double rise, double step)
    {
        const osg::Matrixd fromWorld = osg::Matrixd::inverse(parentToWorld);
        const osg::Vec3d up = osg::Matrixd::transform3x3(osg::Vec3d(0.0, 0.0, 1.0), fromWorld);
        if (!std::isfinite(up.length() * step)) return;
        if (step != 0.0) character.setMatrix(character.getMatrix() * osg::Matrixd::translate(up * step));
        _rise = up * rise;
        _placed = character.getMatrix().getTrans();
    }

    void aim(AnimatedCharacter& character, const osg::Matrixd& nodeToWorld, double weight)
    {
        const osg::Matrixd worldToFile = osg::Matrixd::inverse(character.getFileToNode() * nodeToWorld);
        for (std::size_t i = 0; i < _feet.size(); ++i)
        {
            const osg::Matrixd ankle = _feet[i].target() * worldToFile;
            const osg::Quat turn = rotationOf(ankle).getRotate();
            ConstraintHandle constraint = character.getController().constraint(legs->legs[i].constraint);
            // The controller refuses positions that are not finite: the previous target remains.
            if (!constraint.setTarget(toGlm(ankle.getTrans()))) continue;
            static_cast<void>(constraint.setRotation(glm::vec4(glm::dvec4(turn.x(), turn.y(), turn.z(), turn.w()))));
            static_cast<void>(constraint.setWeight(static_cast<float>(weight)));
            _hasTargets = true;
        }
    }

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

/// True, and the setting has the value, if it is in the range.
bool setWithin(double least, double most, double value, double& setting)
{
    const bool isWithin = value >= least && value <= most; // false for NaN
    if (isWithin) setting = value;
    return isWithin;
}

constexpr double largest = std::numeric_limits<double>::max();

} // namespace

class GroundFeet::States : public CharacterStates<FeetState>
{
public:
    /// Looks the legs up if the character's set is new. False, with one warning: they do not fit it.
    bool resolveLegs(AnimatedCharacter& character, const std::vector<GroundLeg>& legs, FeetState& state)
    {
        const std::shared_ptr<const AnimationSet>& set = character.getController().sharedSet();
        if (state.set == set) return state.legs != nullptr;
        state.stop(character); // clears the targets of the previous set's legs
        state.set = set;
        state.legs = _known[set.get()].lock();
        if (state.legs) return true;
        const Result<std::shared_ptr<Legs>> resolved = resolve(set, legs);
        if (resolved)
        {
            _known[set.get()] = state.legs = resolved.value();
            return true;
        }
        OSG_WARN << "osgGpuAnimation: " << resolved.error().message << std::endl;
        for (const GroundLeg& leg : legs) // a copy has the targets of the original
            static_cast<void>(character.getController().constraint(leg.constraint).clear());
        return false;
    }

    void forgetLegs()
    {
        forEach([](AnimatedCharacter& character, FeetState& state) { state.stop(character); });
        clear();
        _known.clear();
    }

    GroundProbe probe;

private:
    std::map<const AnimationSet*, std::weak_ptr<Legs>> _known; ///< each has its set
};

GroundFeet::GroundFeet() : _states(std::make_unique<States>()) {}

GroundFeet::GroundFeet(osg::Node& ground) : GroundFeet()
{
    setGround(&ground);
}

GroundFeet::GroundFeet(const GroundFeet& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), osg::Callback(other, copyop), osg::NodeCallback(other, copyop),
      _ground(other._ground), _isWholeScene(other._isWholeScene), _groundName(other._groundName),
      _nodeName(other._nodeName), _traversalMask(other._traversalMask), _legs(other._legs), _reach(other._reach),
      _maxTilt(other._maxTilt), _lockDistance(other._lockDistance), _weight(other._weight),
      _maxDistance(other._maxDistance), _states(std::make_unique<States>())
{
}

GroundFeet::~GroundFeet() = default;

void GroundFeet::setGround(osg::Node* ground)
{
    _ground = ground;
    _isWholeScene = !ground;
    _groundName.clear();
    _nodeName = ground ? ground->getName() : std::string();
    _hasWarned = false;
    _lastSearch = {};
}

osg::ref_ptr<osg::Node> GroundFeet::getGround() const
{
    osg::ref_ptr<osg::Node> ground;
    _ground.lock(ground);
    return ground;
}

void GroundFeet::setGroundName(const std::string& name)
{
    setGround(nullptr);
    _groundName = name;
    _isWholeScene = name.empty();
}

std::string GroundFeet::getGroundName() const
{
    const osg::ref_ptr<osg::Node> ground = getGround();
    if (!_groundName.empty()) return _groundName;
    return ground ? ground->getName() : _nodeName;
}

Result<void> GroundFeet::setLegs(const AnimationSet& set, std::vector<GroundLeg> legs)
{
    for (const GroundLeg& leg : legs)
        if (const Result<Leg> resolved = resolve(set, leg); !resolved) return resolved.error();
    return setLegs(std::move(legs));
}

Result<void> GroundFeet::setLegs(std::vector<GroundLeg> legs)
{
    if (const std::optional<Error> fault = faultOf(legs)) return *fault;
    _legs = std::move(legs);
    _states->forgetLegs();
    return {};
}

bool GroundFeet::setReach(double reach)
{
    return setWithin(std::numeric_limits<double>::min(), largest, reach, _reach);
}

bool GroundFeet::setMaxTilt(double radians)
{
    return setWithin(0.0, osg::PI_2, radians, _maxTilt);
}

bool GroundFeet::setLockDistance(double distance)
{
    return setWithin(0.0, largest, distance, _lockDistance);
}

bool GroundFeet::setWeight(double weight)
{
    return setWithin(0.0, 1.0, weight, _weight);
}

bool GroundFeet::setMaxDistance(double distance)
{
    return setWithin(0.0, std::numeric_limits<double>::infinity(), distance, _maxDistance);
}

void GroundFeet::reset()
{
    _states->forEach([](AnimatedCharacter&, FeetState& state) { state.reset(); });
}

osg::ref_ptr<osg::Node> GroundFeet::groundIn(osg::Node& scene, unsigned int frame)
{
    if (_isWholeScene) return &scene;
    const std::pair<const osg::Node*, unsigned int> search(&scene, frame);
    osg::ref_ptr<osg::Node> ground = getGround();
    if (ground || _groundName.empty() || search == _lastSearch) return ground;
    _ground = ground = findBelow<osg::Node>(scene, &_groundName);
    if (ground) return ground;
    _lastSearch = search;
    if (!std::exchange(_hasWarned, true))
        OSG_WARN << "osgGpuAnimation: feet: there is no node \"" << _groundName << "\" below them" << std::endl;
    return ground;
}

void GroundFeet::operator()(osg::Node* node, osg::NodeVisitor* visitor)
{
    auto* character = dynamic_cast<AnimatedCharacter*>(node);
    const osg::FrameStamp* stamp = visitor->getFrameStamp();
    if (character && stamp)
    {
        if (osgUtil::CullVisitor* cull = visitor->asCullVisitor())
        {
            const osg::Vec3d eye = cull->getCurrentCamera()->getInverseViewMatrix().getTrans();
            const osg::Vec3d origin = osg::computeLocalToWorld(visitor->getNodePath()).getTrans();
            _states->sawFrom(*character, (origin - eye).length(), stamp->getFrameNumber());
        }
        else if (FeetState& state = _states->of(*character);
                 visitor->getVisitorType() == osg::NodeVisitor::UPDATE_VISITOR &&
                 _states->resolveLegs(*character, _legs, state))
        {
            const osg::NodePath& path = visitor->getNodePath();
            if (_weight > 0.0 && _states->isWithin(*character, _maxDistance, stamp->getFrameNumber()))
            {
                const osg::ref_ptr<osg::Node> ground = groundIn(*path.front(), stamp->getFrameNumber());
                const osg::Matrixd groundToWorld = ground ? toWorld(*ground, true) : osg::Matrixd();
                state.update(*character, path, *stamp,
                             {ground, groundToWorld, _traversalMask, _reach, _maxTilt, _lockDistance, _weight},
                             _states->probe);
            }
            else
                state.stop(*character);
        }
    }
    traverse(node, visitor);
}

} // namespace osgGpuAnimation
