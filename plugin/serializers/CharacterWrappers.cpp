// SPDX-License-Identifier: MIT
#include "serializers/StoredAnimation.h"

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/CharacterKeys.h>
#include <osgGpuAnimation/nodes/crowd/CrowdInstances.h>
#include <osgGpuAnimation/nodes/JointAttachment.h>
#include <osgGpuAnimation/nodes/PoseStatistics.h>
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
    transferSet(stream, character, character.getController().sharedSet());
}

/// One bit for each setting that differs from the default. Earlier readers know the lower bits only.
enum Extra : std::int32_t
{
    hasClipBounds = 1, ///< reading computes the bounds again
    hasPixelError = 2, ///< the pixel error follows
    isDrawnAlone = 4,
    hasFileToNode = 8, ///< the transform follows
    hasVariant = 16,   ///< the name of the material variant follows
};

std::int32_t extrasOf(const AnimatedCharacter& character)
{
    std::int32_t extras = character.getClipBounds(-1).valid() ? hasClipBounds : 0;
    if (character.getPixelError() > 0.0f) extras |= hasPixelError;
    if (!character.isDrawnTogether()) extras |= isDrawnAlone;
    if (!character.getFileToNode().isIdentity()) extras |= hasFileToNode;
    if (!character.getMaterialVariant().empty()) extras |= hasVariant;
    return extras;
}

void transferExtras(ValueStream& stream, AnimatedCharacter& character)
{
    std::int32_t extras = extrasOf(character);
    std::string variant = character.getMaterialVariant();
    double pixelError = static_cast<double>(character.getPixelError());
    stream.limited("the settings of a character", extras, 0,
                   hasClipBounds | hasPixelError | isDrawnAlone | hasFileToNode | hasVariant);
    if (extras & hasPixelError) stream.value(pixelError);
    if (extras & hasFileToNode) transferFileToNode(stream, character);
    if (extras & hasVariant) stream.value(variant);
    stream.endLine();
    if (!stream.hasRead()) return;
    character.setDrawnTogether(!(extras & isDrawnAlone));
    stream.require("a character: ", character.setMaterialVariant(variant));
    if (extras & hasClipBounds) character.computeClipBounds();
    stream.require("a character: ", character.setPixelError(static_cast<float>(pixelError)));
}

void transferState(ValueStream& stream, AnimatedCharacter& character)
{
    transferController(stream, character.getController());
    if (stream.hasRead()) character.dirtyBound();
}

void addCharacterProperties(osgDB::ObjectWrapper* wrapper)
{
    addProperty(wrapper, "AnimationSet", &transferCharacterSet);
    // The property keeps the name of its first setting.
    addProperty<AnimatedCharacter>(wrapper, "ClipBounds", &transferExtras,
                                   [](const AnimatedCharacter& character) { return extrasOf(character) != 0; });
    addProperty(wrapper, "Controller", &transferState);
}

/// In place of a joint's number: it and further settings follow. Attachments with default settings stay readable for
/// earlier versions.
constexpr int withSettings = -2;

/// The index of the attachment's instance in the crowd above it: its handle when the crowd is read. Empty: none.
std::optional<std::uint64_t> storedInstance(const JointAttachment& attachment)
{
    if (!attachment.getInstance()) return std::nullopt;
    for (const osg::NodePath& path : attachment.getParentalNodePaths())
        for (const osg::Node* node : path)
            if (const auto* crowd = dynamic_cast<const AnimatedCrowd*>(node))
                if (crowd->contains(*attachment.getInstance()))
                    return crowd->getInstances().indexOf(*attachment.getInstance());
    return std::nullopt;
}

void transferSettings(ValueStream& stream, JointAttachment& attachment)
{
    int joint = attachment.getJoint();
    const std::optional<std::uint64_t> instance = storedInstance(attachment);
    bool hasInstance = instance.has_value();
    auto index = static_cast<std::size_t>(instance.value_or(0));
    osg::Matrixd offset = attachment.getOffset();
    stream.values(joint, hasInstance, index);
    for (int number = 0; number < 16; ++number)
        stream.value(offset.ptr()[number]);
    if (!stream.hasRead()) return;
    if (attachment.getJointName().empty()) attachment.setJoint(joint);
    if (hasInstance) attachment.setInstance(index);
    attachment.setOffset(offset);
}

void transferJoint(ValueStream& stream, JointAttachment& attachment)
{
    const bool isPlain = attachment.getOffset().isIdentity() && !storedInstance(attachment);
    int joint = isPlain ? attachment.getJoint() : withSettings;
    std::string name = attachment.getJointName();
    stream.values(joint, name);
    if (stream.hasRead())
    {
        if (name.empty())
            attachment.setJoint(joint);
        else
            attachment.setJoint(name);
    }
    if (joint == withSettings) transferSettings(stream, attachment);
    stream.endLine();
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

template <typename Class>
osg::Object* create()
{
    return new Class;
}

void addNothing(osgDB::ObjectWrapper*) {}

osgDB::RegisterWrapperProxy wrappers[] = {
    {&create<AnimatedCharacter>, "osgGpuAnimation::AnimatedCharacter",
     "osgGpuAnimation::ExactNumbers osg::Object osg::Node osg::Group osg::Transform osg::MatrixTransform "
     "osgGpuAnimation::AnimatedCharacter",
     &addCharacterProperties},
    {&create<JointAttachment>, "osgGpuAnimation::JointAttachment",
     "osgGpuAnimation::ExactNumbers osg::Object osg::Node osg::Group osg::Transform osg::MatrixTransform "
     "osgGpuAnimation::JointAttachment",
     [](osgDB::ObjectWrapper* wrapper) { addProperty(wrapper, "Joint", &transferJoint); }},
    // Earlier characters and crowds had a callback that advanced them.
    {&create<FormerCallback>, "osgGpuAnimation::AnimationUpdateCallback",
     "osg::Object osg::Callback osg::NodeCallback osgGpuAnimation::AnimationUpdateCallback", &addNothing},
    {&create<RootMotionCallback>, "osgGpuAnimation::RootMotionCallback",
     "osg::Object osg::Callback osg::NodeCallback osgGpuAnimation::RootMotionCallback", &addNothing},
    {&create<PoseStatistics>, "osgGpuAnimation::PoseStatistics",
     "osg::Object osg::Callback osgGpuAnimation::PoseStatistics", &addNothing},
    {&create<CharacterKeys>, "osgGpuAnimation::CharacterKeys",
     "osg::Object osg::Callback osgGpuAnimation::CharacterKeys",
     [](osgDB::ObjectWrapper* wrapper)
     {
         addProperty<CharacterKeys>(wrapper, "FadeSeconds", &transferFadeSeconds,
                                    [](const CharacterKeys&) { return true; });
     }},
};

} // namespace

} // namespace osgGpuAnimation::serializers
