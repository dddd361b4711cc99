// SPDX-License-Identifier: MIT
#include "serializers/ValueStream.h"

#include <osgGpuAnimation/nodes/GroundFeet.h>

#include <cmath>

// Feet on the ground in OSG's own formats: the settings, and the name of the ground; the feet start anew.

namespace osgGpuAnimation::serializers
{

namespace
{

void transferLeg(ValueStream& stream, GroundLeg& leg)
{
    stream.property("Leg").values(leg.constraint, leg.toe, leg.sole, leg.touchMarker, leg.leaveMarker).endLine();
}

void transferFeet(ValueStream& stream, GroundFeet& feet)
{
    std::vector<GroundLeg> legs;
    if (!stream.isReading()) legs = feet.getLegs();
    std::string ground = feet.getGroundName();
    auto mask = static_cast<std::size_t>(feet.getTraversalMask());
    double reach = feet.getReach(), tilt = feet.getMaxTilt(), lock = feet.getLockDistance(), weight = feet.getWeight();
    double distance = feet.getMaxDistance();
    bool hasDistance = std::isfinite(distance);
    stream.begin();
    stream.property("Ground").values(ground, mask, reach, tilt, lock, weight, hasDistance);
    if (hasDistance) stream.value(distance);
    stream.endLine();
    stream.list("Legs", legs, [&](GroundLeg& leg) { transferLeg(stream, leg); });
    stream.close();
    if (!stream.hasRead()) return;
    feet.setGroundName(ground);
    feet.setTraversalMask(static_cast<osg::Node::NodeMask>(mask));
    if (!feet.setReach(reach) || !feet.setMaxTilt(tilt) || !feet.setLockDistance(lock) || !feet.setWeight(weight) ||
        (hasDistance && !feet.setMaxDistance(distance)))
        return stream.fail("feet: a number is out of range");
    stream.require("", feet.setLegs(std::move(legs)));
}

osgDB::RegisterWrapperProxy wrapper([]() -> osg::Object* { return new GroundFeet; }, "osgGpuAnimation::GroundFeet",
                                    "osg::Object osg::Callback osg::NodeCallback osgGpuAnimation::GroundFeet",
                                    [](osgDB::ObjectWrapper* wrapper) { addProperty(wrapper, "Feet", &transferFeet); });

} // namespace

} // namespace osgGpuAnimation::serializers
