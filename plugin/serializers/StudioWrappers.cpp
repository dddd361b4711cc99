// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/studio/Studio.h>
#include <osgGpuAnimation/nodes/viewing/RaisedHome.h>

#include <osgDB/ObjectWrapper>

// Studios and their home views in OSG's own formats. A studio makes its ground and backdrop itself.

namespace osgGpuAnimation::serializers
{

namespace
{

osgDB::RegisterWrapperProxy wrappers[] = {
    {[]() -> osg::Object* { return new Studio; }, "osgGpuAnimation::Studio",
     "osgGpuAnimation::ExactNumbers osg::Object osg::Node osg::Group osgGpuAnimation::Environment "
     "osgGpuAnimation::Studio",
     [](osgDB::ObjectWrapper*) {}},
    {[]() -> osg::Object* { return new RaisedHome; }, "osgGpuAnimation::RaisedHome",
     "osg::Object osg::Callback osgGpuAnimation::RaisedHome", [](osgDB::ObjectWrapper*) {}},
};

} // namespace

} // namespace osgGpuAnimation::serializers
