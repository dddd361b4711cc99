// SPDX-License-Identifier: MIT
#include "serializers/StoredTest.h"

#include <osgGpuAnimation/looks/ShaderHook.h>

#include <osg/Group>

namespace osgGpuAnimation
{

using StoredHookTest = StoredSceneTest;

TEST_F(StoredHookTest, placesTextsAndOverridesAreKept)
{
    const std::string text = "uniform float tone; // \"of the day\"\nvoid hostFinalColor(inout vec4 color)\n{\n}\n";
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    const osg::ref_ptr<ShaderHook> hook = new ShaderHook(ShaderHook::Place::FinalColor, text);
    scene->getOrCreateStateSet()->setAttribute(hook, osg::StateAttribute::OVERRIDE);
    for (const char* format : storedFormats)
    {
        const osg::ref_ptr<osg::Node> copy = files.throughFile(*scene, format);
        ASSERT_TRUE(copy && copy->getStateSet()) << format;
        const osg::StateSet::RefAttributePair* found =
            copy->getStateSet()->getAttributePair(hook->getType(), hook->getMember());
        ASSERT_TRUE(found) << format;
        const auto* const read = dynamic_cast<const ShaderHook*>(found->first.get());
        ASSERT_TRUE(read) << format;
        EXPECT_EQ(read->getPlace(), ShaderHook::Place::FinalColor);
        EXPECT_EQ(read->getText(), text) << format;
        EXPECT_EQ(read->getShader(), hook->getShader()) << "the same text is the same shader";
        EXPECT_TRUE(found->second & osg::StateAttribute::OVERRIDE) << format;
    }
}

} // namespace osgGpuAnimation
