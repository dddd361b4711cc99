// SPDX-License-Identifier: MIT
#define OBJECT_CAST dynamic_cast // for osgDB/Serializer: OSG's callbacks have virtual bases
#include "serializers/ValueReader.h"
#include "serializers/ValueWriter.h"

#include <osgGpuAnimation/nodes/AnimationUpdateCallback.h>
#include <osgGpuAnimation/nodes/CharacterKeys.h>
#include <osgGpuAnimation/nodes/PoseStatistics.h>
#include <osgGpuAnimation/nodes/RootMotionCallback.h>
#include <osgGpuAnimation/nodes/TiltedHome.h>

#include <osgDB/ObjectWrapper>

#include <cmath>

namespace osgGpuAnimation::serializers
{

namespace update
{
REGISTER_OBJECT_WRAPPER(osgGpuAnimation_AnimationUpdateCallback, new AnimationUpdateCallback,
                        osgGpuAnimation::AnimationUpdateCallback,
                        "osg::Object osg::Callback osg::NodeCallback osgGpuAnimation::AnimationUpdateCallback")
{
}
} // namespace update

namespace motion
{
REGISTER_OBJECT_WRAPPER(osgGpuAnimation_RootMotionCallback, new RootMotionCallback, osgGpuAnimation::RootMotionCallback,
                        "osg::Object osg::Callback osg::NodeCallback osgGpuAnimation::RootMotionCallback")
{
}
} // namespace motion

namespace statistics
{
REGISTER_OBJECT_WRAPPER(osgGpuAnimation_PoseStatistics, new PoseStatistics, osgGpuAnimation::PoseStatistics,
                        "osg::Object osg::Callback osgGpuAnimation::PoseStatistics")
{
}
} // namespace statistics

namespace home
{
REGISTER_OBJECT_WRAPPER(osgGpuAnimation_TiltedHome, new TiltedHome, osgGpuAnimation::TiltedHome,
                        "osg::Object osg::Callback osgGpuAnimation::TiltedHome")
{
}
} // namespace home

static bool checkFadeSeconds(const CharacterKeys&)
{
    return true;
}

static bool writeFadeSeconds(osgDB::OutputStream& stream, const CharacterKeys& keys)
{
    ValueWriter(stream).real(keys.fadeSeconds()).endLine();
    return true;
}

static bool readFadeSeconds(osgDB::InputStream& stream, CharacterKeys& keys)
{
    ValueReader in(stream);
    const double seconds = in.real();
    if (!std::isfinite(seconds) || seconds < 0.0)
        in.fail("keys whose crossfades take " + std::to_string(seconds) + " s");
    if (in.isGood()) keys.setFadeSeconds(seconds);
    return in.isGood();
}

REGISTER_OBJECT_WRAPPER(osgGpuAnimation_CharacterKeys, new CharacterKeys, osgGpuAnimation::CharacterKeys,
                        "osg::Object osg::Callback osgGpuAnimation::CharacterKeys")
{
    ADD_USER_SERIALIZER(FadeSeconds);
}

} // namespace osgGpuAnimation::serializers
