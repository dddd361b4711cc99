// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/GroundFeet.h>

#include <osgGpuAnimation/animation/constraints/ConstraintChain.h>
#include <osgGpuAnimation/nodes/callbacks/CharacterStates.h>
#include <osgGpuAnimation/nodes/callbacks/WorldTargets.h>
#include <osgGpuAnimation/nodes/feet/FeetState.h>
#include <osgGpuAnimation/scene/traversal/SceneVisitor.h>

#include <osg/Notify>

#include <algorithm>
#include <cmath>
#include <map>

namespace osgGpuAnimation
{

namespace
{

constexpr double maxReach = 0.9999; ///< of a leg's length: the hips sink until planted feet are within it

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
               std::min(chain.softReach, maxReach),
               PlantedTimes(index(ankle), index(contact), leg.touchMarker, leg.leaveMarker)};
}

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

/// True, and the setting has the value, if it is in the range.
bool setWithin(double min, double max, double value, double& setting)
{
    const bool isWithin = value >= min && value <= max; // false for NaN
    if (isWithin) setting = value;
    return isWithin;
}

constexpr double maxDouble = std::numeric_limits<double>::max();

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
    return setWithin(std::numeric_limits<double>::min(), maxDouble, reach, _reach);
}

bool GroundFeet::setMaxTilt(double radians)
{
    return setWithin(0.0, osg::PI_2, radians, _maxTilt);
}

bool GroundFeet::setLockDistance(double distance)
{
    return setWithin(0.0, maxDouble, distance, _lockDistance);
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
            _states->see(*character, *cull);
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
