// SPDX-License-Identifier: MIT
#include "gltf/import/Clips.h"
#include "gltf/ImportedFile.h"
#include "gltf/ModelBuilder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

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

    std::string warning() const { return messages.warnings.empty() ? "" : messages.warnings[0]; }

    Messages messages;
    Clips clips;
};

/// A node "arm" and a clip "good" that slides it.
ModelBuilder slidingArm()
{
    ModelBuilder file;
    file.slidingClip("good", file.node("arm"));
    return file;
}

bool mentions(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

/// One more channel of the clip "bad", and its warning; empty: the clip stays.
struct Fault
{
    const char* name;
    int node;
    const char* path;
    std::vector<float> times;
    std::vector<float> values;
    const char* warning;
};

const Fault faults[] = {
    {"channel without node", -1, "translation", {0, 1}, {0, 0, 0, 1, 0, 0}, ""},
    {"times that fall", 0, "scale", {1, 0}, {0, 0, 0, 1, 1, 1}, "animations[1] \"bad\".channels[1]"},
    {"values missing", 0, "scale", {0, 1}, {0, 0, 0}, "animations[1] \"bad\".channels[1]"},
    {"rotation of length 0", 0, "rotation", {0, 1}, {0, 0, 0, 0, 0, 0, 0, 1}, "animations[1] \"bad\".channels[1]"},
};

/// A clip of one second with these extras, through the whole import.
ImportedModel withExtras(const std::string& extras)
{
    ModelBuilder file;
    file.slidingClip("slide", file.node("arm"));
    nlohmann::json document = nlohmann::json::parse(file.text());
    document["animations"][0]["extras"] = nlohmann::json::parse(extras);
    return imported(document.dump());
}

const std::vector<ClipMarker>& markersOf(const ImportedModel& model)
{
    return model.set->clips().at(0).markers();
}

} // namespace

TEST(ClipsTest, oneFaultCostsAtMostOneClip)
{
    for (const Fault& fault : faults)
    {
        SCOPED_TRACE(fault.name);
        ModelBuilder file = slidingArm();
        file.slidingClip("bad", 0);
        const bool isRotation = std::string(fault.path) == "rotation";
        file.channel(fault.node, fault.path, fault.times, isRotation ? TINYGLTF_TYPE_VEC4 : TINYGLTF_TYPE_VEC3,
                     fault.values);
        file.slidingClip("last", 0);
        const ReadClips read(file);
        ASSERT_EQ(read.clips.clips.size(), *fault.warning ? 2u : 3u);
        EXPECT_EQ(read.clips.animationOfClip.back(), 2);
        EXPECT_EQ(read.clips.clips.back().name(), "last");
        EXPECT_DOUBLE_EQ(read.clips.clips.back().duration(), 1.0);
        EXPECT_EQ(read.clips.clips.back().keyframeCount(), 2u); // nothing of the bad clip remains
        ASSERT_EQ(read.messages.warnings.size(), *fault.warning ? 1u : 0u) << read.warning();
        EXPECT_TRUE(mentions(read.warning(), fault.warning)) << read.warning();
    }
}

TEST(ClipsTest, namesAreTheFilesOrStable)
{
    ModelBuilder file = slidingArm();
    file.slidingClip("", 0);
    file.slidingClip("good", 0);
    file.animation("emptied");
    const ReadClips read(file);
    ASSERT_EQ(read.clips.clips.size(), 3u) << "without a channel there is no clip";
    EXPECT_EQ(read.clips.clips[0].name(), "good");
    EXPECT_EQ(read.clips.clips[1].name(), "clip 1");
    EXPECT_EQ(read.clips.clips[2].name(), "good");
    EXPECT_TRUE(read.messages.warnings.empty());
}

TEST(ClipsTest, aShearedNodeIsNotDriven)
{
    ModelBuilder file = slidingArm();
    file.at(0).matrix = {1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 4, 0, 0, 1};
    const ReadClips read(file);
    ASSERT_EQ(read.clips.clips.size(), 1u);
    EXPECT_EQ(read.clips.clips[0].keyframeCount(), 1u);
    EXPECT_TRUE(mentions(read.warning(), "matrix that shears"));
}

TEST(ClipsTest, keyframesAreLimited)
{
    const ReadClips read(slidingArm(), 80); // less than two keyframes of 48 bytes, more than the keys
    EXPECT_TRUE(read.clips.clips.empty());
    EXPECT_TRUE(mentions(read.warning(), "animations[0] \"good\": its keyframes would take")) << read.warning();
    const ReadClips keysToo(slidingArm(), 60);
    EXPECT_TRUE(keysToo.clips.clips.empty());
    EXPECT_TRUE(mentions(keysToo.warning(), "its keys take too many bytes")) << keysToo.warning();
    // The keys are freed with their clip: its 64 bytes count once, its keyframes (about 100 bytes) stay.
    ModelBuilder three = slidingArm();
    three.model.animations.resize(3, three.model.animations[0]);
    EXPECT_EQ(ReadClips(three, 340).clips.clips.size(), 3u);
}

TEST(ClipsTest, normalizedIntegersAreTheNumbersTheyStandFor)
{
    const std::pair<int, unsigned int> types[] = {{TINYGLTF_COMPONENT_TYPE_BYTE, 127},
                                                  {TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, 255},
                                                  {TINYGLTF_COMPONENT_TYPE_SHORT, 32767},
                                                  {TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, 65535}};
    for (const auto& [type, one] : types)
    {
        SCOPED_TRACE(type);
        ModelBuilder file;
        const int mesh = file.triangle();
        file.primitive(mesh).targets = {file.primitive(mesh).attributes};
        file.node("face", -1, mesh);
        file.animation("quantized");
        file.channel(0, "rotation", {0, 1}, TINYGLTF_TYPE_VEC4, {});
        file.model.animations[0].samplers[0].output =
            file.integers(TINYGLTF_TYPE_VEC4, type, {0, 0, 0, one, 0, 0, one, 0});
        file.model.accessors.back().normalized = true;
        file.channel(0, "weights", {0, 1}, TINYGLTF_TYPE_SCALAR, {});
        file.model.animations[0].samplers[1].output = file.integers(TINYGLTF_TYPE_SCALAR, type, {0, one});
        file.model.accessors.back().normalized = true;
        const ReadClips read(file);
        ASSERT_EQ(read.clips.clips.size(), 1u) << read.warning();
        const Clip& clip = read.clips.clips[0];
        const JointTransform* const last = clip.data().data() + (clip.keyframeCount() - 1) * clip.keyframeStride();
        EXPECT_EQ(std::abs(last[0].rotation.z), 1.0f);
        EXPECT_EQ(last[1].translation.x, 1.0f) << "the first weight";
    }
}

TEST(MarkersTest, comeFromTheExtrasInOrderOfTime)
{
    const ImportedModel model = withExtras(
        R"({"markers":[{"time":0.75,"name":"right"},{"time":0.25,"name":"left","more":1},{"time":9,"name":"end"}]})");
    expectWarnings(model, {});
    const std::vector<ClipMarker>& markers = markersOf(model);
    ASSERT_EQ(markers.size(), 3u);
    EXPECT_EQ(markers[0].name, "left");
    EXPECT_EQ(markers[0].time, 0.25);
    EXPECT_EQ(markers[1].name, "right");
    EXPECT_EQ(markers[2].time, 1.0) << "beyond the end: at the end";
}

TEST(MarkersTest, aFaultCostsTheMarkerWithAWarning)
{
    const std::pair<const char*, const char*> faults[] = {
        {R"({"time":-1,"name":"a"})", "a time below 0"},
        {R"({"time":"x","name":"a"})", "no number as its time"},
        {R"({"time":null,"name":"a"})", "no number as its time"},
        {R"({"name":"a"})", "no number as its time"},
        {R"({"time":0.5})", "no text as its name"},
        {R"({"time":0.5,"name":7})", "no text as its name"},
        {"3", "no object"},
        {"null", "no object"},
    };
    for (const auto& [marker, message] : faults)
    {
        SCOPED_TRACE(marker);
        const ImportedModel model =
            withExtras(R"({"markers":[)" + std::string(marker) + R"(,{"time":0.5,"name":"good"}]})");
        expectWarnings(model, {"animations[0] \"slide\".extras.markers[0]: " + std::string(message)});
        ASSERT_EQ(markersOf(model).size(), 1u);
        EXPECT_EQ(markersOf(model)[0].name, "good");
    }
    for (const char* extras : {"{}", "7", "[]", R"("markers")", R"({"marker":[1]})", R"({"markers":[]})"})
    {
        const ImportedModel model = withExtras(extras);
        expectWarnings(model, {});
        EXPECT_TRUE(markersOf(model).empty()) << extras;
    }
    expectWarnings(withExtras(R"({"markers":"none"})"), {"extras.markers: no array"});
}

} // namespace osgGpuAnimation::gltf
