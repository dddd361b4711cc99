// SPDX-License-Identifier: MIT
#include "serializers/ValueStream.h"

#include <osgGpuAnimation/looks/ShaderHook.h>
#include <osgGpuAnimation/looks/shading/PunctualLight.h>
#include <osgGpuAnimation/looks/shading/ViewLights.h>
#include <osgGpuAnimation/nodes/studio/Studio.h>
#include <osgGpuAnimation/nodes/viewing/RaisedHome.h>
#include <osgGpuAnimation/nodes/viewing/StartView.h>

#include <osg/Notify>

// Lights, hosts' hooks, studios and first views in OSG's own formats. The cameras themselves are OSG's.

namespace osgGpuAnimation::serializers
{

namespace
{

/// A value that the light cannot have, as of a cone beyond 90 degrees, costs that value alone.
void report(const Result<void>& taken)
{
    if (!taken) OSG_WARN << "osgGpuAnimation: a stored light keeps its own: " << taken.error().message << std::endl;
}

/// What osg::Light does not store.
void transferCone(ValueStream& stream, PunctualLight& light)
{
    double inner = static_cast<double>(light.getInnerConeAngle()), range = static_cast<double>(light.getRange());
    stream.values(inner, range).endLine();
    if (!stream.hasRead()) return;
    const float exponent = light.getSpotExponent(); // may be the application's own
    report(light.setRange(static_cast<float>(range)));
    if (light.getKind() == PunctualLight::Kind::Spot)
        report(light.setCone(static_cast<float>(inner), light.getSpotCutoff()));
    light.setSpotExponent(exponent);
}

void transferCamera(ValueStream& stream, StartView& start)
{
    std::string camera = start.getCamera();
    stream.value(camera).endLine();
    if (stream.hasRead()) start.setCamera(camera);
}

void transferHook(ValueStream& stream, ShaderHook& hook)
{
    ShaderHook::Place place = hook.getPlace();
    std::string text = hook.getText();
    stream.limited("the place of a hook", place, ShaderHook::Place::FinalColor).value(text).endLine();
    if (stream.hasRead()) hook.set(place, text);
}

const Wrapper<ShaderHook> hook("ShaderHook", "osg::Object osg::StateAttribute", "Hook", &transferHook);
const Wrapper<ViewLightsCallback> viewLights("ViewLightsCallback", "osg::Object osg::Callback");
const Wrapper<PunctualLight> light("PunctualLight",
                                   "osgGpuAnimation::ExactNumbers osg::Object osg::StateAttribute osg::Light", "Cone",
                                   &transferCone);
const Wrapper<StartView> startView("StartView", "osg::Object osg::Callback", "Camera", &transferCamera);
// Makes its ground and backdrop itself.
const Wrapper<Studio>
    studio("Studio", "osgGpuAnimation::ExactNumbers osg::Object osg::Node osg::Group osgGpuAnimation::Environment");
const Wrapper<RaisedHome> home("RaisedHome", "osg::Object osg::Callback");

} // namespace

} // namespace osgGpuAnimation::serializers
