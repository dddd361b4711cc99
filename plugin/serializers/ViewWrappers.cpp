// SPDX-License-Identifier: MIT
#include "serializers/ValueStream.h"

#include <osgGpuAnimation/looks/Environment.h>
#include <osgGpuAnimation/looks/ShaderHook.h>
#include <osgGpuAnimation/looks/shading/PunctualLight.h>
#include <osgGpuAnimation/looks/shading/ViewLights.h>
#include <osgGpuAnimation/nodes/studio/Studio.h>
#include <osgGpuAnimation/nodes/viewing/RaisedHome.h>
#include <osgGpuAnimation/nodes/viewing/StartView.h>

#include <osg/Notify>

#include <cmath>
#include <limits>

// Lights, surroundings, hosts' hooks, studios and first views in OSG's own formats. Of surroundings the settings and
// the pictures are stored, not what the node makes of them. The cameras themselves are OSG's.

namespace osgGpuAnimation::serializers
{

namespace
{

enum class Source
{
    Studio,
    Panorama, ///< the picture follows
    Faces,    ///< the cube map follows
};

void report(const char* consequence, const Result<void>& taken)
{
    if (!taken) OSG_WARN << "osgGpuAnimation: " << consequence << ": " << taken.error().message << std::endl;
}

/// The picture may be a file that is no longer there.
const char* const studioInstead = "surroundings are the studio";
/// A value that the light cannot have, as of a cone beyond 90 degrees, costs that value alone.
const char* const keepsOwn = "a stored light keeps its own";

void transferSurroundings(ValueStream& stream, Environment& environment)
{
    double intensity = static_cast<double>(environment.getIntensity());
    double rotation = static_cast<double>(environment.getRotation());
    bool isToneMapped = environment.getToneMapping();
    Source source = environment.getPanorama() ? Source::Panorama
                    : environment.getFaces()  ? Source::Faces
                                              : Source::Studio;
    stream.values(intensity, rotation, isToneMapped);
    stream.limited("the source of surroundings", source, Source::Faces).endLine();
    constexpr double max = std::numeric_limits<float>::max();
    if (!(intensity >= 0.0 && intensity <= max && std::abs(rotation) <= max))
        return stream.fail("surroundings of the intensity " + std::to_string(intensity) + ", turned by " +
                           std::to_string(rotation));
    if (stream.hasRead())
    {
        environment.setIntensity(static_cast<float>(intensity));
        environment.setRotation(static_cast<float>(rotation));
        environment.setToneMapping(isToneMapped);
    }
    if (source == Source::Studio) return;
    osg::ref_ptr<osg::Image> panorama = environment.getPanorama();
    osg::ref_ptr<osg::TextureCubeMap> faces = environment.getFaces();
    stream.open("Picture", 1);
    if (source == Source::Panorama)
        stream.image(panorama);
    else
        stream.object(faces);
    if (stream.hasRead())
        report(studioInstead,
               source == Source::Panorama ? environment.setPanorama(panorama) : environment.setFaces(faces));
    stream.close();
}

/// What osg::Light does not store.
void transferCone(ValueStream& stream, PunctualLight& light)
{
    double inner = static_cast<double>(light.getInnerConeAngle()), range = static_cast<double>(light.getRange());
    stream.values(inner, range).endLine();
    if (!stream.hasRead()) return;
    const float exponent = light.getSpotExponent(); // may be the application's own
    report(keepsOwn, light.setRange(static_cast<float>(range)));
    if (light.getKind() == PunctualLight::Kind::Spot)
        report(keepsOwn, light.setCone(static_cast<float>(inner), light.getSpotCutoff()));
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

const Wrapper<Environment> environment("Environment", "osgGpuAnimation::ExactNumbers osg::Object osg::Node osg::Group",
                                       "Surroundings", &transferSurroundings);
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
