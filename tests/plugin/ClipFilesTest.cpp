// SPDX-License-Identifier: MIT
#include "gltf/Import.h"
#include "plugin/ImportedFile.h"
#include "plugin/ModelBuilder.h"
#include "plugin/PluginFolder.h"
#include "plugin/SharedAssets.h"
#include "plugin/SplitModel.h"
#include "support/RandomSet.h"
#include "support/ScratchFolder.h"

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osgDB/ReadFile>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>

namespace osgGpuAnimation::gltf
{

namespace
{

ImportedModel load(const std::string& path, const ImportOptions& options)
{
    const Result<ImportedModel> model = importModel(readBytes(path), path, options);
    EXPECT_TRUE(model) << model.error().message;
    return model ? model.value() : ImportedModel{};
}

ImportOptions withClips(const std::vector<std::string>& files)
{
    ImportOptions options;
    options.clipsFiles = files;
    return options;
}

std::string allOf(const std::vector<std::string>& warnings)
{
    std::string text;
    for (const std::string& warning : warnings)
        text += warning + "\n";
    return text;
}

std::vector<std::string> clipNamesOf(const ImportedModel& model)
{
    std::vector<std::string> names;
    for (const Clip& clip : model.set->clips())
        names.push_back(clip.name());
    return names;
}

bool areBitEqual(const std::vector<AffineMatrix>& a, const std::vector<AffineMatrix>& b)
{
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(AffineMatrix)) == 0;
}

class SplitFilesTest : public ::testing::TestWithParam<const char*>
{
};

TEST_P(SplitFilesTest, showTheSamePosesAsTheOneFile)
{
    SKIP_WITHOUT_SHARED_FILE(GetParam());
    const std::string file = sharedFile(GetParam());
    const SplitModel split(readBytes(file));
    const ScratchFolder folder;
    folder.write("clips.glb", split.clips());
    for (const bool compact : {false, true})
    {
        ImportOptions options;
        if (compact) options.compact = 1e-4;
        const ImportedModel whole = load(file, options);
        options.clipsFiles = {"clips.glb"};
        const ImportedModel model = load(folder.write("mesh.glb", split.mesh()), options);
        EXPECT_EQ(allOf(model.messages.warnings), allOf(whole.messages.warnings));
        ASSERT_EQ(model.set->clips().size(), whole.set->clips().size());
        const bool hasNames = clipNamesOf(whole).front() != "clip 0";
        EXPECT_EQ(clipNamesOf(model), hasNames ? clipNamesOf(whole) : std::vector<std::string>{"clips"});
        std::vector<AffineMatrix> wanted, made;
        for (std::size_t clip = 0; clip < whole.set->clips().size(); ++clip)
            for (int step = 0; step <= 10; ++step)
            {
                const int index = static_cast<int>(clip);
                const double time = whole.set->clips()[clip].duration() * step / 10.0;
                Pose::evaluate(*whole.set, instructionAt(*whole.set, index, time), AffineMatrix(), wanted);
                Pose::evaluate(*model.set, instructionAt(*model.set, index, time), AffineMatrix(), made);
                EXPECT_TRUE(areBitEqual(made, wanted)) << whole.set->clips()[clip].name() << " at " << time;
            }
    }
}

INSTANTIATE_TEST_SUITE_P(Models, SplitFilesTest,
                         ::testing::Values("assets/Knight/Knight.glb", "assets/Fox/Fox.glb",
                                           "assets/CesiumMan/CesiumMan.glb"));

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
    {
        file.animation(clip);
        file.slide(head);
    }
    return file;
}

TEST(ClipFilesTest, nodesOfTheModelMoveWhoseNamesTheClipsHave)
{
    const ScratchFolder folder;
    folder.write("Run.gltf", bodyClips({"mixamo.com"}, "mixamorig:").text());
    folder.write("More.gltf", bodyClips({"Run", "", "Jump"}).text());
    const std::string path = folder.write("body.gltf", bodyModel().text());
    const ImportedModel model = load(path, withClips({"Run.gltf", "More.gltf"}));
    EXPECT_EQ(allOf(model.messages.warnings), "");
    EXPECT_EQ(clipNamesOf(model), (std::vector<std::string>{"Run", "Run 2", "More", "Jump"}));
    EXPECT_EQ(model.animationOfClip, (std::vector<int>{0, 1, 2, 3}));
    ASSERT_TRUE(model.character);
    EXPECT_EQ(model.set->skeleton().findJoint("Lamp"), -1);
    EXPECT_GE(model.set->entryOfRigidJoint(model.set->skeleton().findJoint("Head")), 0);
    std::vector<AffineMatrix> joints;
    std::vector<JointTransform> tracks(model.set->trackCount());
    for (int clip = 0; clip < 4; ++clip)
    {
        Pose::mix(*model.set, instructionAt(*model.set, clip, 0.5), tracks);
        EXPECT_EQ(tracks[static_cast<std::size_t>(model.set->skeleton().findJoint("Head"))].translation,
                  glm::vec4(0.5f, 0, 0, 0));
    }
    ImportOptions options = withClips({"More.gltf"});
    options.clip = "Jump";
    EXPECT_EQ(load(path, options).character->getController().clip(), 2);
}

TEST(ClipFilesTest, clipsAloneAreAFile)
{
    const ImportedModel model = imported(bodyClips({"Run"}));
    ASSERT_TRUE(model.character);
    EXPECT_EQ(allOf(model.messages.warnings), "");
    EXPECT_EQ(model.set->clips().size(), 1u);
    EXPECT_EQ(model.character->getController().clip(), 0);
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
    ModelBuilder model = bodyModel();
    model.animation("Idle");
    model.slide(0);
    const std::string path = folder.write("body.gltf", model.text());
    folder.write("good.gltf", bodyClips({"Run"}).text());
    folder.write("other.gltf",
                 []
                 {
                     ModelBuilder wheels;
                     wheels.node("Wheel");
                     wheels.animation("Turn");
                     wheels.slide(0);
                     return wheels.text();
                 }());
    folder.write("still.gltf", bodyClips({}).text());
    folder.write("empty.gltf", "");
    folder.write("bad.gltf", "{ not JSON");
    const std::string far = outside.write("far.gltf", bodyClips({"Far"}).text());
    folder.write("twins.gltf",
                 []
                 {
                     ModelBuilder twins = bodyClips({});
                     const int second = twins.node("Hips");
                     twins.node("Tail", second);
                     twins.animation("Both");
                     twins.slide(0);
                     twins.slide(second);
                     twins.slide(3);
                     return twins.text();
                 }());
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
        const ImportedModel loaded = load(path, withClips(one.files));
        EXPECT_NE(allOf(loaded.messages.warnings).find(one.warning), std::string::npos)
            << one.name << ": " << allOf(loaded.messages.warnings);
        EXPECT_EQ(loaded.messages.warnings.size(), 1u) << one.name;
        EXPECT_EQ(loaded.set->clips().size(), one.clips) << one.name;
    }
    ImportOptions anywhere = withClips({far});
    anywhere.allowOutsideClips = true;
    EXPECT_EQ(clipNamesOf(load(path, anywhere)), (std::vector<std::string>{"Idle", "Far"}));
    EXPECT_EQ(allOf(imported(model, withClips({"good.gltf"})).messages.warnings).find("clips \"good.gltf\""), 0u);
}

TEST(ClipFilesTest, aFileNamesTheCounterpartsOfJoints)
{
    const ScratchFolder folder;
    ModelBuilder clips;
    const int pelvis = clips.node("rig:pelvis"), neck = clips.node("neck_01", pelvis);
    clips.animation("Nod");
    clips.slide(neck);
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
        {R"({"Hips": "pelvis", "Head": "neck_01", "Tail": "tail_01"})",
         {"clipJoints \"names.json\": the model has no joint \"Tail\"",
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
        const ImportedModel model = load(path, options);
        ASSERT_EQ(model.messages.warnings.size(), one.warnings.size()) << allOf(model.messages.warnings);
        for (std::size_t i = 0; i < one.warnings.size(); ++i)
            EXPECT_NE(model.messages.warnings[i].find(one.warnings[i]), std::string::npos)
                << model.messages.warnings[i];
        const int clip = model.set->findClip("Nod");
        ASSERT_EQ(clip >= 0, one.head >= 0.0f);
        EXPECT_GE(model.set->findClip("Run"), 0);
        if (clip < 0) continue;
        std::vector<JointTransform> tracks(model.set->trackCount());
        Pose::mix(*model.set, instructionAt(*model.set, clip, 0.5), tracks);
        const auto head = static_cast<std::size_t>(model.set->skeleton().findJoint("mixamorig:Head"));
        EXPECT_EQ(tracks[head].translation, glm::vec4(one.head, 0, 0, 0));
    }
    const ScratchFolder outside;
    ImportOptions options = withClips({"run.gltf"});
    options.clipJoints = outside.write("far.json", "{}");
    EXPECT_NE(allOf(load(path, options).messages.warnings).find("allowOutsideFiles"), std::string::npos);
    options.clipJoints = "none.json";
    EXPECT_NE(allOf(load(path, options).messages.warnings).find("the file does not exist"), std::string::npos);
}

TEST(ClipFilesTest, keyframesAreLimited)
{
    const ScratchFolder folder;
    folder.write("run.gltf", bodyClips({"Run"}).text());
    ImportOptions options = withClips({"run.gltf"});
    options.maxDecodedBytes = 300;
    const std::string path = folder.write("body.gltf", bodyModel().text());
    const Result<ImportedModel> model = importModel(readBytes(path), path, options);
    ASSERT_TRUE(model) << model.error().message;
    EXPECT_NE(allOf(model.value().messages.warnings).find("maxDecodedBytes"), std::string::npos);
}

TEST(ClipFilesTest, osgDbTakesTheOptionSeveralTimesAndNamesWithSpaces)
{
    usePluginsOfTheBuild();
    const ScratchFolder folder;
    folder.write("Run fast.gltf", bodyClips({"Fast"}).text());
    folder.write("Walk.gltf", bodyClips({"Walk"}).text());
    osg::ref_ptr<osgDB::Options> options = new osgDB::Options("clips=\"Run fast.gltf\" clips=Walk.gltf clip=Walk");
    const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(folder.write("body.gltf", bodyModel().text()), options);
    ASSERT_TRUE(node);
    const AnimatedCharacter* character = findCharacter(*node);
    ASSERT_TRUE(character);
    ASSERT_EQ(character->getAnimationSet().clips().size(), 2u);
    EXPECT_EQ(character->getAnimationSet().clips()[0].name(), "Fast");
    EXPECT_EQ(character->getController().clip(), 1);
}

TEST(ClipFilesTest, aCrowdChoosesAmongTheClipsOfFilesToo)
{
    usePluginsOfTheBuild();
    const ScratchFolder folder;
    folder.write("Walk.gltf", bodyClips({"Walk", "Run"}).text());
    osg::ref_ptr<osgDB::Options> options = new osgDB::Options("clips=Walk.gltf clips=Run");
    const std::string path = folder.write("body.gltf", bodyModel().text());
    const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(path + ".2x2.crowd", options);
    ASSERT_TRUE(node);
    const auto* crowd = dynamic_cast<const AnimatedCrowd*>(node.get());
    ASSERT_TRUE(crowd);
    EXPECT_EQ(crowd->getAnimationSet().clips().size(), 2u);
}

} // namespace

} // namespace osgGpuAnimation::gltf
