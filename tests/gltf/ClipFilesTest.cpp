// SPDX-License-Identifier: MIT
#include "gltf/ImportedFile.h"
#include "plugin/SharedAssets.h"
#include "serializers/StoredScene.h"
#include "support/RandomSet.h"

#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <gtest/gtest.h>

namespace osgGpuAnimation::gltf
{

namespace
{

ImportedModel load(const std::string& path, const ImportOptions& options)
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
    const ImportedModel model = load(path, withClips({"Run.gltf", "More.gltf", "Walk.gltf"}));
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

// Numbers of clips are those of the file's animations, those of other files follow; backwards stays backwards.
TEST(ClipFilesTest, clipsAreChosenByTheFilesNumber)
{
    ModelBuilder file = bodyModel();
    file.animation("faulty");
    file.channel(0, "translation", {-1, 1}, TINYGLTF_TYPE_VEC3, {0, 0, 0, 1, 0, 0});
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
        const ImportedModel model = load(path, options);
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
        const ImportedModel loaded = load(path, withClips(one.files));
        expectWarnings(loaded, {one.warning});
        EXPECT_EQ(loaded.set->clips().size(), one.clips);
    }
    ImportOptions anywhere = withClips({far});
    anywhere.allowOutsideClips = true;
    EXPECT_EQ(clipNamesOf(load(path, anywhere)), (std::vector<std::string>{"Idle", "Far"}));
    expectWarnings(imported(model, withClips({"good.gltf"})), {"clips \"good.gltf\""});
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
    expectWarnings(load(path, options), {"allowOutsideFiles"});
    options.clipJoints = "none.json";
    expectWarnings(load(path, options), {"the file does not exist"});
}

TEST(ClipFilesTest, keyframesAreLimited)
{
    const ScratchFolder folder;
    folder.write("run.gltf", bodyClips({"Run"}).text());
    ImportOptions options = withClips({"run.gltf"});
    options.maxDecodedBytes = 300;
    expectWarnings(load(folder.write("body.gltf", bodyModel().text()), options), {"maxDecodedBytes", "meshes[1]"});
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
