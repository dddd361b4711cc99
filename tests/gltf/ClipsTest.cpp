// SPDX-License-Identifier: MIT
#include "gltf/import/Clips.h"
#include "gltf/ImportedFile.h"
#include "gltf/ModelBuilder.h"
#include "plugin/SharedAssets.h"
#include "serializers/StoredScene.h"
#include "support/RandomSet.h"

#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <tuple>

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
        clips = readClips(file.model, joints, readMorphs(file.model), "", budget, report);
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
struct ClipFault
{
    const char* name;
    int node;
    const char* path;
    std::vector<float> times;
    std::vector<float> values;
    const char* warning;
};

const ClipFault clipFaults[] = {
    {"channel without node", -1, "translation", {0, 1}, {0, 0, 0, 1, 0, 0}, ""},
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
    for (const ClipFault& fault : clipFaults)
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

namespace
{

/// A channel with faulty times beside one of a second that is valid.
struct TimesCase
{
    const char* name;
    std::vector<float> times;
    std::vector<float> values; ///< x of the scale; y and z are 1
    const char* interpolation;
    const char* warning;
    double duration;
    std::vector<std::pair<double, float>> expected; ///< times of the clip, x of the scale; empty: the channel is lost
};

const TimesCase timesCases[] = {
    {"doubled",
     {0, 0.5f, 0.5f, 1},
     {1, 2, 4, 4},
     "LINEAR",
     "found 0.5 twice; the last",
     1.0,
     {{0, 1}, {0.25, 2.5f}, {0.5, 4}, {1, 4}}},
    {"thrice", {0, 1, 1, 1}, {1, 2, 3, 4}, "STEP", "found 1 twice; the last", 1.0, {{0, 1}, {0.9, 1}, {1, 4}}},
    {"all alike", {1, 1}, {2, 3}, "LINEAR", "found 1 twice; the last", 1.0, {{0, 3}, {1, 3}}},
    {"a spline's",
     {0, 1, 1},
     {0, 1, 0, 0, 7, 0, 0, 2, 0},
     "CUBICSPLINE",
     "found 1 twice; the last",
     1.0,
     {{0, 1}, {0.5, 1.5f}, {1, 2}}},
    {"decreasing", {0, 1, 0.5f}, {1, 2, 3}, "LINEAR", "found 0.5 after 1; this channel", 1.0, {}},
    {"decreasing after equal ones",
     {0, 0, 1, 0.5f},
     {1, 2, 3, 4},
     "LINEAR",
     "found 0.5 after 1; this channel",
     1.0,
     {}},
    {"negative",
     {-1, 1},
     {1, 3},
     "LINEAR",
     "expected times from 0 on, found -1; the clip begins there",
     2.0,
     {{0, 1}, {1, 2}, {2, 3}}},
    {"negative alone", {-2}, {3}, "LINEAR", "found -2; the clip begins there", 3.0, {{0, 3}, {3, 3}}},
};

} // namespace

TEST(ClipsTest, faultyTimesAreMendedOrCostTheirChannel)
{
    for (const TimesCase& one : timesCases)
    {
        SCOPED_TRACE(one.name);
        ModelBuilder file = slidingArm();
        std::vector<float> values;
        for (const float x : one.values)
            values.insert(values.end(), {x, 1, 1});
        file.channel(0, "scale", one.times, TINYGLTF_TYPE_VEC3, values, one.interpolation);
        const ImportedModel model = imported(file);
        expectWarnings(model, {one.warning});
        ASSERT_EQ(model.set->clips().size(), 1u);
        EXPECT_DOUBLE_EQ(model.set->clips()[0].duration(), one.duration);
        std::vector<JointTransform> tracks(model.set->trackCount());
        for (const auto& [time, scale] : one.expected)
        {
            Pose::mix(*model.set, instructionAt(*model.set, 0, time), tracks);
            EXPECT_NEAR(tracks[0].scale.x, scale, 1e-6f) << time;
        }
        Pose::mix(*model.set, instructionAt(*model.set, 0, one.duration), tracks);
        EXPECT_NEAR(tracks[0].translation.x, 1.0f, 1e-6f) << "the other channel plays";
        EXPECT_TRUE(!one.expected.empty() || tracks[0].scale.x == 1.0f);
    }
}

TEST(ClipsTest, aFaultInTimesIsSaidOnceForEachAccessor)
{
    ModelBuilder file;
    file.node("arm");
    for (const char* name : {"doubled", "decreasing", "unharmed"})
    {
        file.animation(name);
        const float last = file.model.animations.size() == 2 ? 0.5f : 1.0f;
        file.channel(0, "translation", {0, 1, last}, TINYGLTF_TYPE_VEC3, {0, 0, 0, 1, 0, 0, 1, 0, 0});
        file.channel(0, "scale", {0, 1, last}, TINYGLTF_TYPE_VEC3, {1, 1, 1, 1, 1, 1, 1, 1, 1});
        auto& samplers = file.model.animations.back().samplers;
        samplers[1].input = samplers[0].input;
    }
    file.model.animations[2].channels.clear(); // no channel uses those samplers
    file.slide(0);
    const ImportedModel model = imported(file);
    EXPECT_EQ(model.animationOfClip, (std::vector<int>{0, 2}));
    const std::string expected = ": expected times that increase, found ";
    expectWarnings(model, {"animations[0] \"doubled\".channels[0]: accessors[0]" + expected + "1 twice",
                           "animations[1] \"decreasing\".channels[0]: accessors[4]" + expected + "0.5 after 1",
                           "animations[1] \"decreasing\": no channel is left; clip skipped"});
}

TEST(ClipsTest, aClipThatBeginsBeforeZeroKeepsItsChannelsInStepAndItsMarkers)
{
    ModelBuilder file;
    file.animation("early");
    file.channel(file.node("arm"), "translation", {-0.5f, 0.5f}, TINYGLTF_TYPE_VEC3, {0, 0, 0, 1, 0, 0});
    file.channel(file.node("leg"), "translation", {0, 0.5f}, TINYGLTF_TYPE_VEC3, {0, 0, 0, 1, 0, 0});
    nlohmann::json document = nlohmann::json::parse(file.text());
    document["animations"][0]["extras"]["markers"] = {{{"time", 0.25}, {"name", "step"}}};
    const ImportedModel model = imported(document.dump());
    expectWarnings(model, {"animations[0] \"early\": expected times from 0 on, found -0.5"});
    std::vector<JointTransform> tracks(model.set->trackCount());
    Pose::mix(*model.set, instructionAt(*model.set, 0, 0.75), tracks);
    EXPECT_NEAR(tracks[0].translation.x, 0.75f, 1e-6f);
    EXPECT_NEAR(tracks[1].translation.x, 0.5f, 1e-6f);
    EXPECT_EQ(markersOf(model).at(0).time, 0.75);
}

TEST(ClipsTest, anEmptyAnimationIsLeftOut)
{
    for (const char* empty : {R"({"channels":[],"samplers":[]})", R"({})", R"({"channels":[]})"})
    {
        nlohmann::json document = nlohmann::json::parse(slidingArm().text());
        document["animations"].push_back(nlohmann::json::parse(empty));
        const ImportedModel model = imported(document.dump());
        EXPECT_EQ(model.set->clips().size(), 1u) << empty;
        expectWarnings(model, {"animations[1].channels: expected", "animations[1].samplers: expected"});
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

namespace
{

ImportedModel loadModel(const std::string& path, const ImportOptions& options)
{
    return imported(readBytes(path), options, path);
}

ImportOptions withClips(const std::vector<std::string>& files)
{
    ImportOptions options;
    options.clipsFiles = files;
    return options;
}

std::vector<std::string> clipNamesOf(const ImportedModel& model)
{
    std::vector<std::string> names;
    for (const Clip& clip : model.set->clips())
        names.push_back(clip.name());
    return names;
}

/// A body of hips and a head; the head carries a mesh.
ModelBuilder bodyModel(const std::string& prefix = "")
{
    ModelBuilder file;
    const int hips = file.node(prefix + "Hips");
    file.node(prefix + "Head", hips, file.triangle());
    file.node("Lamp", -1, file.triangle());
    return file;
}

/// Clips of those joints alone.
ModelBuilder bodyClips(const std::vector<std::string>& clips, const std::string& prefix = "")
{
    ModelBuilder file;
    const int hips = file.node(prefix + "Hips");
    const int head = file.node(prefix + "Head", hips);
    for (const std::string& clip : clips)
        file.slidingClip(clip, head);
    return file;
}

/// The translation of a joint in the middle of a clip.
glm::vec4 placeIn(const AnimationSet& set, int clip, const std::string& joint)
{
    std::vector<JointTransform> tracks(set.trackCount());
    Pose::mix(set, instructionAt(set, clip, 0.5), tracks);
    return tracks[static_cast<std::size_t>(set.skeleton().findJoint(joint))].translation;
}

TEST(ClipFilesTest, nodesOfTheModelMoveWhoseNamesTheClipsHave)
{
    const ScratchFolder folder;
    folder.write("Run.gltf", bodyClips({"mixamo.com"}, "mixamorig:").text());
    folder.write("More.gltf", bodyClips({"Run", "", "Jump", "Take 002"}).text());
    folder.write("Walk.gltf", bodyClips({"Take 001"}).text());
    const std::string path = folder.write("body.gltf", bodyModel().text());
    const ImportedModel model = loadModel(path, withClips({"Run.gltf", "More.gltf", "Walk.gltf"}));
    expectWarnings(model, {});
    // Names that exporters write for a nameless clip are replaced by the file's name.
    EXPECT_EQ(clipNamesOf(model), (std::vector<std::string>{"Run", "Run 2", "More", "Jump", "Take 002", "Walk"}));
    EXPECT_EQ(model.animationOfClip, (std::vector<int>{0, 1, 2, 3, 4, 5}));
    ASSERT_TRUE(model.character);
    EXPECT_EQ(model.set->skeleton().findJoint("Lamp"), -1);
    EXPECT_GE(model.set->entryOfRigidJoint(model.set->skeleton().findJoint("Head")), 0);
    for (int clip = 0; clip < 6; ++clip)
        EXPECT_EQ(placeIn(*model.set, clip, "Head"), glm::vec4(0.5f, 0, 0, 0));
    const ImportedModel alone = imported(bodyClips({"Run"}));
    ASSERT_TRUE(alone.character) << "clips alone are a file";
    expectWarnings(alone, {});
    EXPECT_EQ(alone.character->getController().clip(), 0);
}

TEST(ClipFilesTest, ofNodesWithOneNameTheOneThatTheClipsMoveMoves)
{
    const ScratchFolder folder;
    ModelBuilder model, clips;
    for (int wheel = 0; wheel < 2; ++wheel)
    {
        model.node("Wheel", -1, model.triangle());
        clips.node("Wheel");
    }
    const std::string path = folder.write("car.gltf", model.text());
    clips.slidingClip("Drive", 1);
    folder.write("drive.gltf", clips.text());
    const ImportedModel car = loadModel(path, withClips({"drive.gltf"}));
    expectWarnings(car, {});
    ASSERT_EQ(clipNamesOf(car), std::vector<std::string>{"Drive"});
    ASSERT_EQ(car.set->skeleton().jointCount(), 2u);
    const Clip& drive = car.set->clips()[0];
    const std::size_t last = drive.keyframeCount() - 1;
    EXPECT_EQ(drive.at(last, 0)->translation, glm::vec4(0.0f));
    EXPECT_NE(drive.at(last, 1)->translation, glm::vec4(0.0f));
}

TEST(ClipFilesTest, aGenericNameIsReplacedByThatOfTheModelsOwnFileToo)
{
    const ScratchFolder folder;
    const std::pair<const char*, const char*> cases[] = {
        {"mixamo.com", "Dance"}, {"Take 001", "Dance"}, {"Motion", "Dance"}, {"Take 002", "Take 002"}, {"", "clip 0"}};
    for (const auto& [name, expected] : cases)
    {
        ModelBuilder file = bodyModel();
        file.slidingClip(name, 0);
        EXPECT_EQ(clipNamesOf(loadModel(folder.write("Dance.gltf", file.text()), {})),
                  std::vector<std::string>{expected});
    }
    ModelBuilder file = bodyModel();
    file.slidingClip("mixamo.com", 0);
    EXPECT_EQ(clipNamesOf(imported(file)), std::vector<std::string>{"mixamo.com"}) << "a stream has no name";
}

TEST(ClipFilesTest, clipMatchSaysHowClipsOfAnotherRestPoseFitAndIsNoted)
{
    const ScratchFolder folder;
    const float half = 0.70710678f;
    ModelBuilder model = bodyModel(), clips = bodyClips({});
    model.at(1).translation = clips.at(1).translation = {0, 1, 0};
    clips.at(1).rotation = {0, 0, half, half};
    clips.animation("Nod");
    clips.channel(1, "rotation", {0, 1}, TINYGLTF_TYPE_VEC4, {0, 0, half, half, 0, 0, 0, 1});
    folder.write("nod.gltf", clips.text());
    const std::string path = folder.write("body.gltf", model.text());
    const std::tuple<ClipMatch, float, std::string> cases[] = {
        {ClipMatch::Automatic, half,
         "(2 joints); it is the first frame of a clip, so the joints move as they do in the file: clipMatch=byName"},
        {ClipMatch::ByName, half, ""},
        {ClipMatch::Retarget, 0.0f, ""}};
    for (const auto& [match, z, note] : cases)
    {
        ImportOptions options = withClips({"nod.gltf"});
        options.clipMatch = match;
        const ImportedModel loaded = loadModel(path, options);
        expectWarnings(loaded, {});
        std::vector<JointTransform> tracks(loaded.set->trackCount());
        Pose::mix(*loaded.set, instructionAt(*loaded.set, 0, 0.0), tracks);
        EXPECT_NEAR(tracks[static_cast<std::size_t>(loaded.set->skeleton().findJoint("Head"))].rotation.z, z, 1e-6f);
        const std::vector<std::string>& notes = loaded.messages.notes;
        EXPECT_EQ(std::count_if(notes.begin(), notes.end(),
                                [](const std::string& text) { return mentions(text, "clipMatch"); }),
                  note.empty() ? 0 : 1);
        EXPECT_TRUE(note.empty() || mentions(notes.back(), note)) << notes.back();
    }
}

// Numbers of clips are those of the file's animations, those of other files follow; backwards stays backwards.
TEST(ClipFilesTest, clipsAreChosenByTheFilesNumber)
{
    ModelBuilder file = bodyModel();
    file.animation("faulty");
    file.channel(0, "translation", {1, 0}, TINYGLTF_TYPE_VEC3, {0, 0, 0, 1, 0, 0});
    file.slidingClip("one", 0);
    file.slidingClip("two", 0);
    const ScratchFolder folder;
    folder.write("more.gltf", bodyClips({"three", "four"}).text());
    const std::string path = folder.write("body.gltf", file.text());
    const std::pair<const char*, const char*> cases[] = {
        {"1", "one"}, {"2", "two"}, {"3", "three"}, {"4", "four"}, {"four", "four"}};
    for (const auto& [wish, expected] : cases)
    {
        ImportOptions options = withClips({"more.gltf"});
        options.clip = wish;
        options.speed = -2.0;
        const ImportedModel model = loadModel(path, options);
        EXPECT_EQ(model.animationOfClip, std::vector<int>({1, 2, 3, 4}));
        const AnimationController& controller = model.character->getController();
        EXPECT_EQ(controller.set().clips()[static_cast<std::size_t>(controller.clip())].name(), expected) << wish;
        EXPECT_EQ(controller.layer(0).settings().speed, -2.0);
    }
}

TEST(ClipFilesTest, aFaultyFileCostsItsClipsAloneAndIsNamed)
{
    struct Case
    {
        const char* name;
        std::vector<std::string> files;
        const char* warning;
        std::size_t clips; ///< left in the model
    };
    const ScratchFolder folder, outside;
    ModelBuilder model = bodyModel(), wheels, twins = bodyClips({});
    model.slidingClip("Idle", 0);
    wheels.slidingClip("Turn", wheels.node("Wheel"));
    const int second = twins.node("Hips"), tail = twins.node("Tail", second);
    twins.slidingClip("Both", 0);
    twins.slide(second);
    twins.slide(tail);
    const std::string path = folder.write("body.gltf", model.text());
    folder.write("good.gltf", bodyClips({"Run"}).text());
    folder.write("other.gltf", wheels.text());
    folder.write("twins.gltf", twins.text());
    folder.write("still.gltf", bodyClips({}).text());
    folder.write("empty.gltf", "");
    folder.write("bad.gltf", "{ not JSON");
    const std::string far = outside.write("far.gltf", bodyClips({"Far"}).text());
    const Case cases[]{
        {"unknown", {"none.gltf", "good.gltf"}, "clips \"none.gltf\": the file does not exist", 2},
        {"the model itself", {"body.gltf"}, "model file itself", 1},
        {"twice", {"good.gltf", "good.gltf"}, "named twice", 2},
        {"no shared joint", {"other.gltf", "good.gltf"}, "no joint has a counterpart", 2},
        {"no clips", {"still.gltf"}, "no clips", 1},
        {"empty", {"empty.gltf"}, "empty", 1},
        {"no JSON", {"bad.gltf"}, "clips \"bad.gltf\"", 1},
        {"a folder", {"."}, "folder", 1},
        {"outside", {far}, "allowOutsideFiles", 1},
        {"two skeletons", {"twins.gltf"}, "no counterpart for \"Hips\", \"Tail\"", 2},
    };
    for (const Case& one : cases)
    {
        SCOPED_TRACE(one.name);
        const ImportedModel loaded = loadModel(path, withClips(one.files));
        expectWarnings(loaded, {one.warning});
        EXPECT_EQ(loaded.set->clips().size(), one.clips);
    }
    ImportOptions anywhere = withClips({far});
    anywhere.allowOutsideClips = true;
    EXPECT_EQ(clipNamesOf(loadModel(path, anywhere)), (std::vector<std::string>{"Idle", "Far"}));
    expectWarnings(imported(model, withClips({"good.gltf"})), {"clips \"good.gltf\""});
}

TEST(ClipFilesTest, clipsThatMoveNeitherASkinNorWhatIsAboveItAreRefused)
{
    const ScratchFolder folder;
    ModelBuilder model, clips;
    const int top = model.node("Armature"), hips = model.node("Hips", top), head = model.node("Head", hips);
    model.at(model.node("Body", -1, model.skinnedTriangle())).skin = model.skin({hips, head});
    const int pelvis = clips.node("pelvis", clips.node("Armature"));
    clips.slidingClip("Run", pelvis);
    const std::string path = folder.write("body.gltf", model.text());
    folder.write("run.gltf", clips.text());
    const ImportedModel without = loadModel(path, withClips({"run.gltf"}));
    expectWarnings(without, {"no joint of a skin has a counterpart"});
    clips.slide(0);
    folder.write("run.gltf", clips.text());
    const ImportedModel with = loadModel(path, withClips({"run.gltf"}));
    expectWarnings(with, {"no counterpart for \"Hips\", \"Head\"", "no counterpart for \"pelvis\""});
    EXPECT_EQ(clipNamesOf(with), std::vector<std::string>{"Run"});
}

TEST(ClipFilesTest, aFileNamesTheCounterpartsOfJoints)
{
    const ScratchFolder folder;
    ModelBuilder clips;
    const int pelvis = clips.node("rig:pelvis"), neck = clips.node("neck_01", pelvis);
    clips.slidingClip("Nod", neck);
    clips.slide(pelvis);
    folder.write("nod.gltf", clips.text());
    folder.write("run.gltf", bodyClips({"Run"}).text()); // has the model's names
    const std::string path = folder.write("body.gltf", bodyModel("mixamorig:").text());
    struct Case
    {
        const char* names;
        std::vector<std::string> warnings; ///< parts of them, in their order
        float head;                        ///< the head's translation in the middle of "Nod"
    };
    const std::string atRest = "clips \"nod.gltf\": they have no counterpart for ";
    const std::vector<Case> cases = {
        {R"({"Hips": "pelvis", "Head": "neck_01"})", {}, 0.5f},
        {R"({"mixamorig:Hips": "rig:pelvis", "mixamorig:Head": "neck_01"})", {}, 0.5f},
        {R"({"Hips": "pelvis", "Head": null})",
         {atRest + "\"mixamorig:Head\"", "model has no counterpart for \"neck_01\"", "run.gltf", "run.gltf"},
         0.0f},
        {R"({"Hips": "pelvis", "Head": "neck_01", "Tail": "tail_01", "head": "neck_01"})",
         {"clipJoints \"names.json\": the model has no joint \"Tail\", \"head\"",
          "clipJoints \"names.json\": no file of clips has a joint \"tail_01\""},
         0.5f},
        {R"({"Hips": "pelvis", "Head": "neck_01", "Lamp": 7})",
         {"clipJoints \"names.json\": \"Lamp\": expected the name of a joint or null, found 7; left out"},
         0.5f},
        {"[]", {"clipJoints \"names.json\": ", "clips \"nod.gltf\": no joint has a counterpart"}, -1.0f},
        {"{", {"clipJoints \"names.json\": ", "no joint has a counterpart"}, -1.0f},
    };
    for (const Case& one : cases)
    {
        SCOPED_TRACE(one.names);
        folder.write("names.json", one.names);
        ImportOptions options = withClips({"nod.gltf", "run.gltf"});
        options.clipJoints = "names.json";
        const ImportedModel model = loadModel(path, options);
        expectWarnings(model, one.warnings);
        const int clip = model.set->findClip("Nod");
        ASSERT_EQ(clip >= 0, one.head >= 0.0f);
        EXPECT_GE(model.set->findClip("Run"), 0);
        if (clip < 0) continue;
        EXPECT_EQ(placeIn(*model.set, clip, "mixamorig:Head"), glm::vec4(one.head, 0, 0, 0));
    }
    const ScratchFolder outside;
    ImportOptions options = withClips({"run.gltf"});
    options.clipJoints = outside.write("far.json", "{}");
    expectWarnings(loadModel(path, options), {"allowOutsideFiles"});
    options.clipJoints = "none.json";
    expectWarnings(loadModel(path, options), {"the file does not exist"});
}

TEST(ClipFilesTest, keyframesAreLimited)
{
    const ScratchFolder folder;
    folder.write("run.gltf", bodyClips({"Run"}).text());
    ImportOptions options = withClips({"run.gltf"});
    options.maxDecodedBytes = 300;
    expectWarnings(loadModel(folder.write("body.gltf", bodyModel().text()), options), {"maxDecodedBytes", "meshes[1]"});
}

TEST(ClipFilesTest, osgDbTakesTheOptionSeveralTimesAndNamesWithSpacesForCrowdsToo)
{
    usePluginsOfTheBuild();
    const ScratchFolder folder;
    folder.write("Run fast.gltf", bodyClips({"Fast"}).text());
    folder.write("Walk.gltf", bodyClips({"Walk", "Run"}).text());
    const std::string path = folder.write("body.gltf", bodyModel().text());
    osg::ref_ptr<osgDB::Options> options = new osgDB::Options("clips=\"Run fast.gltf\" clips=Walk.gltf clip=Walk");
    const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(path, options);
    const AnimatedCharacter* character = node ? findCharacter(*node) : nullptr;
    ASSERT_TRUE(character);
    ASSERT_EQ(character->getAnimationSet().clips().size(), 3u);
    EXPECT_EQ(character->getAnimationSet().clips()[0].name(), "Fast");
    EXPECT_EQ(character->getController().clip(), 1);
    options = new osgDB::Options("clips=Walk.gltf clips=Run");
    const osg::ref_ptr<osg::Node> many = osgDB::readRefNodeFile(path + ".2x2.crowd", options);
    const auto* crowd = dynamic_cast<const AnimatedCrowd*>(many.get());
    ASSERT_TRUE(crowd);
    EXPECT_EQ(crowd->getAnimationSet().clips().size(), 2u);
}

} // namespace

} // namespace osgGpuAnimation::gltf
