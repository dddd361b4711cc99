// SPDX-License-Identifier: MIT
#include "serializers/StoredAnimation.h"

#include <osgGpuAnimation/animation/detail/ControllerDetail.h>
#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>
#include <osgGpuAnimation/mesh/lod/CharacterLevels.h>
#include <osgGpuAnimation/nodes/detail/CrowdDetail.h>
#include <osgGpuAnimation/nodes/Outfit.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>

#include <algorithm>

// A crowd and its outfits in OSG's own formats.

namespace osgGpuAnimation::serializers
{

namespace
{

/// Transfers a map as a list of pairs. transferValue: void(Value&). set: void(const std::string&, const Value&).
template <typename Value, typename TransferValue, typename Set>
void transferMap(ValueStream& stream, const char* name, const std::map<std::string, Value>& map,
                 TransferValue transferValue, Set set)
{
    std::vector<std::pair<std::string, Value>> pairs(map.begin(), map.end());
    const auto transferPair = [&](std::pair<std::string, Value>& pair)
    {
        stream.property("Of").value(pair.first);
        transferValue(pair.second);
        stream.endLine();
    };
    stream.list(name, pairs, transferPair);
    for (const auto& [key, value] : pairs)
        if (stream.hasRead()) set(key, value);
}

void transferOutfit(ValueStream& stream, Outfit& outfit)
{
    std::string variant = outfit.getVariant();
    stream.version("an outfit").value(variant).endLine();
    if (stream.hasRead()) outfit.setVariant(variant);
    stream.open("Parts", 1);
    transferMap(
        stream, "Visibility", outfit.getVisibility(), [&](bool& isVisible) { stream.value(isVisible); },
        [&](const std::string& part, bool isVisible) { outfit.setVisible(part, isVisible); });
    transferMap(
        stream, "Colors", outfit.getColors(), [&](osg::Vec4& color) { stream.floats(color.ptr(), 4); },
        [&](const std::string& material, const osg::Vec4& color) { outfit.setColor(material, color); });
    transferMap(
        stream, "Pictures", outfit.getPictures(), [&](osg::ref_ptr<osg::Image>& picture) { stream.image(picture); },
        [&](const std::string& material, const osg::ref_ptr<osg::Image>& picture)
        { outfit.setPicture(material, picture); });
    transferMap(
        stream, "JointScales", outfit.getJointScales(), [&](osg::Vec3& scale) { stream.floats(scale.ptr(), 3); },
        [&](const std::string& joint, const osg::Vec3& scale) { outfit.setJointScale(joint, scale); });
    std::vector<Outfit::Prop> props = outfit.getProps();
    stream.list("Props", props,
                [&](Outfit::Prop& prop)
                {
                    stream.property("Prop").value(prop.joint);
                    transferMatrix(stream, prop.toJoint);
                    stream.endLine();
                    stream.object(prop.node);
                });
    for (const Outfit::Prop& prop : props)
        if (stream.hasRead()) outfit.addProp(prop.joint, prop.node, prop.toJoint);
    stream.close();
}

void transferCrowdSet(ValueStream& stream, AnimatedCrowd& crowd)
{
    transferSet(stream, crowd, crowd.getSharedAnimationSet(),
                [&](const auto& set) { return CrowdDetail::setAnimationSet(crowd, set); });
}

bool hasLevels(const AnimatedCrowd& crowd)
{
    const std::shared_ptr<const CharacterLevels>& levels = CrowdDetail::levels(crowd);
    return crowd.getMeshes().getPixelError() > 0.0f && levels &&
           levels->isOf(CrowdDetail::drawnMeshes(crowd), crowd.getAnimationSet());
}

/// The playback data after an instance's placement.
enum class Playback
{
    Nothing,
    Plain,      ///< clip, time, speed, paused
    Controller, ///< all layers
};

void transferPlain(ValueStream& stream, AnimationController& controller)
{
    std::int32_t clip = controller.clip();
    double time = controller.time(), speed = controller.layer(0).settings().speed;
    bool isPaused = !controller.isPlaying();
    stream.values(clip, time, speed, isPaused);
    if (!stream.hasRead()) return;
    controller.setSpeed(speed);
    stream.require("an instance of a crowd: ",
                   controller.play(clip < 0 ? ~std::size_t(0) : static_cast<std::size_t>(clip)));
    controller.seek(time);
    if (isPaused) controller.pause();
}

struct StoredInstance
{
    AffineMatrix root;
    std::uint32_t tint = 0;  ///< RGBA, 8 bits each, red lowest
    std::int32_t outfit = 0; ///< from 1 on, in the order of the crowd's outfits; 0: none
    AnimationController controller;
};

void transferInstance(ValueStream& stream, StoredInstance& instance, std::size_t outfits)
{
    auto tint = static_cast<std::int32_t>(instance.tint);
    Playback playback = instance.controller.clip() < 0 ? Playback::Nothing : Playback::Plain;
    if (!ControllerDetail::isPlainLoop(instance.controller)) playback = Playback::Controller;
    stream.property("Instance").values(instance.root, tint);
    stream.limited("the outfit of an instance", instance.outfit, 0, static_cast<std::int32_t>(outfits));
    stream.limited("an instance's playback", playback, Playback::Controller);
    if (playback == Playback::Plain) transferPlain(stream, instance.controller);
    stream.endLine();
    if (playback == Playback::Controller) transferController(stream.property("Controller"), instance.controller);
    instance.tint = static_cast<std::uint32_t>(tint);
}

void transferList(ValueStream& stream, AnimatedCrowd& crowd)
{
    const osg::Matrixd toPlacement = osg::Matrixd::inverse(crowd.getFileToNode());
    const std::vector<osg::ref_ptr<Outfit>> outfits = crowd.getOutfits().getList();
    const auto numberOf = [&](const Outfit* outfit)
    {
        const auto place = std::find(outfits.begin(), outfits.end(), outfit);
        return outfit ? static_cast<std::int32_t>(place - outfits.begin() + 1) : 0;
    };
    const std::size_t count = stream.open("List", crowd.getNumInstances());
    for (std::size_t i = 0; i < count && stream.isGood(); ++i)
    {
        const CrowdInstances& instances = CrowdDetail::instances(crowd);
        StoredInstance instance{{}, 0, 0, AnimationController(crowd.getSharedAnimationSet())};
        if (!stream.isReading())
            instance = {instances.rootMatrix(i), instances.tint(i), numberOf(crowd.getOutfit(instances.handleOf(i))),
                        instances.controllerCopy(i)};
        transferInstance(stream, instance, outfits.size());
        if (!stream.hasRead()) continue;
        const Result<AnimatedCrowd::Instance> added = crowd.add(toPlacement * toOsg(instance.root, crowd.getOrigin()),
                                                                instance.controller, toColor(instance.tint));
        stream.require("an instance of a crowd: ", added);
        if (!added || instance.outfit == 0) continue;
        stream.require("an instance of a crowd: ",
                       crowd.setOutfit(added.value(), outfits[static_cast<std::size_t>(instance.outfit - 1)]));
    }
    stream.close();
}

void transferOutfits(ValueStream& stream, AnimatedCrowd& crowd)
{
    std::vector<osg::ref_ptr<Outfit>> outfits = crowd.getOutfits().getList();
    stream.list("Outfits", outfits, [&](osg::ref_ptr<Outfit>& outfit) { stream.object(outfit); });
    for (const osg::ref_ptr<Outfit>& outfit : outfits)
        if (stream.hasRead()) stream.require("a crowd: ", crowd.getOutfits().add(outfit));
}

void transferInstances(ValueStream& stream, AnimatedCrowd& crowd)
{
    osg::Vec3d origin = crowd.getOrigin();
    double pixelError = static_cast<double>(crowd.getMeshes().getPixelError());
    bool isWithLevels = hasLevels(crowd);
    std::string variant = crowd.getMeshes().getVariant();
    stream.version("a crowd").values(origin.x(), origin.y(), origin.z(), pixelError, isWithLevels, variant);
    transferFileToNode(stream, crowd);
    stream.endLine();
    if (stream.hasRead())
    {
        stream.require("a crowd: ", crowd.setOrigin(origin));
        stream.require("a crowd: ", crowd.getMeshes().setVariant(variant));
    }
    transferOutfits(stream, crowd);
    if (isWithLevels) transferCharacterLevels(stream, crowd);
    if (stream.hasRead()) stream.require("a crowd: ", crowd.getMeshes().setPixelError(static_cast<float>(pixelError)));
    transferList(stream, crowd);
}

void addCrowdProperties(osgDB::ObjectWrapper* wrapper)
{
    addProperty(wrapper, "AnimationSet", &transferCrowdSet);
    addProperty(wrapper, "Instances", &transferInstances);
}

const Wrapper<Outfit> outfit("Outfit", "osgGpuAnimation::ExactNumbers osg::Object", "Outfit", &transferOutfit);
const Wrapper<AnimatedCrowd> crowd("AnimatedCrowd",
                                   "osgGpuAnimation::ExactNumbers osg::Object osg::Node osg::Group osg::Transform",
                                   &addCrowdProperties);

} // namespace

} // namespace osgGpuAnimation::serializers
