// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/authoring/ClipBuilder.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>

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

/// Two keyframes of one joint and one weight block.
ClipParts partsOfTwo(Clip::Form form = Clip::Form::Linear)
{
    ClipParts parts{"two", form, 1, 2, {0.0f, 1.0f}, {}, {}, nullptr, nullptr};
    parts.data.resize(2 * 2 * Clip::transformsPerTrack(form));
    return parts;
}

std::shared_ptr<const RootMotionCurve> curveOf(std::size_t joint, std::size_t keys,
                                               const std::function<void(RootMotionCurve&)>& change = {})
{
    auto curve = std::make_shared<RootMotionCurve>();
    curve->joint = joint;
    curve->keys.resize(keys);
    if (change) change(*curve);
    return curve;
}

TEST(ClipTest, PartsThatCannotBeAreErrorsAndTheEdgesAreAccepted)
{
    const float endless = std::numeric_limits<float>::infinity();
    const double nan = std::nan("");
    struct Case
    {
        const char* message; ///< empty: accepted
        std::function<void(ClipParts&)> change;
    };
    const glm::vec4 zero(0.0f);
    const Case cases[] = {
        {"", [](ClipParts&) {}},
        {"it has no keyframes", [](ClipParts& parts) { parts.times.clear(), parts.data.clear(); }},
        {"",
         [](ClipParts& parts) {
             parts.times = {0.0f, 0.0f};
         }},
        {"time 2 (0.000000) occurs more than twice",
         [](ClipParts& parts) {
             parts.times = {0.0f, 0.0f, 0.0f}, parts.data.resize(6);
         }},
        {"time 1 (0.500000) is before",
         [](ClipParts& parts) {
             parts.times = {1.0f, 0.5f};
         }},
        {"time 0 (-0.500000) is negative", [](ClipParts& parts) { parts.times[0] = -0.5f; }},
        {"time 1 (inf) is negative or not finite", [=](ClipParts& parts) { parts.times[1] = endless; }},
        {"4 joint transforms are needed, but there are 5", [](ClipParts& parts) { parts.data.resize(5); }},
        {"track 0 at keyframe 1: the rotation has length 0", [=](ClipParts& parts) { parts.data[2].rotation = zero; }},
        {"", [=](ClipParts& parts) { parts.data[3].rotation = zero; }}, // weights
        {"", [=](ClipParts& parts) { parts = partsOfTwo(Clip::Form::Spline), parts.data[1].rotation = zero; }},
        {"track 1 at keyframe 1: a number is not finite", [=](ClipParts& parts) { parts.data[3].scale.w = endless; }},
        {"", [](ClipParts& parts) { parts.rootMotion = curveOf(0, 2); }},
        {"the joint of its root motion does not exist", [](ClipParts& parts) { parts.rootMotion = curveOf(1, 2); }},
        {"its root motion has 1 keys for 2 keyframes", [](ClipParts& parts) { parts.rootMotion = curveOf(0, 1); }},
        {"a number of its root motion is not finite", [=](ClipParts& parts)
         { parts.rootMotion = curveOf(0, 2, [=](RootMotionCurve& curve) { curve.keys[1].yaw = nan; }); }},
        {"a number of its root motion is not finite", [=](ClipParts& parts)
         { parts.rootMotion = curveOf(0, 2, [=](RootMotionCurve& curve) { curve.keys[1].pivot.out.z = nan; }); }},
        {"a number of its root motion is not finite", [=](ClipParts& parts)
         { parts.rootMotion = curveOf(0, 2, [=](RootMotionCurve& curve) { curve.keys[0].displacement.in.y = nan; }); }},
        {"a number of its root motion is not finite", [=](ClipParts& parts)
         { parts.rootMotion = curveOf(0, 2, [](RootMotionCurve& curve) { curve.up = glm::dvec3(0.0); }); }},
        {"marker \"step\" of clip \"two\": its time",
         [](ClipParts& parts) {
             parts.markers = {{-0.1, "step"}};
         }},
    };
    for (std::size_t i = 0; i < std::size(cases); ++i)
    {
        ClipParts parts = partsOfTwo();
        cases[i].change(parts);
        const Result<Clip> made = Clip::create(parts);
        const std::string message = made ? "" : made.error().message;
        ASSERT_EQ(message.empty(), *cases[i].message == '\0') << "case " << i << ": " << message;
        EXPECT_NE(message.find(cases[i].message), std::string::npos) << "case " << i << ": " << message;
    }
}

} // namespace
} // namespace osgGpuAnimation
