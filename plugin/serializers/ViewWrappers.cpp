// SPDX-License-Identifier: MIT
#include "serializers/ValueStream.h"

#include <osgGpuAnimation/nodes/shading/PunctualLight.h>
#include <osgGpuAnimation/nodes/viewing/StartView.h>

// Lights and first views in OSG's own formats. The cameras themselves are OSG's.

namespace osgGpuAnimation::serializers
{

namespace
{

/// What osg::Light does not store.
void transferCone(ValueStream& stream, PunctualLight& light)
{
    double inner = static_cast<double>(light.getInnerConeAngle()), range = static_cast<double>(light.getRange());
    stream.values(inner, range).endLine();
    if (!stream.hasRead()) return;
    const float exponent = light.getSpotExponent(); // may be the application's own
    stream.require("a light: ", light.setRange(static_cast<float>(range)));
    if (light.getKind() == PunctualLight::Kind::Spot)
        stream.require("a light: ", light.setCone(static_cast<float>(inner), light.getSpotCutoff()));
    light.setSpotExponent(exponent);
}

void transferCamera(ValueStream& stream, StartView& start)
{
    std::string camera = start.getCamera();
    stream.value(camera).endLine();
    if (stream.hasRead()) start.setCamera(camera);
}

osgDB::RegisterWrapperProxy wrappers[] = {
    {[]() -> osg::Object* { return new PunctualLight; }, "osgGpuAnimation::PunctualLight",
     "osgGpuAnimation::ExactNumbers osg::Object osg::StateAttribute osg::Light osgGpuAnimation::PunctualLight",
     [](osgDB::ObjectWrapper* wrapper) { addProperty(wrapper, "Cone", &transferCone); }},
    {[]() -> osg::Object* { return new StartView; }, "osgGpuAnimation::StartView",
     "osg::Object osg::Callback osgGpuAnimation::StartView",
     [](osgDB::ObjectWrapper* wrapper) { addProperty(wrapper, "Camera", &transferCamera); }},
};

} // namespace

} // namespace osgGpuAnimation::serializers
