// SPDX-License-Identifier: MIT
#include "serializers/StoredAnimation.h"

#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>
#include <osgGpuAnimation/frame/PoseStatistics.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/CharacterKeys.h>
#include <osgGpuAnimation/nodes/detail/CrowdDetail.h>
#include <osgGpuAnimation/nodes/JointAttachment.h>
#include <osgGpuAnimation/nodes/RootMotionCallback.h>

#include <cmath>
#include <cstdint>
#include <optional>

// A character, its attachments and callbacks in OSG's own formats.

namespace osgGpuAnimation::serializers
{

namespace
{

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

void transferState(ValueStream& stream, AnimatedCharacter& character)
{
    transferController(stream, character.getController());
    if (stream.hasRead()) character.dirtyBound();
}

void addCharacterProperties(osgDB::ObjectWrapper* wrapper)
{
    addProperty(wrapper, "AnimationSet", &transferCharacterSet);
    addProperty(wrapper, "Settings", &transferSettings);
    addProperty(wrapper, "Controller", &transferState);
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

const char* const bases =
    "osgGpuAnimation::ExactNumbers osg::Object osg::Node osg::Group osg::Transform osg::MatrixTransform";
const Wrapper<AnimatedCharacter> character("AnimatedCharacter", bases, &addCharacterProperties);
const Wrapper<JointAttachment> attachment("JointAttachment", bases, "Joint", &transferJoint);
const Wrapper<RootMotionCallback> rootMotion("RootMotionCallback", "osg::Object osg::Callback osg::NodeCallback");
const Wrapper<PoseStatistics> statistics("PoseStatistics", "osg::Object osg::Callback");
const Wrapper<CharacterKeys> keys("CharacterKeys", "osg::Object osg::Callback", "FadeSeconds", &transferFadeSeconds);

} // namespace

} // namespace osgGpuAnimation::serializers
