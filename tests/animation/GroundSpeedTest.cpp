// SPDX-License-Identifier: MIT
#include "support/ClipSets.h"
#include "support/GaitSet.h"
#include "support/Limb.h"
#include "support/Results.h"

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>
#include <osgGpuAnimation/authoring/FootContacts.h>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace osgGpuAnimation
{

namespace
{

const std::vector<Stride> strides{{"Walk", 1.0, 1.2, 0.62}, {"March", 0.8, 2.0, 0.54}, {"Run", 0.6, 3.2, 0.36}};

TEST(GroundSpeedTest, contactsAreThoseOfTheStride)
{
    const auto set = makeStridingSet(strides);
    for (const Stride& stride : strides)
        for (const char* side : {"L", "R"})
        {
            SCOPED_TRACE(std::string(stride.name) + side);
            const auto contacts = valueOf(findFootContacts(*set, stride.name, std::string("foot.") + side));
            ASSERT_EQ(contacts.size(), 1u);
            // The foot is below a fifth of its lift for a while after it leaves the ground.
            const double touch = *side == 'L' ? 0.0 : 0.5 * stride.duration;
            double error = contacts[0].touch - touch;
            if (error > 0.5 * stride.duration) error -= stride.duration;
            EXPECT_NEAR(error, 0.0, 0.05 * stride.duration);
            EXPECT_NEAR(contacts[0].leave - contacts[0].touch, stride.duty * stride.duration, 0.08 * stride.duration);
        }
    const auto hips = findFootContacts(*set, "Walk", "hips");
    ASSERT_TRUE(hips);
    ASSERT_EQ(hips.value().size(), 1u) << "it never lifts";
    EXPECT_EQ(hips.value()[0].touch, 0.0);
    EXPECT_NEAR(hips.value()[0].leave, 1.0, 1e-6);
    EXPECT_FALSE(findFootContacts(*set, "Fly", "foot.L"));
    EXPECT_FALSE(findFootContacts(*set, "Walk", "wing"));
    EXPECT_FALSE(findFootContacts(*set, 9, 0) || findFootContacts(*set, 0, 99));
}

TEST(GroundSpeedTest, aClipIsMeasuredByItsFeet)
{
    const auto set = makeStridingSet(strides);
    for (std::size_t clip = 0; clip < strides.size(); ++clip)
    {
        EXPECT_NEAR(measureGroundSpeed(*set, clip), strides[clip].speed, 0.01 * strides[clip].speed);
        EXPECT_EQ(measureGroundSpeed(*set, clip), set->knownGroundSpeed(clip));
    }
    AnimationController controller(set);
    EXPECT_FALSE(controller.layer(0).setGroundSpeed(1.0)) << "nothing plays";
    ASSERT_TRUE(controller.play("Run"));
    EXPECT_EQ(errorOf(controller.layer(0).setGroundSpeed(std::nan(""))), "a ground speed of nan: it must be finite");
    ASSERT_TRUE(controller.layer(0).setGroundSpeed(-1.6));
    EXPECT_NEAR(controller.layer(0).settings().speed, -0.5, 0.005);
    AnimationController standing(
        makeGaitSet()->withClips({ClipBuilder(makeGaitSet()->skeleton(), {}).build("Stand")}).value());
    ASSERT_TRUE(standing.play("Stand"));
    EXPECT_EQ(errorOf(standing.layer(0).setGroundSpeed(1.0)),
              "a ground speed for clip \"Stand\": its feet stand, so no speed fits; setSpeed() sets one");
    EXPECT_TRUE(standing.layer(0).setGroundSpeed(0.0));
    EXPECT_EQ(standing.layer(0).settings().speed, 1.0);
}

// The legs of a rest pose are straight, so that angles are not quite in proportion to places.
TEST(GroundSpeedTest, betweenAPoseAndAClipItIsInProportionToTheWeight)
{
    const auto bare = makeStridingSet(strides);
    std::vector<Clip> clips = bare->clips();
    clips.push_back(ClipBuilder(bare->skeleton(), {}).build("Stand"));
    const auto set = bare->withClips(clips).value();
    const auto space = BlendSpace::create(*set, std::vector<BlendSpace::Position>{{"Stand", 0}, {"Walk", 1}}).value();
    for (const double weight : {0.1, 0.25, 0.5, 0.75, 1.0})
        EXPECT_NEAR(space->groundSpeedAt(*set, {weight, 0}) / weight, 1.2, 0.12) << weight;
}

/// True if all clips that play have the foot on the ground.
bool isPlanted(const AnimationController& controller, const char* foot)
{
    const ClipMixer& mixer = controller.layer(0).mixer();
    for (std::size_t i = 0; i < mixer.activeClipCount(); ++i)
    {
        const ClipPlayback& playback = mixer.activeClip(i).playback;
        const double phase = std::fmod(playback.phase() + (foot[5] == 'R' ? 0.5 : 0.0), 1.0);
        if (phase >= strides[static_cast<std::size_t>(playback.clip())].duty) return false;
    }
    return true;
}

/// How far feet slide from the first to the last moment of each contact, by the way of the character.
double slideOf(AnimationController& controller, double speed)
{
    constexpr double frame = 1.0 / 480.0;
    double slid = 0.0, way = 0.0;
    for (const char* foot : {"foot.L", "foot.R"})
    {
        glm::dvec3 began(0.0), last(0.0);
        int frames = -1; // of the contact; below 0: the first one began before the first frame
        bool wasPlanted = true;
        for (int i = 0; i < 2400; ++i)
        {
            controller.advance(frame);
            glm::dvec3 place = placeOf(controller, foot) + glm::dvec3(0.0, 0.0, speed * frame * i);
            place.y = 0.0; // sliding is along the ground
            const bool isNow = isPlanted(controller, foot);
            if (isNow && !wasPlanted) began = place, frames = 0;
            if (isNow && wasPlanted && frames >= 0) ++frames;
            if (!isNow && wasPlanted && frames > 0)
            {
                slid += glm::distance(last, began);
                way += speed * frame * frames;
            }
            last = place;
            wasPlanted = isNow;
        }
    }
    EXPECT_GE(way, 1.0);
    return slid / way;
}

/// The strides with markers where each foot touches and leaves the ground.
std::shared_ptr<const AnimationSet> makeMarkedStrides()
{
    const auto bare = makeStridingSet(strides);
    std::vector<Clip> clips;
    for (std::size_t clip = 0; clip < strides.size(); ++clip)
    {
        std::vector<ClipMarker> markers;
        for (const char* side : {"L", "R"})
        {
            const double touch = *side == 'L' ? 0.0 : 0.5 * strides[clip].duration;
            const double leave = touch + strides[clip].duty * strides[clip].duration;
            markers.push_back({touch, std::string("touch ") + side});
            markers.push_back({std::fmod(leave, strides[clip].duration), std::string("leave ") + side});
        }
        clips.push_back(bare->clips()[clip].withMarkers(markers).value());
    }
    return bare->withClips(clips).value();
}

// A round that begins in the middle of the clips goes on past their ends.
TEST(GroundSpeedTest, theFirstMarkerMayBeAnyOfThem)
{
    const auto set = makeMarkedStrides();
    const std::vector<BlendSpace::Position> positions{{"Walk", 0.0}, {"March", 1.0}};
    const auto first = BlendSpace::create(*set, positions, {"touch L", "leave R", "touch R", "leave L"}).value();
    const auto later = BlendSpace::create(*set, positions, {"touch R", "leave L", "touch L", "leave R"}).value();
    for (const double parameter : {0.0, 0.25, 0.5, 1.0})
        EXPECT_NEAR(later->groundSpeedAt(*set, {parameter, 0}), first->groundSpeedAt(*set, {parameter, 0}), 1e-3);
    EXPECT_NEAR(later->groundSpeedAt(*set, {0, 0}), 1.2, 0.02);
}

TEST(GroundSpeedTest, betweenTwoGaitsFeetDoNotSlide)
{
    const auto set = makeMarkedStrides();
    struct Case
    {
        const char *first, *second;
        double from, to;
        std::vector<std::string> markers;
    };
    const Case cases[] = {
        {"Walk", "March", 1.2, 2.0, {"touch L", "leave R", "touch R", "leave L"}},
        {"Walk", "March", 1.2, 2.0, {}},
        {"Walk", "Run", 1.2, 3.2, {}},
        {"March", "Run", 2.0, 3.2, {}},
    };
    for (const Case& c : cases)
    {
        SCOPED_TRACE(std::string(c.first) + " to " + c.second + (c.markers.empty() ? "" : " with markers"));
        const auto space = valueOf(BlendSpace::create(*set, {{c.first, c.from}, {c.second, c.to}}, c.markers));
        for (int step = 0; step <= 16; ++step)
        {
            const double speed = c.from + (c.to - c.from) * step / 16.0;
            AnimationController controller = playing(set, space);
            ASSERT_TRUE(controller.setParameter(speed));
            ASSERT_TRUE(controller.layer(0).setGroundSpeed(speed));
            EXPECT_LE(slideOf(controller, speed), 0.01) << speed;
        }
    }
}

} // namespace
} // namespace osgGpuAnimation
