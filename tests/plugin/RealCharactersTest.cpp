// SPDX-License-Identifier: MIT
#include "gltf/Import.h"
#include "gltf/ImportedFile.h"
#include "gltf/ModelImport.h"
#include "plugin/PluginFolder.h"
#include "plugin/SharedAssets.h"
#include "support/MadeLevels.h"
#include "support/RandomSet.h"
#include "support/ShownSurface.h"

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/authoring/retarget/RigMatch.h>
#include <osgGpuAnimation/authoring/WithClipsOf.h>
#include <osgGpuAnimation/math/Rotation.h>
#include <osgGpuAnimation/mesh/lod/CharacterLevels.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/GroundFeet.h>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>
#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osgDB/ReadFile>
#include <osgUtil/UpdateVisitor>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <map>
#include <random>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

using SetPointer = std::shared_ptr<const AnimationSet>;

/// Rotations and places of all joints in model space.
struct PlacedJoints
{
    std::vector<glm::dquat> rotations;
    std::vector<glm::dvec3> origins;

    PlacedJoints(const AnimationSet& set, int clip, double time)
    {
        std::vector<JointTransform> tracks(set.trackCount());
        Pose::mix(set, instructionAt(set, clip, time), tracks);
        std::vector<AffineMatrix> toModel(set.skeleton().jointCount());
        Pose::jointToModel(set, tracks, AffineMatrix(), toModel);
        for (std::size_t joint = 0; joint < toModel.size(); ++joint)
        {
            const glm::dquat local = Rotation::unitQuaternion(tracks[joint].rotation);
            const int parent = set.skeleton().joint(joint).parent;
            rotations.push_back(parent < 0 ? local : rotations[static_cast<std::size_t>(parent)] * local);
            origins.push_back(glm::dvec3(toModel[joint].transformPoint(glm::vec3(0.0f))));
        }
    }
};

/// All clips of the Knight, at their keyframes and between them.
TEST(RetargetedModelsTest, theWandererMovesAsTheKnightDoes)
{
    SKIP_WITHOUT_SHARED_FILE("assets/Knight/Knight.glb");
    const SetPointer knight = imported(readBytes(sharedFile("assets/Knight/Knight.glb"))).set;
    const SetPointer wanderer = imported(readBytes(ownScene("Wanderer.glb"))).set;
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
    const double height = 1.55;
    const Result<RetargetedSet> result = withClipsOf(*wanderer, *knight, options);
    ASSERT_TRUE(result) << result.error().message;
    const AnimationSet &from = *knight, &made = *result.value().set;
    const RigMatch match =
        RigMatch::create({from.skeleton(), from.morphs()}, {made.skeleton(), made.morphs()}, options).value();
    ASSERT_EQ(match.bodies().size(), 1u);
    const PlacedJoints fromRest(from, -1, 0.0), toRest(made, -1, 0.0);
    const auto legOf = [](const AnimationSet& set, const PlacedJoints& rest, const char* hip, const char* toes)
    {
        const auto at = [&](const char* name)
        { return rest.origins[static_cast<std::size_t>(set.skeleton().findJoint(name))]; };
        return glm::distance(at(hip), at(toes));
    };
    const double ratio = legOf(made, toRest, "UpperLeg_L", "Toes_L") / legOf(from, fromRest, "upperleg.l", "toes.l");
    EXPECT_NEAR(ratio, 1.388, 1e-3);
    EXPECT_NEAR(match.bodies()[0].ratio, ratio, 1e-6);
    const auto isFoot = [&](std::size_t joint)
    { return std::find(feet.begin(), feet.end(), made.skeleton().joint(joint).name) != feet.end(); };
    const auto endsLimb = [&](std::size_t joint)
    {
        const std::string& name = made.skeleton().joint(joint).name;
        return name.find("Lower") == 0 || name.find("Hand") == 0 || name.find("Foot") == 0;
    };
    const double soles = toRest.origins[static_cast<std::size_t>(made.skeleton().findJoint("Toes_L"))].y;
    double worstAngle = 0.0, worstFoot = 0.0, worstBone = 0.0;
    int standing = 0; // keyframes
    for (std::size_t clip = 0; clip < from.clips().size(); ++clip)
        for (std::size_t k = 0; k < from.clips()[clip].keyframeCount(); ++k)
            for (const double alpha : {0.0, 0.5})
            {
                const std::vector<float>& times = from.clips()[clip].times();
                const double next = static_cast<double>(times[std::min(k + 1, times.size() - 1)]);
                const double time = static_cast<double>(times[k]) * (1.0 - alpha) + next * alpha;
                const PlacedJoints wanted(from, static_cast<int>(clip), time);
                const PlacedJoints shown(made, static_cast<int>(wanderer->clips().size() + clip), time);
                double lowest = 1e9, lowestWanted = 1e9, lowestOther = 1e9;
                for (const JointMatch& joint : match.joints())
                {
                    const glm::dquat a =
                        wanted.rotations[joint.source] * glm::conjugate(fromRest.rotations[joint.source]);
                    const glm::dquat b =
                        shown.rotations[joint.joint] * glm::conjugate(match.toRest().rotations[joint.joint]);
                    const glm::dquat apart = glm::conjugate(a) * b;
                    const double sine = glm::length(glm::dvec3(apart.x, apart.y, apart.z));
                    worstAngle = std::max(worstAngle, 2.0 * std::asin(std::min(sine, 1.0)));
                    if (const int own = made.skeleton().joint(joint.joint).parent; endsLimb(joint.joint))
                    {
                        const auto bone = [](const PlacedJoints& pose, std::size_t end, int start)
                        { return glm::normalize(pose.origins[end] - pose.origins[static_cast<std::size_t>(start)]); };
                        worstBone = std::max(worstBone, glm::distance(bone(shown, joint.joint, own),
                                                                      bone(wanted, joint.source, joint.above)));
                    }
                    if (!isFoot(joint.joint))
                    {
                        if (!joint.movesBody) lowestOther = std::min(lowestOther, shown.origins[joint.joint].y - soles);
                        continue;
                    }
                    lowest = std::min(lowest, shown.origins[joint.joint].y - toRest.origins[joint.joint].y);
                    lowestWanted =
                        std::min(lowestWanted, wanted.origins[joint.source].y - fromRest.origins[joint.source].y);
                }
                // Feet on the ground; in jumps, lying down and getting up, other parts of the body may be lower.
                const bool stands = std::abs(ratio * lowestWanted) < 0.02 * height && lowest < lowestOther;
                if (!stands || alpha != 0.0) continue;
                ++standing;
                worstFoot = std::max(worstFoot, std::abs(lowest - ratio * lowestWanted));
            }
    EXPECT_LE(worstAngle, 1e-5); // radians
    EXPECT_LE(worstBone, 1e-5);
    EXPECT_GT(standing, 2200);
    EXPECT_LE(worstFoot, 0.01 * height);
}

} // namespace

// The levels of detail of real characters as a whole: every vertex at random times is as near to them as they say.

namespace
{

class CharacterLevelsOfModelsTest : public ::testing::TestWithParam<std::string>
{
};

TEST_P(CharacterLevelsOfModelsTest, stayWithinTheirErrorAtRandomTimes)
{
    ImportedModel model;
    importOrSkip(GetParam(), model);
    if (IsSkipped() || HasFatalFailure()) return;
    const auto levels = madeLevels(*model.character, *model.set);
    ASSERT_NE(levels->finest(), LodLevels::allTriangles);
    const LodRange range(*model.character, *model.set, levels); // of what the meshes are at a level: merged or not
    std::mt19937 random(23);
    std::vector<std::size_t> triangles;
    for (int level = levels->finest(); level <= levels->coarsest(); ++level)
    {
        EXPECT_LE(levels->foundError(level), (1.0 + 1e-6) * LodLevels::errorOf(level)) << "sums of floats";
        for (int instance = 0; instance < 5; ++instance)
        {
            const std::size_t clip = random() % model.set->clips().size();
            const double share = static_cast<double>(random() % 10000) / 1e4;
            PoseInstruction pose; // the first instance: at rest
            if (instance > 0)
                pose.samples[0] =
                    model.set->sampleAt(static_cast<int>(clip), share * model.set->clips()[clip].duration());
            std::vector<AffineMatrix> palette;
            Pose::evaluate(*model.set, pose, AffineMatrix(), palette);
            const ShownSurface surface(*model.character, *model.set, levels.get(), level, palette);
            const double limit = range.foundError(level);
            // It was measured at other times.
            EXPECT_LE(surface.largestDistance(palette, limit), 1.01 * limit) << level;
            if (instance == 0) triangles.push_back(surface.triangleCount());
        }
    }
    EXPECT_TRUE(std::is_sorted(triangles.rbegin(), triangles.rend())) << "fewer from level to level";
    EXPECT_LE(triangles.back(), 140u);
}

INSTANTIATE_TEST_SUITE_P(Models, CharacterLevelsOfModelsTest,
                         ::testing::Values("Wanderer.glb", "Serpent.glb", "assets/Fox/Fox.glb",
                                           "assets/CesiumMan/CesiumMan.glb", "assets/Knight/Knight.glb"),
                         [](const auto& info) { return nameOfFile(info.param); });

constexpr const char* foxFile = OSGGPUANIMATION_SHARED_ASSETS "/assets/Fox/Fox.glb";
constexpr double scale = 0.011; ///< of the fox's units in metres

struct FoxLeg
{
    const char *start, *mid, *end, *toe; ///< toe: "" for none
};

const FoxLeg foxLegs[] = {{"b_LeftUpperArm_09", "b_LeftForeArm_010", "b_LeftHand_011", ""},
                          {"b_RightUpperArm_06", "b_RightForeArm_07", "b_RightHand_08", ""},
                          {"b_LeftLeg01_015", "b_LeftLeg02_016", "b_LeftFoot01_017", "b_LeftFoot02_018"},
                          {"b_RightLeg01_019", "b_RightLeg02_020", "b_RightFoot01_021", "b_RightFoot02_022"}};

/// The least height of each paw's joint above the ground, in metres, in two seconds of walking along -Y. slope:
/// radians, above 0 uphill.
std::vector<double> leastHeights(double slope)
{
    const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(foxFile);
    AnimatedCharacter* fox = findCharacter(*node);
    std::vector<Constraint> constraints;
    std::vector<GroundLeg> legs;
    for (const FoxLeg& leg : foxLegs)
    {
        constraints.push_back(TwoBoneIk{leg.end, leg.start, leg.mid, leg.end});
        legs.push_back({leg.end, leg.toe});
    }
    EXPECT_TRUE(fox->setAnimationSet(fox->getAnimationSet().withConstraints(constraints).value()));
    EXPECT_TRUE(fox->getController().play("Walk"));
    const AnimationSet& set = fox->getAnimationSet();
    const double step = measureGroundSpeed(set, set.clipNamed("Walk").value()) / 60.0;

    const double rise = std::tan(slope);
    const osg::ref_ptr<osg::Geometry> ground = osg::createTexturedQuadGeometry(
        {-9, -9, static_cast<float>(9 * rise)}, osg::Vec3(18, 0, 0), osg::Vec3(0, 18, static_cast<float>(-18 * rise)));
    const osg::ref_ptr<osg::MatrixTransform> scaled = new osg::MatrixTransform(osg::Matrix::scale(scale, scale, scale));
    scaled->addChild(node);
    const osg::ref_ptr<GroundFeet> feet = new GroundFeet(*ground);
    EXPECT_TRUE(feet->setLegs(set, legs));
    fox->addUpdateCallback(feet);

    const osg::ref_ptr<osgUtil::UpdateVisitor> visitor = new osgUtil::UpdateVisitor;
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    visitor->setFrameStamp(stamp);
    std::vector<double> least(std::size(foxLegs), HUGE_VAL);
    for (unsigned int frame = 0; frame < 120; ++frame)
    {
        stamp->setFrameNumber(frame);
        stamp->setSimulationTime(frame / 60.0);
        fox->setMatrix(osg::Matrix::translate(0, -step, 0) * fox->getMatrix());
        scaled->accept(*visitor);
        for (std::size_t i = 0; i < least.size(); ++i)
        {
            const FoxLeg& leg = foxLegs[i];
            const osg::Matrixd paw = fox->jointToModel(*leg.toe ? leg.toe : leg.end).value();
            const osg::Vec3d place = paw.getTrans() * fox->getMatrix() * scaled->getMatrix();
            least[i] = std::min(least[i], place.z() + rise * place.y());
        }
    }
    return least;
}

} // namespace

// The front paws are half a metre before the hind paws, whose ground decides the height of the fox.
TEST(FoxFeetTest, aQuadrupedReachesTheGroundOfASlope)
{
    if (!std::filesystem::exists(foxFile)) GTEST_SKIP() << "there is no " << foxFile;
    usePluginsOfTheBuild();
    for (const double slope : {-0.3, 0.0, 0.3, 0.4})
        for (const double height : leastHeights(slope))
        {
            EXPECT_GE(height, -1e-3) << slope;
            EXPECT_LE(height, 0.15) << slope << ": the paw never touches the ground";
        }
}

} // namespace osgGpuAnimation::gltf
