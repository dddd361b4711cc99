// SPDX-License-Identifier: MIT
#include "gltf/Import.h"
#include "plugin/SharedAssets.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>
#include <osgGpuAnimation/authoring/FootContacts.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

// The ground speeds of the gaits of real characters, in their own units, against those of their named feet.

namespace osgGpuAnimation::gltf
{

namespace
{

struct GaitCase
{
    const char* file; ///< below the shared folder, or one of our own scenes
    const char* clip;
    std::vector<const char*> feet;
    double least, most; ///< of the ground speed
    double slide; ///< most way that the named feet slide in the middle of their contacts, by the way of the character
};

void PrintTo(const GaitCase& gait, std::ostream* out)
{
    *out << gait.file << " " << gait.clip;
}

class GroundSpeedOfModelsTest : public ::testing::TestWithParam<GaitCase>
{
};

double forwardOf(const AnimationSet& set, std::size_t clip, std::size_t joint, double time)
{
    PoseInstruction instruction;
    instruction.samples[0] = set.sampleAt(static_cast<int>(clip), time);
    return static_cast<double>(Pose::jointToModel(set, instruction, joint).rows[2].w); // all of them walk along +Z
}

TEST_P(GroundSpeedOfModelsTest, IsThatOfTheFeet)
{
    const GaitCase& gait = GetParam();
    const std::string file = modelFile(gait.file);
    if (file.empty()) GTEST_SKIP() << "there is no " << gait.file << " in " << OSGGPUANIMATION_SHARED_ASSETS;
    const Result<ImportedModel> model = importModel(readBytes(file), file, {});
    ASSERT_TRUE(model) << model.error().message;
    const AnimationSet& set = *model.value().set;
    const std::size_t clip = set.clipNamed(gait.clip).value();
    const double speed = measureGroundSpeed(set, clip);
    EXPECT_GE(speed, gait.least);
    EXPECT_LE(speed, gait.most);

    AnimationController controller(model.value().set);
    ASSERT_TRUE(controller.play(clip));
    ASSERT_TRUE(controller.layer(0).setGroundSpeed(2.0 * speed));
    EXPECT_DOUBLE_EQ(controller.speed(), 2.0);

    double way = 0.0, seconds = 0.0;
    const double duration = controller.duration();
    for (const char* name : gait.feet)
    {
        const std::size_t joint = set.skeleton().jointNamed(name).value();
        const auto contacts = findFootContacts(set, clip, joint);
        ASSERT_TRUE(contacts);
        EXPECT_GE(contacts.value().size(), 1u) << name;
        EXPECT_LE(contacts.value().size(), 2u) << name;
        for (const FootContact& contact : contacts.value())
        {
            // The middle of a contact: a foot rolls while it touches and leaves.
            const double length = contact.leave - contact.touch;
            const double from = std::fmod(contact.touch + 0.25 * length, duration);
            const double to = std::fmod(contact.touch + 0.75 * length, duration);
            way += forwardOf(set, clip, joint, from) - forwardOf(set, clip, joint, to);
            seconds += 0.5 * length;
        }
    }
    const double slide = way / seconds / speed - 1.0;
    std::printf("%s %s: %.4f units a second, the named feet slide by %.1f %%\n", gait.file, gait.clip, speed,
                100.0 * slide);
    EXPECT_LE(std::abs(slide), gait.slide);
}

INSTANTIATE_TEST_SUITE_P(
    Gaits, GroundSpeedOfModelsTest,
    ::testing::Values(GaitCase{"Wanderer.glb", "Walk", {"Toes_L", "Toes_R"}, 0.70, 0.72, 0.02},
                      GaitCase{"Wanderer.glb", "Run", {"Toes_L", "Toes_R"}, 2.05, 2.15, 0.02},
                      GaitCase{"assets/Knight/Knight.glb", "Walking_A", {"toes.l", "toes.r"}, 0.6, 0.9, 0.2},
                      GaitCase{"assets/Knight/Knight.glb", "Running_A", {"toes.l", "toes.r"}, 3.5, 4.7, 0.2},
                      GaitCase{"assets/Fox/Fox.glb",
                               "Walk",
                               {"b_RightHand_08", "b_LeftHand_011", "b_RightFoot02_022", "b_LeftFoot02_018"},
                               70,
                               160,
                               0.3},
                      GaitCase{"assets/Fox/Fox.glb",
                               "Run",
                               {"b_RightHand_08", "b_LeftHand_011", "b_RightFoot02_022", "b_LeftFoot02_018"},
                               70,
                               400,
                               0.3}));

} // namespace

} // namespace osgGpuAnimation::gltf
