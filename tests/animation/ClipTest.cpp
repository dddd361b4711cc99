// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/ClipBuilder.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace osgGpuAnimation
{

namespace
{

/// Keyframes at 1, 2, 2, 4: the jump is at 2.
Clip makeClip()
{
    const Skeleton skeleton = Skeleton::create({Joint()}).value();
    ClipBuilder builder(skeleton, {});
    Channel step;
    step.interpolation = Channel::Interpolation::Step;
    step.target = 0;
    step.times = {1, 2, 4};
    step.values = {0, 0, 0, 1, 1, 1, 1, 1, 1};
    EXPECT_TRUE(builder.add(step));
    return builder.build("clip");
}

TEST(ClipTest, LocatesATimeBetweenItsKeyframes)
{
    const Clip clip = makeClip();
    ASSERT_EQ(clip.times(), (std::vector<float>{1, 2, 2, 4}));
    const double infinite = std::numeric_limits<double>::infinity();
    struct Case
    {
        const char* name;
        double time;
        std::size_t keyframe;
        float alpha;
    };
    const Case cases[] = {
        {"before the first", 0.0, 0, 0.0f},
        {"long before the first", -infinite, 0, 0.0f},
        {"at the first", 1.0, 0, 0.0f},
        {"between", 1.25, 0, 0.25f},
        {"just before the jump", std::nextafter(2.0, 0.0), 0, 1.0f - 0x1p-24f},
        {"at the jump the later one holds", 2.0, 2, 0.0f},
        {"after the jump", 3.0, 2, 0.5f},
        {"at the last", 4.0, 3, 0.0f},
        {"after the last", 1e300, 3, 0.0f},
        {"long after the last", infinite, 3, 0.0f},
        {"not a number", std::nan(""), 0, 0.0f},
    };
    for (const Case& c : cases)
    {
        const Clip::Span span = clip.locate(c.time);
        EXPECT_EQ(span.keyframe, c.keyframe) << c.name;
        EXPECT_EQ(span.alpha, c.alpha) << c.name;
    }
}

TEST(ClipTest, ItsDurationIsTheLastKeyframesTime)
{
    EXPECT_EQ(makeClip().duration(), 4.0);
    const Skeleton skeleton = Skeleton::create({Joint()}).value();
    EXPECT_EQ(ClipBuilder(skeleton, {}).build("rest").duration(), 0.0);
}

} // namespace
} // namespace osgGpuAnimation
