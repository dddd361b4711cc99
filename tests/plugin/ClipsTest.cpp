// SPDX-License-Identifier: MIT
#include "gltf/scene/Clips.h"
#include "plugin/ModelBuilder.h"

#include <gtest/gtest.h>

#include <cmath>

namespace osgGpuAnimation::gltf
{

namespace
{

struct ReadClips
{
    explicit ReadClips(const ModelBuilder& file, std::size_t bytes = std::size_t(1) << 30)
    {
        Report report(messages);
        const NodeTree tree = buildNodeTree(file.model, {}).value();
        const Joints joints = buildJoints(file.model, tree).value();
        MemoryBudget budget(bytes);
        clips = readClips(file.model, joints, readMorphs(file.model), budget, report);
    }

    std::string warning(std::size_t index) const
    {
        return index < messages.warnings.size() ? messages.warnings[index] : "";
    }

    Messages messages;
    Clips clips;
};

/// A node "arm" and a clip "good" that slides it.
ModelBuilder slidingArm()
{
    ModelBuilder file;
    file.node("arm");
    file.animation("good");
    file.slide(0);
    return file;
}

bool mentions(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

struct FaultCase
{
    const char* name;
    void (*spoil)(ModelBuilder&); ///< adds the animation "bad", or a fault in it
    bool clipStays;
    const char* warning; ///< part of the only warning; empty: no warning
};

const FaultCase faults[] = {
    {"channel without node", [](ModelBuilder& file) { file.slide(-1); }, true, ""},
    {"times that fall",
     [](ModelBuilder& file) {
         file.channel(0, "scale", {1, 0}, TINYGLTF_TYPE_VEC3, {0, 0, 0, 1, 1, 1});
     },
     false, "animations[1] \"bad\".channels[1]"},
    {"values missing",
     [](ModelBuilder& file) {
         file.channel(0, "scale", {0, 1}, TINYGLTF_TYPE_VEC3, {0, 0, 0});
     },
     false, "animations[1] \"bad\".channels[1]"},
    {"rotation of length 0",
     [](ModelBuilder& file) {
         file.channel(0, "rotation", {0, 1}, TINYGLTF_TYPE_VEC4, {0, 0, 0, 0, 0, 0, 0, 1});
     },
     false, "animations[1] \"bad\".channels[1]"},
};

} // namespace

TEST(ClipsTest, oneFaultCostsAtMostOneClip)
{
    for (const FaultCase& fault : faults)
    {
        SCOPED_TRACE(fault.name);
        ModelBuilder file = slidingArm();
        file.animation("bad");
        file.slide(0);
        fault.spoil(file);
        file.animation("last");
        file.slide(0);
        const ReadClips read(file);
        ASSERT_EQ(read.clips.clips.size(), fault.clipStays ? 3u : 2u);
        EXPECT_EQ(read.clips.animationOfClip.back(), 2);
        EXPECT_EQ(read.clips.clips.back().name(), "last");
        EXPECT_DOUBLE_EQ(read.clips.clips.back().duration(), 1.0);
        EXPECT_EQ(read.clips.clips.back().keyframeCount(), 2u); // nothing of the bad clip remains
        ASSERT_EQ(read.messages.warnings.size(), *fault.warning ? 1u : 0u) << read.warning(0);
        EXPECT_TRUE(mentions(read.warning(0), fault.warning)) << read.warning(0);
    }
}

TEST(ClipsTest, namesAreTheFilesOrStable)
{
    ModelBuilder file = slidingArm();
    file.animation("");
    file.slide(0);
    file.animation("good");
    file.slide(0);
    const ReadClips read(file);
    ASSERT_EQ(read.clips.clips.size(), 3u);
    EXPECT_EQ(read.clips.clips[0].name(), "good");
    EXPECT_EQ(read.clips.clips[1].name(), "clip 1");
    EXPECT_EQ(read.clips.clips[2].name(), "good");
}

TEST(ClipsTest, anEmptiedAnimationIsNoClip)
{
    ModelBuilder file = slidingArm();
    file.animation("emptied");
    const ReadClips read(file);
    EXPECT_EQ(read.clips.clips.size(), 1u);
    EXPECT_TRUE(read.messages.warnings.empty());
}

TEST(ClipsTest, aShearedNodeIsNotDriven)
{
    ModelBuilder file = slidingArm();
    file.at(0).matrix = {1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 4, 0, 0, 1};
    const ReadClips read(file);
    ASSERT_EQ(read.clips.clips.size(), 1u);
    EXPECT_EQ(read.clips.clips[0].keyframeCount(), 1u);
    EXPECT_TRUE(mentions(read.warning(0), "matrix that shears"));
}

TEST(ClipsTest, keyframesAreLimited)
{
    const ReadClips read(slidingArm(), 80); // less than two keyframes of 48 bytes, more than the keys
    EXPECT_TRUE(read.clips.clips.empty());
    EXPECT_TRUE(mentions(read.warning(0), "animations[0] \"good\": its keyframes would take")) << read.warning(0);
    const ReadClips keysToo(slidingArm(), 60);
    EXPECT_TRUE(keysToo.clips.clips.empty());
    EXPECT_TRUE(mentions(keysToo.warning(0), "its keys take too many bytes")) << keysToo.warning(0);
}

// The keys are freed with their clip: its 64 bytes count once, its keyframes (about 100 bytes) stay.
TEST(ClipsTest, keysOfEarlierClipsDoNotCount)
{
    ModelBuilder file = slidingArm();
    for (int i = 0; i < 2; ++i)
        file.model.animations.push_back(file.model.animations[0]);
    const ReadClips read(file, 340);
    EXPECT_EQ(read.clips.clips.size(), 3u) << read.warning(0);
}

TEST(ClipsTest, weightsDriveTheMorphOfTheirNode)
{
    ModelBuilder file;
    const int mesh = file.triangle();
    const int positions = file.primitive(mesh).attributes["POSITION"];
    file.primitive(mesh).targets = {{{"POSITION", positions}}, {{"POSITION", positions}}};
    file.model.meshes[0].weights = {0.25, 0.5};
    const int first = file.node("first", -1, mesh);
    const int second = file.node("second", -1, mesh);
    file.at(second).weights = {1, 0};
    file.animation("blink");
    file.channel(second, "weights", {0, 1}, TINYGLTF_TYPE_SCALAR, {0, 0, 1, 0.5f});
    const Morphs morphs = readMorphs(file.model);
    ASSERT_EQ(morphs.weights.size(), 2u);
    EXPECT_EQ(morphs.weights[static_cast<std::size_t>(morphs.ofNode[static_cast<std::size_t>(first)])].defaults,
              (std::vector<float>{0.25f, 0.5f}));
    EXPECT_EQ(morphs.weights[static_cast<std::size_t>(morphs.ofNode[static_cast<std::size_t>(second)])].defaults,
              (std::vector<float>{1.0f, 0.0f}));
    const ReadClips read(file);
    ASSERT_EQ(read.clips.clips.size(), 1u) << read.warning(0);
    const Clip& clip = read.clips.clips[0];
    const JointTransform& last = clip.data()[clip.keyframeStride() + 3]; // two joints, then the morphs
    EXPECT_EQ(last.translation.x, 1.0f);
    EXPECT_EQ(last.translation.y, 0.5f);
}

TEST(ClipsTest, normalizedIntegersAreTheNumbersTheyStandFor)
{
    struct Type
    {
        int component;
        unsigned int one;
    };
    for (const Type& type :
         {Type{TINYGLTF_COMPONENT_TYPE_BYTE, 127}, Type{TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, 255},
          Type{TINYGLTF_COMPONENT_TYPE_SHORT, 32767}, Type{TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, 65535}})
    {
        SCOPED_TRACE(type.component);
        ModelBuilder file;
        const int mesh = file.triangle();
        file.primitive(mesh).targets = {file.primitive(mesh).attributes};
        file.node("face", -1, mesh);
        file.animation("quantized");
        file.channel(0, "rotation", {0, 1}, TINYGLTF_TYPE_VEC4, {});
        file.channel(0, "weights", {0, 1}, TINYGLTF_TYPE_SCALAR, {});
        std::vector<tinygltf::AnimationSampler>& samplers = file.model.animations[0].samplers;
        samplers[0].output = file.integers(TINYGLTF_TYPE_VEC4, type.component, {0, 0, 0, type.one, 0, 0, type.one, 0});
        samplers[1].output = file.integers(TINYGLTF_TYPE_SCALAR, type.component, {0, type.one});
        for (const tinygltf::AnimationSampler& sampler : samplers)
            file.model.accessors[static_cast<std::size_t>(sampler.output)].normalized = true;
        const ReadClips read(file);
        ASSERT_EQ(read.clips.clips.size(), 1u) << read.warning(0);
        const Clip& clip = read.clips.clips[0];
        ASSERT_EQ(clip.trackCount(), 2u);
        const JointTransform* const last = clip.data().data() + (clip.keyframeCount() - 1) * clip.keyframeStride();
        EXPECT_EQ(std::abs(last[0].rotation.z), 1.0f);
        EXPECT_EQ(last[1].translation.x, 1.0f) << "the first weight";
    }
}

} // namespace osgGpuAnimation::gltf
