// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/AnimationLayer.h>
#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/authoring/WithRootMotion.h>

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/JointMask.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>

namespace osgGpuAnimation
{

namespace
{

struct MarkedClip
{
    const char* name;
    double seconds; ///< 0: a pose
    double left, right;
};

/// Two joints that move along x; the root's motion is removed.
std::shared_ptr<const AnimationSet> makeMarkedSet()
{
    AnimationParts parts{Skeleton::create({{"root", -1, {}, 0}, {"tip", 0, {}, 1}}).value(), {}, {}, {}, {}};
    for (const MarkedClip& clip :
         {MarkedClip{"Walk", 1.2, 0.1, 0.7}, MarkedClip{"Run", 0.7, 0.6, 0.2}, MarkedClip{"Idle", 0.0, 0.0, 0.0}})
    {
        ClipBuilder builder(parts.skeleton, {});
        for (int joint = 0; joint < 2; ++joint)
        {
            std::vector<double> times{0, clip.seconds}, values{0, 0, 0, 1.0 + joint, 0, 0};
            if (!(clip.seconds > 0.0)) times = {0}, values = {5, 0, 0};
            EXPECT_TRUE(
                builder.add({Channel::Path::Translation, Channel::Interpolation::Linear, joint, times, values}));
        }
        const std::vector<ClipMarker> markers{{clip.left, "left"}, {clip.right, "right"}};
        parts.clips.push_back(builder.build(clip.name).withMarkers(markers).value());
    }
    return withRootMotion(*AnimationSet::create(std::move(parts)).value(), "root").value();
}

/// What a controller shows and reports in one step.
struct Step
{
    PoseInstruction instruction;
    std::string events;
    glm::dvec3 motion{0.0};
};

Step advanced(AnimationController& controller, double seconds)
{
    Step step;
    controller.setEventCallback(
        [&](const AnimationEvent& event)
        {
            step.events += std::to_string(event.layer) + ":" + std::to_string(event.clip) +
                           (event.marker ? event.marker->name : std::to_string(static_cast<int>(event.type))) + " ";
        });
    step.instruction = controller.advance(seconds);
    controller.setEventCallback({});
    step.motion = controller.takeRootMotion().translation;
    return step;
}

void expectEqual(const Step& found, const Step& expected)
{
    ASSERT_EQ(found.instruction.sampleCount, expected.instruction.sampleCount);
    for (std::size_t s = 0; s < expected.instruction.sampleCount; ++s)
    {
        const BlendSample &a = found.instruction.samples[s], &b = expected.instruction.samples[s];
        ASSERT_EQ(a.keyframe, b.keyframe) << s;
        ASSERT_EQ(a.control, b.control) << s;
        ASSERT_NEAR(a.alpha, b.alpha, 1e-6) << s;
        ASSERT_NEAR(a.weight, b.weight, 1e-6) << s;
    }
    ASSERT_EQ(found.events, expected.events);
    ASSERT_LE(glm::distance(found.motion, expected.motion), 1e-9);
}

/// One random request to a layer.
std::function<void(AnimationLayer&)> randomRequest(std::mt19937& random,
                                                   const std::vector<std::shared_ptr<const BlendSpace>>& spaces)
{
    const auto share = [&] { return std::uniform_real_distribution<double>(0.0, 1.0)(random); };
    const std::size_t clip = random() % 3, space = random() % spaces.size();
    const double a = share();
    const double b = share();
    const CrossfadeOptions options{random() % 2 ? FadeCurve::Smooth : FadeCurve::Linear,
                                   random() % 2 ? Sync::Phase : Sync::Start, static_cast<LoopMode>(random() % 3)};
    switch (random() % 14)
    {
    case 0:
        return [=](AnimationLayer& layer) { EXPECT_TRUE(layer.play(clip)); };
    case 1:
    case 2:
        return [=](AnimationLayer& layer) { EXPECT_TRUE(layer.crossfade(clip, 0.1 + a, options)); };
    case 3:
    case 4:
        return [=](AnimationLayer& layer) { EXPECT_TRUE(layer.crossfade(spaces[space], a, options)); };
    case 5:
    case 6:
        return [=](AnimationLayer& layer) { layer.setParameter(a, b); };
    case 7:
        return [=](AnimationLayer& layer) { layer.setLoopMode(*options.loopMode); };
    case 8:
        return [=](AnimationLayer& layer) { layer.setSpeed(3.0 * a - 1.0); };
    case 9:
        return [=](AnimationLayer& layer) { layer.seek(1.3 * a); };
    case 10:
        return [=](AnimationLayer& layer) { layer.fadeWeight(static_cast<float>(a), b, options.curve); };
    case 11:
        return [=](AnimationLayer& layer) { a < 0.5 ? layer.setPhaseShared(b < 0.5) : layer.setBlendPriority(clip); };
    case 12:
        return [=](AnimationLayer& layer) { a < 0.5 ? layer.pause() : layer.resume(); };
    default:
        return [=](AnimationLayer& layer)
        {
            layer.setMode(a < 0.3 ? AnimationLayer::Mode::Additive : AnimationLayer::Mode::Override,
                          b < 0.5 ? AnimationLayer::Reference::FirstFrame : AnimationLayer::Reference::RestPose);
        };
    }
}

// Restored and copied in the middle of anything, a controller shows, moves and reports what the first one does.
TEST(LayerSnapshotTest, CopiesAndRestoredLayersContinueExactly)
{
    const auto set = makeMarkedSet();
    const std::vector<BlendSpace::Position> line{{"Walk", 0.0}, {"Run", 1.0}};
    const std::vector<std::shared_ptr<const BlendSpace>> spaces{
        BlendSpace::create(*set, line, {"left", "right"}).value(), BlendSpace::create(*set, line).value(),
        BlendSpace::create(*set, {{"Idle", 0, 0}, {"Walk", 1, 0}, {"Run", 0, 1}}, {"left", "right"}).value()};
    for (unsigned seed = 1; seed <= 60; ++seed)
    {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937 random(seed);
        AnimationController first(set), restored(set), copy(set);
        first.layer(2);
        for (int frame = 0; frame < 120; ++frame)
        {
            if (frame % 10 == 0)
            {
                restored = AnimationController(set);
                for (std::size_t layer = 0; layer < first.layerCount(); ++layer)
                {
                    const Result<void> isRestored = restored.layer(layer).restore(first.layer(layer).snapshot());
                    ASSERT_TRUE(isRestored) << isRestored.error().message;
                }
                copy = first;
            }
            const std::size_t layer = random() % first.layerCount();
            const auto request = randomRequest(random, spaces);
            const double seconds = random() % 5 == 0 ? 0.0 : std::uniform_real_distribution<double>(0.0, 0.4)(random);
            for (AnimationController* controller : {&first, &restored, &copy})
                request(controller->layer(layer));
            const Step expected = advanced(first, seconds);
            ASSERT_NO_FATAL_FAILURE(expectEqual(advanced(restored, seconds), expected)) << "restored, frame " << frame;
            ASSERT_NO_FATAL_FAILURE(expectEqual(advanced(copy, seconds), expected)) << "copied, frame " << frame;
        }
    }
}

TEST(LayerSnapshotTest, FaultsAreNamedAndTheEdgesAreAccepted)
{
    const auto set = makeMarkedSet();
    const auto space = BlendSpace::create(*set, {{"Walk", 0.0}, {"Run", 1.0}}).value();
    AnimationController source(set);
    source.setParameter(0.25);
    ASSERT_TRUE(source.play(space));
    source.advance(0.1);
    const LayerSnapshot good = source.layer(0).snapshot();
    ASSERT_EQ(good.activeClips.size(), 2u);
    using Change = std::function<void(LayerSnapshot&)>;
    struct Case
    {
        const char* message; ///< empty: accepted
        Change change;
    };
    const double nan = std::nan("");
    const Case cases[] = {
        {"", [](LayerSnapshot&) {}},
        {"", [](LayerSnapshot& kept) { kept.activeClips[1].phaseGroup = 1; }},
        {"a clip in step with one that is not there", [](LayerSnapshot& kept) { kept.activeClips[1].phaseGroup = 2; }},
        {"a clip in step with one that is not there", [](LayerSnapshot& kept) { kept.activeClips[0].phaseGroup = -1; }},
        {"", [](LayerSnapshot& kept) { kept.activeClips[0].shareBefore = 1.0; }},
        {"a share that is not in [0, 1]", [](LayerSnapshot& kept) { kept.activeClips[0].shareBefore = 1.1; }},
        {"a share that is not in [0, 1]", [](LayerSnapshot& kept) { kept.activeClips[0].shareBefore = -0.1; }},
        {"a share that is not in [0, 1]", [](LayerSnapshot& kept) { kept.activeClips[1].share = -0.1; }},
        {"a share that is not in [0, 1]", [=](LayerSnapshot& kept) { kept.activeClips[1].share = nan; }},
        {"a clip in a blend space that is not there", [](LayerSnapshot& kept) { kept.activeClips[0].point = 2; }},
        {"a clip in a blend space that is not there", [](LayerSnapshot& kept) { kept.activeClips[0].space = 1; }},
        {"a clip in a blend space that is not there", [](LayerSnapshot& kept) { kept.activeClips[0].weight = 0.0; }},
        {"a clip in a blend space that is not there", [](LayerSnapshot& kept) { kept.activeClips[0].weight = 1.1; }},
        {"a clip in a blend space that is not there", [](LayerSnapshot& kept) { kept.activeClips[0].clip = 2; }},
        {"clip 3 of 3", [](LayerSnapshot& kept) { kept.activeClips = {{3}}; }},
        {"", [](LayerSnapshot& kept) { kept.spaces[0].phase = 1.0; }},
        {"a blend space that cannot be", [](LayerSnapshot& kept) { kept.spaces[0].phase = -0.1; }},
        {"a blend space that cannot be", [=](LayerSnapshot& kept) { kept.spaces[0].parameter.y = nan; }},
        {"a blend space that cannot be", [](LayerSnapshot& kept) { kept.spaces[0].space = nullptr; }},
        {"a parameter that is not finite", [=](LayerSnapshot& kept) { kept.parameter.y = nan; }},
        {"a speed that is not finite", [=](LayerSnapshot& kept) { kept.speed = nan; }},
        {"a time or speed that is not finite", [=](LayerSnapshot& kept) { kept.activeClips[1].speed = nan; }},
        {"a time or speed that is not finite", [](LayerSnapshot& kept) { kept.activeClips[1].time = HUGE_VAL; }},
        {"a fade that cannot be", [](LayerSnapshot& kept) { kept.weight.to = 1.1; }},
        {"a fade that cannot be", [](LayerSnapshot& kept) { kept.crossfade.elapsed = -1.0; }},
        {"a fade that cannot be", [](LayerSnapshot& kept) { kept.poseShare.seconds = HUGE_VAL; }},
        {"a mask that is not one weight",
         [](LayerSnapshot& kept) {
             kept.mask = {0.5f, 1.5f};
         }},
        {"a mask that is not one weight", [](LayerSnapshot& kept) { kept.mask = {0.5f}; }},
        {"",
         [](LayerSnapshot& kept) {
             kept.mask = {0.0f, 1.0f};
         }},
        {"a state of playing, but no clip", [](LayerSnapshot& kept) { kept.activeClips.clear(); }},
        {"", [](LayerSnapshot& kept) { kept.activeClips.resize(8, {0}); }},
        {"9 clips at a time, at most 8", [](LayerSnapshot& kept) { kept.activeClips.resize(9, {0}); }},
    };
    for (std::size_t i = 0; i < std::size(cases); ++i)
    {
        SCOPED_TRACE("case " + std::to_string(i));
        AnimationController controller(set);
        LayerSnapshot kept = good;
        cases[i].change(kept);
        const Result<void> isRestored = controller.layer(0).restore(kept);
        ASSERT_EQ(static_cast<bool>(isRestored), *cases[i].message == '\0') << cases[i].message;
        if (isRestored) continue;
        EXPECT_NE(isRestored.error().message.find(cases[i].message), std::string::npos) << isRestored.error().message;
        EXPECT_EQ(controller.clip(), -1) << "unchanged";
    }
}

TEST(LayerSnapshotTest, APoseWithNothingSetIsKeptWithItsShare)
{
    const auto set = makeMarkedSet();
    AnimationController source(set), restored(set);
    source.layer(0).pose();
    ASSERT_EQ(source.layer(0).poseShare(), 1.0f);
    ASSERT_TRUE(restored.layer(0).restore(source.layer(0).snapshot()));
    EXPECT_EQ(restored.layer(0).poseShare(), 1.0f);
    ASSERT_TRUE(restored.layer(0).pose().setTranslation(1, glm::vec3(1.0f)));
    EXPECT_EQ(restored.instruction().poses.size(), 1u) << "it shows at once";
}

} // namespace
} // namespace osgGpuAnimation
