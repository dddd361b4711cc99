// SPDX-License-Identifier: MIT
#include "support/ScratchFolder.h"
#include "support/WorkingFolder.h"

#include <osgGpuAnimation/looks/Environment.h>

#include <gtest/gtest.h>

#include <string>

// The snippet of the guide shading.md on surroundings. tests/house/SnippetTest.cpp compares these statements with the
// guide.

namespace osgGpuAnimation
{

TEST(ReadmeSurroundingsTest, Surroundings)
{
    const ScratchFolder folder;
    const WorkingFolder inside(folder.file(""));
    std::string sunset = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n";
    for (int pixel = 0; pixel < 32; ++pixel)
        sunset += "\x80\x40\x20\x81";
    folder.write("sunset.hdr", sunset);
    const osg::ref_ptr<osg::Node> model = new osg::Group;
    auto read = Environment::fromFile("sunset.hdr");
    osg::ref_ptr<Environment> environment = read ? read.value().get() : new Environment;
    environment->setIntensity(0.8f);
    environment->setRotation(osg::PI_2f);
    environment->setToneMapping(true);
    environment->addChild(model);
    ASSERT_TRUE(environment->getPanorama());
    EXPECT_EQ(environment->getPanorama()->s(), 8);
    EXPECT_EQ(environment->getPanorama()->getDataType(), static_cast<GLenum>(GL_FLOAT));
}

} // namespace osgGpuAnimation
