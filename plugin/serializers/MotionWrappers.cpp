// SPDX-License-Identifier: MIT
#include "serializers/ValueStream.h"

#include <osgGpuAnimation/nodes/GroundFeet.h>
#include <osgGpuAnimation/nodes/SpringBones.h>

#include <cmath>
#include <limits>

// Feet on the ground and spring chains in OSG's own formats: the settings, and the name of the ground. Feet start anew,
// and chains begin at rest.
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

void transferVector(ValueStream& stream, osg::Vec3& vector)
{
    stream.floats(vector.ptr(), 3);
}

void transferJoint(ValueStream& stream, SpringJoint& joint)
{
    stream.property("SpringJoint").value(joint.joint);
    for (float* const number : {&joint.stiffness, &joint.drag, &joint.gravity, &joint.radius})
        stream.floats(number, 1);
    transferVector(stream, joint.gravityDirection);
    stream.endLine();
}

void transferChain(ValueStream& stream, SpringChain& chain)
{
    stream.list("SpringJoints", chain.joints, [&](SpringJoint& joint) { transferJoint(stream, joint); });
    stream.list("HitColliders", chain.colliders,
                [&](std::size_t& collider) { stream.property("Collider").value(collider).endLine(); });
}

void transferCollider(ValueStream& stream, SpringCollider& collider)
{
    bool isCapsule = collider.tail.has_value();
    osg::Vec3 tail = collider.tail.value_or(osg::Vec3());
    stream.property("SpringCollider").value(collider.joint);
    transferVector(stream, collider.center);
    stream.floats(&collider.radius, 1).value(isCapsule);
    if (isCapsule) transferVector(stream, tail);
    stream.endLine();
    if (stream.hasRead() && isCapsule) collider.tail = tail;
}

void transferChains(ValueStream& stream, SpringBones& springs)
{
    std::vector<SpringChain> chains;
    std::vector<SpringCollider> colliders;
    if (!stream.isReading())
    {
        chains = springs.getChains();
        colliders = springs.getColliders();
    }
    auto layer = springs.getLayer();
    double maxDistance = springs.getMaxDistance();
    bool hasMaxDistance = springs.getMaxDistance() <= std::numeric_limits<double>::max();
    stream.begin();
    stream.property("Layer").values(layer, hasMaxDistance);
    if (hasMaxDistance) stream.value(maxDistance);
    stream.endLine();
    stream.list("SpringChains", chains, [&](SpringChain& chain) { transferChain(stream, chain); });
    stream.list("SpringColliders", colliders, [&](SpringCollider& collider) { transferCollider(stream, collider); });
    stream.close();
    if (!stream.hasRead()) return;
    springs.setLayer(layer);
    if (hasMaxDistance) springs.setMaxDistance(maxDistance);
    stream.require("", springs.setChains(std::move(chains), std::move(colliders)));
}

const char* const bases = "osg::Object osg::Callback osg::NodeCallback";
const Wrapper<GroundFeet> feet("GroundFeet", bases, "Feet", &transferFeet);
const Wrapper<SpringBones> springs("SpringBones", bases, "Chains", &transferChains);

} // namespace

} // namespace osgGpuAnimation::serializers
