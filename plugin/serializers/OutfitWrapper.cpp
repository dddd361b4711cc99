// SPDX-License-Identifier: MIT
#include "serializers/ValueStream.h"

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

template <typename Vector>
void transferVector(ValueStream& stream, Vector& vector)
{
    for (int i = 0; i < Vector::num_components; ++i)
    {
        auto value = static_cast<double>(vector[i]);
        stream.value(value);
        vector[i] = static_cast<float>(value);
    }
}

void transferProp(ValueStream& stream, Outfit::Prop& prop)
{
    stream.property("Prop").value(prop.joint);
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            stream.value(prop.toJoint(row, column));
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
        stream, "Colors", outfit.getColors(), [&](osg::Vec4& color) { transferVector(stream, color); },
        [&](const std::string& material, const osg::Vec4& color) { outfit.setColor(material, color); });
    transferMap(
        stream, "Pictures", outfit.getPictures(), [&](osg::ref_ptr<osg::Image>& picture) { stream.image(picture); },
        [&](const std::string& material, const osg::ref_ptr<osg::Image>& picture)
        { outfit.setPicture(material, picture); });
    transferMap(
        stream, "JointScales", outfit.getJointScales(), [&](osg::Vec3& scale) { transferVector(stream, scale); },
        [&](const std::string& joint, const osg::Vec3& scale) { outfit.setJointScale(joint, scale); });
    std::vector<Outfit::Prop> props = outfit.getProps();
    if (stream.isReading()) props.clear();
    stream.list("Props", props, [&](Outfit::Prop& prop) { transferProp(stream, prop); });
    for (const Outfit::Prop& prop : props)
        if (stream.hasRead()) outfit.addProp(prop.joint, prop.node, prop.toJoint);
    stream.close();
}

void addOutfitProperties(osgDB::ObjectWrapper* wrapper)
{
    addProperty(wrapper, "Outfit", &transferOutfit);
}

osgDB::RegisterWrapperProxy outfit([]() -> osg::Object* { return new Outfit; }, "osgGpuAnimation::Outfit",
                                   "osgGpuAnimation::ExactNumbers osg::Object osgGpuAnimation::Outfit",
                                   &addOutfitProperties);

} // namespace

} // namespace osgGpuAnimation::serializers
