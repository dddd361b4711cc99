// SPDX-License-Identifier: MIT
#include "gltf/Import.h"
#include "plugin/SharedAssets.h"
#include "plugin/SplitModel.h"
#include "support/RandomSet.h"

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/animation/retarget/RigMatch.h>

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

struct RetargetCase
{
    SetPointer from, to;
    RetargetOptions options;
    std::vector<std::string> feet; ///< joints of `to`
    double ratio;                  ///< of the legs
    double height;                 ///< of `to`
};

/// Compares all clips of `from` with what `to` makes of them, at their keyframes and between them.
void compare(const RetargetCase& one)
{
    const Result<RetargetedSet> result = one.to->withClipsOf(*one.from, one.options);
    ASSERT_TRUE(result) << result.error().message;
    const AnimationSet &from = *one.from, &made = *result.value().set;
    const RigMatch match =
        RigMatch::create({from.skeleton(), from.morphs()}, {made.skeleton(), made.morphs()}, one.options).value();
    ASSERT_EQ(match.bodies().size(), 1u);
    EXPECT_NEAR(match.bodies()[0].ratio, one.ratio, 1e-3);
    const PlacedJoints fromRest(from, -1, 0.0), toRest(made, -1, 0.0);
    const auto isFoot = [&](std::size_t joint)
    { return std::find(one.feet.begin(), one.feet.end(), made.skeleton().joint(joint).name) != one.feet.end(); };
    double worstAngle = 0.0, worstFoot = 0.0;
    for (std::size_t clip = 0; clip < from.clips().size(); ++clip)
        for (std::size_t k = 0; k < from.clips()[clip].keyframeCount(); ++k)
            for (const double alpha : {0.0, 0.5})
            {
                const std::vector<float>& times = from.clips()[clip].times();
                const double next = static_cast<double>(times[std::min(k + 1, times.size() - 1)]);
                const double time = static_cast<double>(times[k]) * (1.0 - alpha) + next * alpha;
                const PlacedJoints wanted(from, static_cast<int>(clip), time);
                const PlacedJoints shown(made, static_cast<int>(one.to->clips().size() + clip), time);
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
                const bool stands = std::abs(one.ratio * lowestWanted) < 0.02 * one.height;
                if (stands && alpha == 0.0)
                    worstFoot = std::max(worstFoot, std::abs(lowest - one.ratio * lowestWanted));
            }
    EXPECT_LE(worstAngle, 1e-5); // radians
    EXPECT_LE(worstFoot, 0.01 * one.height);
    ::testing::Test::RecordProperty("angle", std::to_string(worstAngle));
    ::testing::Test::RecordProperty("foot", std::to_string(worstFoot / one.height));
}

TEST(RetargetedModelsTest, theWandererMovesAsTheKnightDoes)
{
    SKIP_WITHOUT_SHARED_FILE("assets/Knight/Knight.glb");
    RetargetCase one;
    one.from = setOf(readBytes(sharedFile("assets/Knight/Knight.glb")));
    one.to = setOf(readBytes(ownScene("Wanderer.glb")));
    one.options.counterparts = {
        {"Armature", "root"}, {"Hips", "hips"}, {"Spine", "spine"}, {"Chest", "chest"}, {"Head", "head"}};
    for (const auto& [own, other] : {std::pair("_L", ".l"), std::pair("_R", ".r")})
    {
        for (const auto& [bone, counterpart] :
             {std::pair("UpperArm", "upperarm"), std::pair("LowerArm", "lowerarm"), std::pair("Hand", "wrist"),
              std::pair("UpperLeg", "upperleg"), std::pair("LowerLeg", "lowerleg"), std::pair("Foot", "foot"),
              std::pair("Toes", "toes")})
            one.options.counterparts[std::string(bone) + own] = std::string(counterpart) + other;
        one.feet.push_back(std::string("Foot") + own);
        one.feet.push_back(std::string("Toes") + own);
    }
    one.ratio = (0.72 - 0.03) / (0.519 - 0.026); // of the legs at rest
    one.height = 1.55;
    compare(one);
}

TEST(RetargetedModelsTest, aFoxWithTwiceTheLegsMovesAsTheFoxDoes)
{
    SKIP_WITHOUT_SHARED_FILE("assets/Fox/Fox.glb");
    const std::string fox = readBytes(sharedFile("assets/Fox/Fox.glb"));
    SplitModel tall(fox);
    const double leg = 49.27 - 0.99; // hind legs, from the joint of the thigh to that of the toes
    for (nlohmann::json& node : tall.document()["nodes"])
    {
        const std::string name = node.value("name", "");
        const bool isHind = name.find("Leg02") != std::string::npos || name.find("Foot") != std::string::npos;
        const bool isFore = name.find("ForeArm") != std::string::npos || name.find("Hand") != std::string::npos;
        for (nlohmann::json& number : node["translation"])
            if (isHind || isFore) number = 2.0 * number.get<double>();
        if (name == "b_Hip_01") node["translation"][2] = node["translation"][2].get<double>() + leg;
        if (node["translation"].is_null()) node.erase("translation");
    }
    RetargetCase one;
    one.from = setOf(fox);
    one.to = setOf(tall.mesh());
    one.feet = {"b_LeftFoot02_018", "b_RightFoot02_022", "b_LeftHand_011", "b_RightHand_08"};
    one.ratio = 2.0;
    one.height = 79.0 + leg;
    compare(one);
}

} // namespace

} // namespace osgGpuAnimation::gltf
