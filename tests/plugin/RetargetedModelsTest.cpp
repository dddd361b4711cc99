// SPDX-License-Identifier: MIT
#include "gltf/Import.h"
#include "plugin/SharedAssets.h"
#include "support/RandomSet.h"
#include <osgGpuAnimation/authoring/WithClipsOf.h>

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/authoring/retarget/RigMatch.h>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation::gltf
{

namespace
{

using SetPointer = std::shared_ptr<const AnimationSet>;

SetPointer setOf(const std::string& bytes)
{
    const Result<ImportedModel> model = importModel(bytes, "", {});
    EXPECT_TRUE(model) << model.error().message;
    return model ? model.value().set : nullptr;
}

/// Rotations and places of all joints in model space.
struct PlacedJoints
{
    std::vector<glm::dquat> rotations;
    std::vector<double> heights;

    PlacedJoints(const AnimationSet& set, int clip, double time)
    {
        std::vector<JointTransform> tracks(set.trackCount());
        Pose::mix(set, instructionAt(set, clip, time), tracks);
        std::vector<AffineMatrix> toModel(set.skeleton().jointCount());
        Pose::jointToModel(set, tracks, AffineMatrix(), toModel);
        for (std::size_t joint = 0; joint < toModel.size(); ++joint)
        {
            const glm::dquat local = RestPose::unitOf(tracks[joint].rotation);
            const int parent = set.skeleton().joint(joint).parent;
            rotations.push_back(parent < 0 ? local : rotations[static_cast<std::size_t>(parent)] * local);
            heights.push_back(static_cast<double>(toModel[joint].rows[1].w));
        }
    }
};

/// All clips of the Knight, at their keyframes and between them.
TEST(RetargetedModelsTest, theWandererMovesAsTheKnightDoes)
{
    SKIP_WITHOUT_SHARED_FILE("assets/Knight/Knight.glb");
    const SetPointer knight = setOf(readBytes(sharedFile("assets/Knight/Knight.glb")));
    const SetPointer wanderer = setOf(readBytes(ownScene("Wanderer.glb")));
    RetargetOptions options;
    options.counterparts = {
        {"Armature", "root"}, {"Hips", "hips"}, {"Spine", "spine"}, {"Chest", "chest"}, {"Head", "head"}};
    std::vector<std::string> feet;
    for (const auto& [own, other] : {std::pair("_L", ".l"), std::pair("_R", ".r")})
    {
        for (const auto& [bone, counterpart] :
             {std::pair("UpperArm", "upperarm"), std::pair("LowerArm", "lowerarm"), std::pair("Hand", "wrist"),
              std::pair("UpperLeg", "upperleg"), std::pair("LowerLeg", "lowerleg"), std::pair("Foot", "foot"),
              std::pair("Toes", "toes")})
            options.counterparts[std::string(bone) + own] = std::string(counterpart) + other;
        feet.push_back(std::string("Foot") + own);
        feet.push_back(std::string("Toes") + own);
    }
    const double ratio = (0.72 - 0.03) / (0.519 - 0.026); // of the legs at rest
    const double height = 1.55;
    const Result<RetargetedSet> result = withClipsOf(*wanderer, *knight, options);
    ASSERT_TRUE(result) << result.error().message;
    const AnimationSet &from = *knight, &made = *result.value().set;
    const RigMatch match =
        RigMatch::create({from.skeleton(), from.morphs()}, {made.skeleton(), made.morphs()}, options).value();
    ASSERT_EQ(match.bodies().size(), 1u);
    EXPECT_NEAR(match.bodies()[0].ratio, ratio, 1e-3);
    const PlacedJoints fromRest(from, -1, 0.0), toRest(made, -1, 0.0);
    const auto isFoot = [&](std::size_t joint)
    { return std::find(feet.begin(), feet.end(), made.skeleton().joint(joint).name) != feet.end(); };
    double worstAngle = 0.0, worstFoot = 0.0;
    for (std::size_t clip = 0; clip < from.clips().size(); ++clip)
        for (std::size_t k = 0; k < from.clips()[clip].keyframeCount(); ++k)
            for (const double alpha : {0.0, 0.5})
            {
                const std::vector<float>& times = from.clips()[clip].times();
                const double next = static_cast<double>(times[std::min(k + 1, times.size() - 1)]);
                const double time = static_cast<double>(times[k]) * (1.0 - alpha) + next * alpha;
                const PlacedJoints wanted(from, static_cast<int>(clip), time);
                const PlacedJoints shown(made, static_cast<int>(wanderer->clips().size() + clip), time);
                double lowest = 1e9, lowestWanted = 1e9;
                for (const JointMatch& joint : match.joints())
                {
                    const glm::dquat a =
                        wanted.rotations[joint.source] * glm::conjugate(fromRest.rotations[joint.source]);
                    const glm::dquat b = shown.rotations[joint.joint] * glm::conjugate(toRest.rotations[joint.joint]);
                    const glm::dquat apart = glm::conjugate(a) * b;
                    const double sine = glm::length(glm::dvec3(apart.x, apart.y, apart.z));
                    worstAngle = std::max(worstAngle, 2.0 * std::asin(std::min(sine, 1.0)));
                    if (!isFoot(joint.joint)) continue;
                    lowest = std::min(lowest, shown.heights[joint.joint] - toRest.heights[joint.joint]);
                    lowestWanted =
                        std::min(lowestWanted, wanted.heights[joint.source] - fromRest.heights[joint.source]);
                }
                // Feet on the ground; in jumps and lying down other parts of the body may be lower.
                const bool stands = std::abs(ratio * lowestWanted) < 0.02 * height;
                if (stands && alpha == 0.0) worstFoot = std::max(worstFoot, std::abs(lowest - ratio * lowestWanted));
            }
    EXPECT_LE(worstAngle, 1e-5); // radians
    EXPECT_LE(worstFoot, 0.01 * height);
}

} // namespace

} // namespace osgGpuAnimation::gltf
