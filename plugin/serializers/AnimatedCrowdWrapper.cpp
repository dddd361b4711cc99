// SPDX-License-Identifier: MIT
#include "serializers/MeshCheck.h"
#include "serializers/RequiredProperty.h"
#include "serializers/StoredAnimationSet.h"
#include "serializers/StoredController.h"
#include "serializers/ValueReader.h"
#include "serializers/ValueWriter.h"

#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/OsgMatrix.h>

#include <osgDB/ObjectWrapper>

namespace osgGpuAnimation::serializers
{

namespace
{

/// What follows an instance's place.
enum class Playback
{
    Nothing,
    Plain,      ///< clip, time, speed, paused
    Controller, ///< all of it
};

Playback playbackOf(const AnimationController& controller)
{
    if (!controller.isPlainLoop()) return Playback::Controller;
    return controller.clip() < 0 ? Playback::Nothing : Playback::Plain;
}

void writeInstance(ValueWriter& out, const CrowdInstances& instances, std::size_t index)
{
    const AnimationController controller = instances.controllerCopy(index);
    const Playback playback = playbackOf(controller);
    out.property("Instance");
    for (const glm::vec4& row : instances.rootMatrix(index).rows)
        out.floats(&row.x, 4);
    out.integer(static_cast<std::int32_t>(instances.tint(index))).integer(static_cast<std::int32_t>(playback));
    if (playback == Playback::Plain)
        out.integer(controller.clip()).real(controller.time()).real(controller.speed()).flag(!controller.isPlaying());
    out.endLine();
    if (playback != Playback::Controller) return;
    out.property("Controller");
    writeController(out, controller);
}

void readPlain(ValueReader& in, AnimationController& controller)
{
    const std::int32_t clip = in.integer();
    const double time = in.real(), speed = in.real();
    const bool isPaused = in.flag();
    if (!in.isGood()) return;
    controller.setSpeed(speed);
    const Result<bool> playing = controller.play(clip < 0 ? ~std::size_t(0) : static_cast<std::size_t>(clip));
    if (!playing) in.fail("an instance of a crowd: " + playing.error().message);
    controller.seek(time);
    if (isPaused) controller.pause();
}

void readPixelError(ValueReader& in, AnimatedCrowd& crowd)
{
    const Result<bool> taken = crowd.setPixelError(static_cast<float>(in.real()));
    if (!taken) in.fail("a crowd: " + taken.error().message);
}

/// Scenes of older versions may have an update rate: it is read and dropped.
void skipUpdateRate(ValueReader& in)
{
    in.integer("updates from one pose to the next", 1, 16);
    in.real();
}

/// What else is in a crowd of the version: what is as by default stays readable for what knows older ones.
enum Version : std::int32_t
{
    plain = 1,
    withPixelError = 2,
    withUpdateRate = 3, ///< after the pixel error; not written any more
};

Version versionOf(const AnimatedCrowd& crowd)
{
    return crowd.pixelError() > 0.0f ? withPixelError : plain;
}

osg::Vec4 toColor(std::uint32_t rgba)
{
    osg::Vec4 color;
    for (int channel = 0; channel < 4; ++channel)
        color[channel] = static_cast<float>(rgba >> 8 * channel & 255u) / 255.0f;
    return color;
}

void readInstance(ValueReader& in, AnimatedCrowd& crowd)
{
    AffineMatrix root;
    in.property("Instance");
    for (glm::vec4& row : root.rows)
        in.floats(&row.x, 4);
    const auto tint = static_cast<std::uint32_t>(in.integer());
    const auto playback = static_cast<Playback>(in.integer("an instance's playback", 0, 2));
    AnimationController controller(crowd.sharedSet());
    if (playback == Playback::Plain) readPlain(in, controller);
    if (playback == Playback::Controller)
    {
        in.property("Controller");
        readController(in, controller);
    }
    if (!in.isGood()) return;
    const auto added = crowd.add(toOsg(root, crowd.origin()), controller, toColor(tint));
    if (!added) in.fail("an instance of a crowd: " + added.error().message);
}

} // namespace

static AnimatedCrowd* makeCrowd()
{
    AnimatedCrowd* crowd = new AnimatedCrowd;
    crowd->setUpdateCallback(nullptr);
    return crowd;
}

static bool writeAnimationSet(osgDB::OutputStream& stream, const AnimatedCrowd& crowd)
{
    ValueWriter out(stream);
    writeSet(out, crowd.sharedSet());
    return true;
}

static bool readAnimationSet(osgDB::InputStream& stream, AnimatedCrowd& crowd)
{
    ValueReader in(stream);
    const std::shared_ptr<const AnimationSet> set = readSet(in);
    if (!set) return false;
    removeUnfitMeshes(crowd, *set);
    const Result<bool> taken = crowd.setAnimationSet(set);
    if (!taken) in.fail(taken.error().message);
    return in.isGood();
}

static bool checkInstances(const AnimatedCrowd& crowd)
{
    return crowd.size() > 0 || versionOf(crowd) != plain;
}

static bool writeInstances(osgDB::OutputStream& stream, const AnimatedCrowd& crowd)
{
    ValueWriter out(stream);
    const Version version = versionOf(crowd);
    out.integer(version).real(crowd.origin().x()).real(crowd.origin().y()).real(crowd.origin().z());
    if (version >= withPixelError) out.real(static_cast<double>(crowd.pixelError()));
    out.endLine();
    out.open("List", crowd.size());
    for (std::size_t index = 0; index < crowd.size(); ++index)
        writeInstance(out, crowd.instances(), index);
    out.close();
    return true;
}

static bool readInstances(osgDB::InputStream& stream, AnimatedCrowd& crowd)
{
    ValueReader in(stream);
    const std::int32_t version = in.integer("the version of a crowd", plain, withUpdateRate);
    const double x = in.real(), y = in.real();
    crowd.setOrigin(osg::Vec3d(x, y, in.real()));
    if (version >= withPixelError) readPixelError(in, crowd);
    if (version >= withUpdateRate) skipUpdateRate(in);
    const std::size_t count = in.open("List");
    for (std::size_t i = 0; i < count && in.isGood(); ++i)
        readInstance(in, crowd);
    in.close();
    return in.isGood();
}

REGISTER_OBJECT_WRAPPER(osgGpuAnimation_AnimatedCrowd, makeCrowd(), osgGpuAnimation::AnimatedCrowd,
                        "osgGpuAnimation::ExactNumbers osg::Object osg::Node osg::Group osg::Transform "
                        "osgGpuAnimation::AnimatedCrowd")
{
    ADD_REQUIRED_SERIALIZER(AnimationSet);
    ADD_USER_SERIALIZER(Instances);
}

} // namespace osgGpuAnimation::serializers
