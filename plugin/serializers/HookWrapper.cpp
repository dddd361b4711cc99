// SPDX-License-Identifier: MIT
#include "serializers/ValueStream.h"

#include <osgGpuAnimation/looks/ShaderHook.h>

// A host's hooks in OSG's own formats: the place and the text.

namespace osgGpuAnimation::serializers
{

namespace
{

void transferHook(ValueStream& stream, ShaderHook& hook)
{
    ShaderHook::Place place = hook.getPlace();
    std::string text = hook.getText();
    stream.limited("the place of a hook", place, ShaderHook::Place::FinalColor).value(text).endLine();
    if (stream.hasRead()) hook.set(place, text);
}

osgDB::RegisterWrapperProxy hookWrapper([]() -> osg::Object* { return new ShaderHook; }, "osgGpuAnimation::ShaderHook",
                                        "osg::Object osg::StateAttribute osgGpuAnimation::ShaderHook",
                                        [](osgDB::ObjectWrapper* wrapper)
                                        { addProperty(wrapper, "Hook", &transferHook); });

} // namespace

} // namespace osgGpuAnimation::serializers
