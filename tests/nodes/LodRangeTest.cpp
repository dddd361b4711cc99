// SPDX-License-Identifier: MIT
#include "support/TestCharacter.h"

#include <osgGpuAnimation/frame/stage/LodSelection.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace osgGpuAnimation
{

namespace
{

struct PixelErrorCase
{
    float pixels;
    bool isTaken;
};

const PixelErrorCase pixelErrorCases[] = {
    {0.0f, true},           {0.5f, true},    {1e6f, true},
    {-0.5f, false},         {1.1e6f, false}, {std::numeric_limits<float>::infinity(), false},
    {std::nanf(""), false},
};

template <typename Animated>
void expectTakesPixelErrors(Animated& animated)
{
    for (const auto& [pixels, isTaken] : pixelErrorCases)
    {
        ASSERT_TRUE(animated.getMeshes().setPixelError(2.0f));
        const Result<void> taken = animated.getMeshes().setPixelError(pixels);
        EXPECT_EQ(static_cast<bool>(taken), isTaken) << pixels;
        EXPECT_EQ(animated.getMeshes().getPixelError(), isTaken ? pixels : 2.0f);
        if (taken) continue;
        EXPECT_NE(taken.error().message.find("it must be a number of pixels from 0 to 1000000"), std::string::npos);
    }
}

TEST(LodRangeTest, charactersAndCrowdsTakeTheSamePixelErrors)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter(), nobody = new AnimatedCharacter;
    expectTakesPixelErrors(*character);
    expectTakesPixelErrors(*nobody);
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*character);
    expectTakesPixelErrors(*crowd);
}

} // namespace

} // namespace osgGpuAnimation
