// SPDX-License-Identifier: MIT
#include "serializers/StoredAnimation.h"

#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>
#include <osgGpuAnimation/frame/PoseStatistics.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/CharacterKeys.h>
#include <osgGpuAnimation/nodes/detail/CrowdDetail.h>
#include <osgGpuAnimation/nodes/GroundFeet.h>
#include <osgGpuAnimation/nodes/JointAttachment.h>
#include <osgGpuAnimation/nodes/RootMotionCallback.h>
#include <osgGpuAnimation/nodes/SpringBones.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

// A character, its attachments and callbacks in OSG's own formats. Of feet on the ground and spring chains the settings
// and the name of the ground are stored: feet start anew, and chains begin at rest.

namespace osgGpuAnimation::serializers
{

namespace
{

/// A distance that may be infinite, at the end of a line.
void transferDistance(ValueStream& stream, double& distance)
{
    bool isFinite = distance <= std::numeric_limits<double>::max();
    stream.value(isFinite);
    if (isFinite) stream.value(distance);
    stream.endLine();
}

void transferFeet(ValueStream& stream, GroundFeet& feet)
{
    std::vector<GroundLeg> legs = feet.getLegs();
    std::string ground = feet.getGroundName();
    auto mask = static_cast<std::size_t>(feet.getTraversalMask());
    double reach = feet.getReach(), tilt = feet.getMaxTilt(), lock = feet.getLockDistance(), weight = feet.getWeight();
    double distance = feet.getMaxDistance();
    stream.begin();
    transferDistance(stream.property("Ground").values(ground, mask, reach, tilt, lock, weight), distance);
    stream.list("Legs", legs,
                [&](GroundLeg& leg) {
                    stream.property("Leg")
                        .values(leg.constraint, leg.toe, leg.sole, leg.touchMarker, leg.leaveMarker)
                        .endLine();
                });
    stream.close();
    if (!stream.hasRead()) return;
    feet.setGroundName(ground);
    feet.setTraversalMask(static_cast<osg::Node::NodeMask>(mask));
    if (!feet.setReach(reach) || !feet.setMaxTilt(tilt) || !feet.setLockDistance(lock) || !feet.setWeight(weight) ||
        !feet.setMaxDistance(distance))
        return stream.fail("feet: a number is out of range");
    stream.require("", feet.setLegs(std::move(legs)));
}

void transferVector(ValueStream& stream, osg::Vec3& vector)
{
    stream.floats(vector.ptr(), 3);
}

void transferSpring(ValueStream& stream, SpringJoint& joint)
{
    stream.property("SpringJoint").value(joint.joint);
    for (float* const number : {&joint.stiffness, &joint.drag, &joint.gravity, &joint.radius})
        stream.floats(number, 1);
    transferVector(stream, joint.gravityDirection);
    stream.endLine();
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
    std::vector<SpringChain> chains = springs.getChains();
    std::vector<SpringCollider> colliders = springs.getColliders();
    auto layer = springs.getLayer();
    double maxDistance = springs.getMaxDistance();
    stream.begin();
    transferDistance(stream.property("Layer").value(layer), maxDistance);
    const auto transferChain = [&](SpringChain& chain)
    {
        stream.list("SpringJoints", chain.joints, [&](SpringJoint& joint) { transferSpring(stream, joint); });
        stream.list("HitColliders", chain.colliders,
                    [&](std::size_t& collider) { stream.property("Collider").value(collider).endLine(); });
    };
    stream.list("SpringChains", chains, transferChain);
    stream.list("SpringColliders", colliders, [&](SpringCollider& collider) { transferCollider(stream, collider); });
    stream.close();
    if (!stream.hasRead()) return;
    springs.setLayer(layer);
    springs.setMaxDistance(maxDistance);
    stream.require("", springs.setChains(std::move(chains), std::move(colliders)));
}

void transferCharacterSet(ValueStream& stream, AnimatedCharacter& character)
{
    transferSet(stream, character, character.getController().sharedSet(),
                [&](const auto& set) { return character.setAnimationSet(set); });
}

void transferSettings(ValueStream& stream, AnimatedCharacter& character)
{
    bool hasClipBounds = character.getClipBounds(-1).valid(); // reading computes the bounds again
    bool isDrawnTogether = character.isDrawnTogether();
    double pixelError = static_cast<double>(character.getMeshes().getPixelError());
    std::string variant = character.getMeshes().getVariant();
    stream.values(hasClipBounds, isDrawnTogether, pixelError, variant);
    transferFileToNode(stream, character);
    stream.endLine();
    if (!stream.hasRead()) return;
    character.setDrawnTogether(isDrawnTogether);
    stream.require("a character: ", character.getMeshes().setVariant(variant));
    if (hasClipBounds) character.computeClipBounds();
    stream.require("a character: ", character.getMeshes().setPixelError(static_cast<float>(pixelError)));
}

void addCharacterProperties(osgDB::ObjectWrapper* wrapper)
{
    addProperty(wrapper, "AnimationSet", &transferCharacterSet);
    addProperty(wrapper, "Settings", &transferSettings);
    addProperty<AnimatedCharacter>(wrapper, "Controller",
                                   [](ValueStream& stream, AnimatedCharacter& character)
                                   {
                                       transferController(stream, character.getController());
                                       if (stream.hasRead()) character.dirtyBound();
                                   });
}

/// The index of the attachment's instance in the crowd above it: its handle when the crowd is read. Empty: none.
std::optional<std::uint64_t> storedInstance(const JointAttachment& attachment)
{
    if (!attachment.getInstance()) return std::nullopt;
    for (const osg::NodePath& path : attachment.getParentalNodePaths())
        for (const osg::Node* node : path)
            if (const auto* crowd = dynamic_cast<const AnimatedCrowd*>(node))
                if (crowd->contains(*attachment.getInstance()))
                    return CrowdDetail::instances(*crowd).indexOf(*attachment.getInstance());
    return std::nullopt;
}

void transferJoint(ValueStream& stream, JointAttachment& attachment)
{
    int joint = attachment.getJoint();
    std::string name = attachment.getJointName();
    const std::optional<std::uint64_t> instance = storedInstance(attachment);
    bool hasInstance = instance.has_value();
    auto index = static_cast<std::size_t>(instance.value_or(0));
    osg::Matrixd offset = attachment.getOffset();
    stream.values(joint, name, hasInstance, index);
    transferMatrix(stream, offset);
    stream.endLine();
    if (!stream.hasRead()) return;
    if (name.empty())
        attachment.setJoint(joint);
    else
        attachment.setJoint(name);
    if (hasInstance) attachment.setInstance(index);
    attachment.setOffset(offset);
}

void transferFadeSeconds(ValueStream& stream, CharacterKeys& keys)
{
    double seconds = keys.getFadeSeconds();
    stream.value(seconds).endLine();
    if (!stream.hasRead()) return;
    if (!std::isfinite(seconds) || seconds < 0.0)
        return stream.fail("keys whose crossfades take " + std::to_string(seconds) + " s");
    keys.setFadeSeconds(seconds);
}

const char* const nodeBases =
    "osgGpuAnimation::ExactNumbers osg::Object osg::Node osg::Group osg::Transform osg::MatrixTransform";
const Wrapper<AnimatedCharacter> character("AnimatedCharacter", nodeBases, &addCharacterProperties);
const Wrapper<JointAttachment> attachment("JointAttachment", nodeBases, "Joint", &transferJoint);
const char* const callbackBases = "osg::Object osg::Callback osg::NodeCallback";
const Wrapper<RootMotionCallback> rootMotion("RootMotionCallback", callbackBases);
const Wrapper<GroundFeet> feet("GroundFeet", callbackBases, "Feet", &transferFeet);
const Wrapper<SpringBones> springs("SpringBones", callbackBases, "Chains", &transferChains);
const Wrapper<PoseStatistics> statistics("PoseStatistics", "osg::Object osg::Callback");
const Wrapper<CharacterKeys> keys("CharacterKeys", "osg::Object osg::Callback", "FadeSeconds", &transferFadeSeconds);

} // namespace

} // namespace osgGpuAnimation::serializers
