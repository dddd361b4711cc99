// SPDX-License-Identifier: MIT
#include "serializers/ValueStream.h"

#include <osgGpuAnimation/looks/Environment.h>

#include <osg/Notify>

#include <cmath>
#include <limits>

// Surroundings in OSG's own formats: the settings and the pictures, not what the node makes of them.

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

Source sourceOf(const Environment& environment)
{
    if (environment.getPanorama()) return Source::Panorama;
    return environment.getFaces() ? Source::Faces : Source::Studio;
}

/// The picture may be a file that is no longer there: the studio takes its place.
void report(const Result<void>& taken)
{
    if (!taken) OSG_WARN << "osgGpuAnimation: surroundings are the studio: " << taken.error().message << std::endl;
}

void transferPanorama(ValueStream& stream, Environment& environment)
{
    osg::ref_ptr<osg::Image> panorama = environment.getPanorama();
    stream.image(panorama);
    if (stream.hasRead()) report(environment.setPanorama(panorama));
}

void transferFaces(ValueStream& stream, Environment& environment)
{
    osg::ref_ptr<osg::TextureCubeMap> faces = environment.getFaces();
    stream.object(faces);
    if (stream.hasRead()) report(environment.setFaces(faces));
}

void transferSurroundings(ValueStream& stream, Environment& environment)
{
    double intensity = static_cast<double>(environment.getIntensity());
    double rotation = static_cast<double>(environment.getRotation());
    bool isToneMapped = environment.getToneMapping();
    Source source = sourceOf(environment);
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
    stream.open("Picture", 1);
    if (source == Source::Panorama)
        transferPanorama(stream, environment);
    else
        transferFaces(stream, environment);
    stream.close();
}

const Wrapper<Environment> wrapper("Environment", "osgGpuAnimation::ExactNumbers osg::Object osg::Node osg::Group",
                                   "Surroundings", &transferSurroundings);

} // namespace

} // namespace osgGpuAnimation::serializers
