// SPDX-License-Identifier: MIT
#include "osganimation/SkeletonConversion.h"
#include "plugin/RoundTrip.h"
#include "plugin/SharedAssets.h"

#include <osgDB/ReadFile>

namespace osgGpuAnimation
{

namespace
{

TEST(ExportedScenesTest, nathanComesBackFromAGlb)
{
    SKIP_WITHOUT_SHARED_FILE("assets/nathan/nathan.osg");
    const osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile(sharedFile("assets/nathan/nathan.osg"));
    ASSERT_TRUE(scene);
    const osganimation::Conversion converted = osganimation::convertOsgAnimation(*scene);
    ASSERT_EQ(converted.characters.size(), 1u);
    const osg::ref_ptr<osg::Group> read = throughGlb(*converted.node);
    ASSERT_TRUE(read);
    expectSameClips(*converted.node, *read);
}

} // namespace

} // namespace osgGpuAnimation
