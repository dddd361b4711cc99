// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/Pose.h>

#include "support/AdditiveExtremes.h"
#include "support/RandomCharacter.h"
#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/keyframes/TrackBlend.h>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace osgGpuAnimation
{

namespace
{

double difference(const glm::dmat4& a, const glm::dmat4& b)
{
    double worst = 0.0;
    for (int c = 0; c < 4; ++c)
        worst = std::max(worst, glm::length(a[c] - b[c]));
    return worst;
}

std::shared_ptr<const AnimationSet> makeSet(RandomCharacter& character)
{
    const Skeleton skeleton = character.skeleton();
    std::vector<Skin> skins(2);
    for (Skin& skin : skins)
        for (int joint = 0; joint < static_cast<int>(character.joints.size()); ++joint)
        {
            JointTransform bind;
            for (int c = 0; c < 4; ++c)
                bind.rotation[c] = static_cast<float>(character.number(-1, 1));
            for (int c = 0; c < 3; ++c)
            {
                bind.translation[c] = static_cast<float>(character.number(-1, 1));
                bind.scale[c] = static_cast<float>(character.number(0.5, 2));
            }
            skin.joints.push_back(joint);
            skin.inverseBinds.push_back(bind.toMatrix());
        }
    const auto set = AnimationSet::create({skeleton, skins, {0, 1, 2}, character.morphs, {character.clip(skeleton)}});
    EXPECT_TRUE(set) << set.error().message;
    return set.value();
}

AffineMatrix someRoot()
{
    return JointTransform{{1, 2, -1, 0}, {0.3f, 0.2f, -0.4f, 1.0f}, {1.5, 1.5, 1.5, 0}}.toMatrix();
}

/// The palette by the shaders' chain of matrices, as documented for PaletteEntry.
std::vector<AffineMatrix> paletteByChain(const AnimationSet& set, const std::vector<JointTransform>& tracks,
                                         const AffineMatrix& root)
{
    std::vector<AffineMatrix> result;
    for (const PaletteEntry& entry : set.palette())
    {
        if (entry.kind == PaletteEntry::Kind::Weights)
        {
            const JointTransform& block = tracks[static_cast<std::size_t>(entry.track)];
            result.emplace_back();
            result.back().rows = {block.translation, block.rotation, block.scale};
            continue;
        }
        const AffineMatrix above = entry.parent < 0 ? root : result[static_cast<std::size_t>(entry.parent)];
        const AffineMatrix local =
            entry.track < 0 ? AffineMatrix() : tracks[static_cast<std::size_t>(entry.track)].toMatrix();
        result.push_back(above * entry.parentBind * local * entry.inverseBind);
    }
    return result;
}

TEST(PoseTest, MatricesAreWhatTheKeysSay)
{
    for (unsigned seed = 1; seed <= 30; ++seed)
    {
        SCOPED_TRACE("seed " + std::to_string(seed));
        RandomCharacter character(seed, {});
        const auto set = makeSet(character);
        AnimationController controller(set);
        controller.setLoopMode(AnimationController::LoopMode::Once);
        ASSERT_TRUE(controller.play(0));
        for (int i = 0; i < 40; ++i)
        {
            const double time = character.number(0.0, controller.duration());
            ASSERT_TRUE(controller.seek(time));
            std::vector<JointTransform> tracks;
            std::vector<AffineMatrix> joints, palette, all;
            Pose::mix(*set, controller.instruction(), tracks);
            Pose::jointToModel(*set, tracks, someRoot(), joints);
            Pose::palette(*set, tracks, joints, palette);
            Pose::evaluate(*set, controller.instruction(), someRoot(), all);
            ASSERT_EQ(all.size(), set->paletteSize());
            EXPECT_EQ(std::memcmp(all.data(), palette.data(), all.size() * sizeof(AffineMatrix)), 0);

            const std::vector<glm::dmat4> expected = character.expectedJointToModel(time);
            for (std::size_t j = 0; j < expected.size(); ++j)
            {
                const auto joint = static_cast<std::size_t>(set->skeleton().jointOfInput(j));
                const glm::dmat4 wanted = someRoot().toColumns() * expected[j];
                // Rounding on up to eight levels, scales of up to 1.5 * 1.4^8.
                EXPECT_LE(difference(joints[joint].toColumns(), wanted),
                          5e-5 * (1 + difference(wanted, glm::dmat4(0))));
                for (std::size_t s = 0; s < 2; ++s)
                {
                    const glm::dmat4 entry = wanted * set->skins()[s].inverseBinds[joint].toColumns();
                    const auto index = static_cast<std::size_t>(set->entryOfSkin(s, joint));
                    EXPECT_LE(difference(palette[index].toColumns(), entry),
                              5e-6 * (1 + difference(entry, glm::dmat4(0))));
                }
            }
        }
    }
}

TEST(PoseTest, TheShadersChainGivesTheSamePalette)
{
    double worst = 0.0;
    for (unsigned seed = 1; seed <= 40; ++seed)
    {
        RandomCharacter character(seed, {});
        const auto set = makeSet(character);
        AnimationController controller(set);
        ASSERT_TRUE(controller.play(0));
        for (int i = 0; i < 20; ++i)
        {
            std::vector<JointTransform> tracks;
            std::vector<AffineMatrix> palette;
            Pose::mix(*set, controller.advance(0.13), tracks);
            Pose::evaluate(*set, controller.instruction(), someRoot(), palette);
            const std::vector<AffineMatrix> chain = paletteByChain(*set, tracks, someRoot());
            for (std::size_t e = 0; e < palette.size(); ++e)
            {
                const glm::dmat4 plain = palette[e].toColumns();
                worst =
                    std::max(worst, difference(plain, chain[e].toColumns()) / (1 + difference(plain, glm::dmat4(0))));
            }
        }
    }
    EXPECT_LE(worst, 1e-5);
}

class PoseBlendTest : public testing::Test
{
protected:
    static glm::vec4 turnAboutZ(double radians)
    {
        return glm::vec4(0.0, 0.0, std::sin(radians / 2), std::cos(radians / 2));
    }

    /// Two clips of one keyframe: x = 2 turned by 0.4, and x = 6 turned by 0.8 with the opposite sign. Rest pose: x =
    /// 10, turned by 0.
    PoseBlendTest()
    {
        Joint joint;
        joint.rest.translation.x = 10;
        const Skeleton skeleton = Skeleton::create({joint}).value();
        const std::vector<MorphWeights> morphs{{"face", -1, {1, 1, 1, 1, 1, -1}}};
        std::vector<Clip> clips{clip(skeleton, morphs, 2, turnAboutZ(0.4)),
                                clip(skeleton, morphs, 6, -turnAboutZ(0.8))};
        _set = AnimationSet::create({skeleton, {}, {}, morphs, clips}).value();
    }

    static Clip clip(const Skeleton& skeleton, const std::vector<MorphWeights>& morphs, double x, const glm::vec4& turn)
    {
        ClipBuilder builder(skeleton, morphs);
        Channel rotation{Channel::Path::Rotation, Channel::Interpolation::Linear, 0, {0}, {}};
        for (int c = 0; c < 4; ++c)
            rotation.values.push_back(static_cast<double>(turn[c]));
        EXPECT_TRUE(builder.add({Channel::Path::Translation, Channel::Interpolation::Linear, 0, {0}, {x, 0, 0}}));
        EXPECT_TRUE(builder.add(rotation));
        EXPECT_TRUE(builder.add({Channel::Path::Weights, Channel::Interpolation::Linear, 0, {0}, {0, 0, 0, 0, x, x}}));
        return builder.build("clip");
    }

    std::vector<JointTransform> mix(const std::vector<float>& weights) const
    {
        PoseInstruction instruction;
        instruction.sampleCount = weights.size();
        for (std::size_t i = 0; i < weights.size(); ++i)
        {
            instruction.samples[i].keyframe = static_cast<std::uint32_t>(_set->firstKeyframe(i % 2));
            instruction.samples[i].weight = weights[i];
        }
        std::vector<JointTransform> tracks;
        Pose::mix(*_set, instruction, tracks);
        return tracks;
    }

    std::shared_ptr<const AnimationSet> _set;
};

TEST_F(PoseBlendTest, WeightsShareThePoseAndTheRestPoseFillsWhatTheyLack)
{
    const float none = std::nanf("");
    struct Case
    {
        const char* name;
        std::vector<float> weights;
        float x;
        double turn;
        float weight; ///< the fifth morph weight: joints have a rotation in its slot
    };
    const Case cases[] = {
        {"one", {1.0f}, 2.0f, 0.4, 2.0f},
        {"the other", {0.0f, 1.0f}, 6.0f, 0.8, 6.0f},
        {"half and half, signs opposite", {0.5f, 0.5f}, 4.0f, 0.6, 4.0f},
        {"half and rest", {0.5f}, 6.0f, 0.2, 1.5f},
        {"nothing but rest", {0.0f, 0.0f}, 10.0f, 0.0, 1.0f},
        {"more than 1 is shared out", {2.0f, 2.0f}, 4.0f, 0.6, 4.0f},
        {"negative and NaN count as 0", {-3.0f, 1.0f, none}, 6.0f, 0.8, 6.0f},
        {"all eight", std::vector<float>(8, 0.125f), 4.0f, 0.6, 4.0f},
    };
    for (const Case& c : cases)
    {
        const std::vector<JointTransform> tracks = mix(c.weights);
        EXPECT_FLOAT_EQ(tracks[0].translation.x, c.x) << c.name;
        const glm::vec4 wanted = turnAboutZ(c.turn);
        const float off = std::min(glm::length(tracks[0].rotation - wanted), glm::length(tracks[0].rotation + wanted));
        EXPECT_LE(off, 3e-7f) << c.name;
        EXPECT_FLOAT_EQ(tracks[1].rotation.x, c.weight) << c.name;
    }
}

TEST_F(PoseBlendTest, AnInstructionByDefaultIsTheRestPose)
{
    std::vector<JointTransform> tracks;
    Pose::mix(*_set, PoseInstruction(), tracks);
    EXPECT_EQ(std::memcmp(tracks.data(), _set->restPose().data(), tracks.size() * sizeof(JointTransform)), 0);
}

TEST(PoseTest, DifferencesMultiplyScalesAndAddTurnsUpToAWholeOne)
{
    const auto set = makeAdditiveExtremes();
    const double pi = std::acos(-1.0);
    for (std::size_t times = 0; times <= 7; ++times)
    {
        std::vector<JointTransform> tracks;
        Pose::mix(*set, addedTimes(*set, times), tracks);
        const double factor = std::pow(2.0, static_cast<double>(times));
        EXPECT_FLOAT_EQ(tracks[0].scale.x, static_cast<float>(-factor)) << times;
        EXPECT_EQ(tracks[0].scale.y, 0.0f) << "a reference of 0 has no ratio, " << times;
        EXPECT_FLOAT_EQ(tracks[0].scale.z, static_cast<float>(2.0 / factor)) << times;
        const double half = std::min(static_cast<double>(times) * 85.0 / 180.0 * pi, pi);
        const glm::vec4 turn(0.0, 0.0, std::sin(half), std::cos(half));
        EXPECT_LE(glm::length(tracks[0].rotation - turn), 1e-6f) << times;
    }
}

TEST(PoseTest, OneSampleOfFullWeightIsInterpolate)
{
    RandomCharacter character(5, {8, false, true, false, 1.0, 1.0});
    const auto set = makeSet(character);
    const Clip& clip = set->clips()[0];
    ASSERT_GE(clip.keyframeCount(), 2u);
    PoseInstruction instruction;
    instruction.samples[0] = {static_cast<std::uint32_t>(set->firstKeyframe(0)), 0.3f, 1.0f, 0};
    std::vector<JointTransform> tracks;
    Pose::mix(*set, instruction, tracks);
    for (std::size_t j = 0; j < set->skeleton().jointCount(); ++j)
    {
        const MixedTrack expected =
            MixedTrack::between({clip.at(0, 0), clip.at(1, 0), static_cast<double>(0.3f), false}, j, false);
        EXPECT_EQ(tracks[j].translation, glm::vec4(expected.translation));
        EXPECT_EQ(tracks[j].rotation, glm::vec4(expected.rotation));
        EXPECT_EQ(tracks[j].scale, glm::vec4(expected.scale));
    }
}

TEST(PoseTest, NothingIsReadBehindTheLastKeyframe)
{
    RandomCharacter character(5, {8, false, true, false, 1.0, 1.0});
    const auto set = makeSet(character);
    const Clip& clip = set->clips()[0];
    const std::size_t last = (clip.keyframeCount() - 1) * clip.keyframeStride();
    PoseInstruction instruction;
    instruction.samples[0] = {static_cast<std::uint32_t>(set->firstKeyframe(0) + clip.keyframeCount() - 1), 0.5f, 1.0f,
                              0};
    std::vector<JointTransform> tracks;
    Pose::mix(*set, instruction, tracks);
    for (std::size_t j = 0; j < set->skeleton().jointCount(); ++j)
        EXPECT_LE(glm::length(tracks[j].translation - clip.data()[last + j].translation), 1e-6f);
}

TEST(PoseTest, ASetOfNothingHasAPoseOfNothing)
{
    const auto set = AnimationSet::create({Skeleton::create({}).value(), {}, {}, {}, {}}).value();
    std::vector<AffineMatrix> palette(3);
    Pose::evaluate(*set, PoseInstruction(), AffineMatrix(), palette);
    EXPECT_TRUE(palette.empty());
}

} // namespace
} // namespace osgGpuAnimation
