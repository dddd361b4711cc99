// SPDX-License-Identifier: MIT
#include "serializers/StoredAnimation.h"

#include <osgGpuAnimation/nodes/Outfit.h>

// Outfits of crowds in OSG's own formats.

namespace osgGpuAnimation::serializers
{

namespace
{

/// Transfers a map as a list of pairs. transferValue: void(Value&). set: void(const std::string&, const Value&).
template <typename Value, typename TransferValue, typename Set>
void transferMap(ValueStream& stream, const char* name, const std::map<std::string, Value>& map,
                 TransferValue transferValue, Set set)
{
    std::vector<std::pair<std::string, Value>> pairs;
    if (!stream.isReading()) pairs.assign(map.begin(), map.end());
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

void transferProp(ValueStream& stream, Outfit::Prop& prop)
{
    stream.property("Prop").value(prop.joint);
    transferMatrix(stream, prop.toJoint);
    stream.endLine();
    stream.object(prop.node);
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
    std::vector<Outfit::Prop> props = outfit.getProps();
    if (stream.isReading()) props.clear();
    stream.list("Props", props, [&](Outfit::Prop& prop) { transferProp(stream, prop); });
    for (const Outfit::Prop& prop : props)
        if (stream.hasRead()) outfit.addProp(prop.joint, prop.node, prop.toJoint);
    stream.close();
}

const Wrapper<Outfit> wrapper("Outfit", "osgGpuAnimation::ExactNumbers osg::Object", "Outfit", &transferOutfit);

} // namespace

} // namespace osgGpuAnimation::serializers
