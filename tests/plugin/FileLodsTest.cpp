// SPDX-License-Identifier: MIT
#include "gltf/Import.h"
#include "gltf/ImportedFile.h"
#include "gltf/LoadedDocument.h"
#include "serializers/StoredScene.h"

#include <osgGpuAnimation/mesh/SkinnedGeometry.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/LOD>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace osgGpuAnimation::gltf
{

namespace
{

using Json = nlohmann::json;

/// The base document with two more levels of its skinned body and a still mesh of two levels, all levels roots:
/// nodes 3 and 4 are levels of node 2, node 6 is a level of node 5.
Json levelsDocument()
{
    Json made = baseDocument();
    made["extensionsUsed"] = {"MSFT_lod"};
    Json mesh = made["meshes"][0];
    for (const char* attribute : {"JOINTS_0", "WEIGHTS_0"})
        mesh["primitives"][0]["attributes"].erase(attribute);
    made["meshes"].push_back(mesh);
    Json& nodes = made["nodes"];
    for (const char* name : {"body 1", "body 2"})
        nodes.push_back({{"name", name}, {"mesh", 0}, {"skin", 0}});
    nodes.push_back({{"name", "rock"}, {"mesh", 1}});
    nodes.push_back({{"name", "rock 1"}, {"mesh", 1}});
    nodes[body]["extensions"]["MSFT_lod"]["ids"] = {3, 4};
    nodes[5]["extensions"]["MSFT_lod"]["ids"] = {6};
    made["scenes"][0]["nodes"].push_back(5);
    return made;
}

class FirstLods : public osg::NodeVisitor
{
public:
    FirstLods() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
    void apply(osg::LOD& lod) override
    {
        lods.push_back(&lod);
        traverse(lod);
    }
    std::vector<osg::LOD*> lods;
};

std::vector<osg::LOD*> lodsOf(osg::Node& node)
{
    FirstLods finder;
    node.accept(finder);
    return finder.lods;
}

/// The ranges of the LOD's children, in its order.
std::vector<std::pair<float, float>> rangesOf(const osg::LOD& lod)
{
    EXPECT_EQ(lod.getRangeMode(), osg::LOD::PIXEL_SIZE_ON_SCREEN);
    return {lod.getRangeList().begin(), lod.getRangeList().end()};
}

const float beyondAll = std::numeric_limits<float>::max();

} // namespace

TEST(FileLodsTest, levelsAreSelectedBySizeOnScreen)
{
    struct Case
    {
        Json coverage;
        std::vector<std::pair<float, float>> ranges;
    };
    const Case cases[] = {{nullptr, {{270, beyondAll}, {135, 270}, {0, 135}}},
                          {{0.5, 0.2, 0.01}, {{540, beyondAll}, {216, 540}, {10.8f, 216}}},
                          {{0.5, 0.2}, {{540, beyondAll}, {216, 540}, {0, 216}}}};
    for (const Case& one : cases)
    {
        Json document = levelsDocument();
        if (!one.coverage.is_null()) document["nodes"][body]["extras"]["MSFT_screencoverage"] = one.coverage;
        const ImportedModel model = imported(document.dump());
        EXPECT_TRUE(model.messages.warnings.empty()) << model.messages.warnings.front();
        const std::vector<osg::LOD*> lods = lodsOf(*model.root);
        ASSERT_EQ(lods.size(), 2u);
        EXPECT_EQ(lods[0]->getParent(0), model.character.get());
        EXPECT_EQ(rangesOf(*lods[0]), one.ranges) << one.coverage;
        EXPECT_EQ(rangesOf(*lods[1]), (std::vector<std::pair<float, float>>{{270, beyondAll}, {0, 270}}));
        EXPECT_EQ(lods[1]->getChild(1)->getName(), "rock 1");
    }
}

TEST(FileLodsTest, levelsAreWhereTheirNodeIs)
{
    Json document = levelsDocument();
    document["nodes"][knee]["children"] = {5}; // the rock moves with the knee, and its level with it
    document["scenes"][0]["nodes"] = {hip, body};
    const ImportedModel model = imported(document.dump());
    EXPECT_TRUE(model.messages.warnings.empty()) << model.messages.warnings.front();
    EXPECT_EQ(model.nodeParents, (std::vector<int>{-1, hip, -1, -1, -1, knee, knee}));
    const Skeleton& skeleton = model.set->skeleton();
    const int level = skeleton.findJoint("rock 1");
    ASSERT_GE(level, 0);
    EXPECT_EQ(skeleton.joint(static_cast<std::size_t>(level)).parent, skeleton.findJoint("knee"));
    ASSERT_EQ(lodsOf(*model.character).size(), 2u);
    EXPECT_EQ(lodsOf(*model.root).size(), 2u);
}

TEST(FileLodsTest, crowdsShowTheMostDetailedAndCopiesAndScenesKeepAll)
{
    const StoredScene store;
    const ImportedModel model = imported(levelsDocument().dump());
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*model.character);
    ASSERT_EQ(crowd->getNumChildren(), 2u);
    EXPECT_EQ(crowd->getChild(0), lodsOf(*model.character)[0]->getChild(0));
    EXPECT_EQ(crowd->getChild(1)->getName(), "rock") << "which does not move";
    const osg::ref_ptr<AnimatedCharacter> copy = osg::clone(model.character.get(), osg::CopyOp::DEEP_COPY_NODES);
    EXPECT_EQ(lodsOf(*copy).size(), 1u);
    const osg::ref_ptr<osg::Node> stored = store.throughFile(*model.root, "osgt");
    ASSERT_TRUE(stored);
    const std::vector<osg::LOD*> lods = lodsOf(*stored);
    ASSERT_EQ(lods.size(), 2u);
    EXPECT_EQ(lods[0]->getNumChildren(), 3u);
    EXPECT_TRUE(dynamic_cast<SkinnedGeometry*>(lods[0]->getChild(2)));
}

TEST(FileLodsTest, variantsAndVisibilityReachEveryLevel)
{
    Json document = levelsDocument();
    document["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "red"}}};
    document["materials"].push_back({{"name", "red"}});
    document["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"] = {
        {{"material", 1}, {"variants", {0}}}};
    const ImportedModel model = imported(document.dump());
    ASSERT_TRUE(model.character->getMeshes().setVariant("red"));
    const osg::LOD& lod = *lodsOf(*model.character)[0];
    for (unsigned int level = 0; level < lod.getNumChildren(); ++level)
        EXPECT_EQ(lod.getChild(level)->getStateSet()->getName(), "red") << level;
    document["nodes"][body]["extensions"]["KHR_node_visibility"]["visible"] = false;
    const ImportedModel hidden = imported(document.dump());
    for (const osg::LOD* each : lodsOf(*hidden.root))
        for (unsigned int level = 0; level < each->getNumChildren(); ++level)
            EXPECT_EQ(each->getChild(level)->getNodeMask() == 0, each == lodsOf(*hidden.root)[0]) << level;
}

TEST(FileLodsTest, aFaultLeavesTheNodeItself)
{
    struct Case
    {
        const char* path;
        Json value;
        const char* message;
        std::size_t lods; ///< left; a group of moving and still nodes has two
    };
    const char* const ids = "/nodes/2/extensions/MSFT_lod/ids";
    const char* const level = "nodes[2].extensions.MSFT_lod.ids[0]: expected ";
    const std::string above = std::string(level) + "a node that is not the node itself or above it";
    const Case cases[] = {
        {"/nodes/2/extensions/MSFT_lod", 7, "nodes[2].extensions.MSFT_lod: expected an object, found 7; left out", 1},
        {ids, 3, "nodes[2].extensions.MSFT_lod.ids: expected an array of at least 1 indices, found 3; left out", 1},
        {ids, {}, "nodes[2].extensions.MSFT_lod.ids", 1},
        {ids, {7}, "nodes[2].extensions.MSFT_lod.ids[0]: expected an index below 7", 1},
        {ids, {-1}, "nodes[2].extensions.MSFT_lod.ids[0]", 1},
        {ids, {"3"}, "nodes[2].extensions.MSFT_lod.ids[0]", 1},
        {ids, {2}, above.c_str(), 1},
        {ids, {3, 3}, "ids[1]: expected a node that is a level once, found nodes[3] again; the other levels", 1},
        {ids, {6}, "nodes[5].extensions.MSFT_lod.ids[0]: expected a node that is a level once, found nodes[6]", 2},
        {ids, {knee}, "a node without a parent, found nodes[1], a child of nodes[0]", 1},
        {ids, {hip}, "a node in one place, found nodes[0], which scenes[1] shows by itself", 1},
        {ids, {5}, "nodes[5].extensions.MSFT_lod: expected no levels of detail within others, found nodes[5]", 2},
        {"/nodes/1/extensions/MSFT_lod/ids",
         {5},
         "nodes[1].extensions.MSFT_lod.ids[0]: expected a node without levels",
         2},
        {"/nodes/1/extensions/MSFT_lod/ids",
         {hip},
         "nodes[1].extensions.MSFT_lod.ids[0]: expected a node that is not",
         2},
        {"/nodes/3/extensions/MSFT_lod/ids",
         {4},
         "nodes[3].extensions.MSFT_lod: expected no levels of detail within",
         2},
        {"/nodes/2/extras/MSFT_screencoverage", {0.2, 0.5, 0.0}, "extras.MSFT_screencoverage: expected 3 numbers", 2},
        {"/nodes/2/extras/MSFT_screencoverage", {0.5}, "extras.MSFT_screencoverage: expected 3 numbers", 2},
        {"/nodes/2/extras/MSFT_screencoverage", 1, "extras.MSFT_screencoverage: expected 3 numbers", 2},
        {"/nodes/2/extras/MSFT_screencoverage", {"a", 0, 0}, "extras.MSFT_screencoverage: expected 3 numbers", 2},
    };
    for (const Case& one : cases)
    {
        Json document = levelsDocument();
        document["scenes"].push_back({{"nodes", {hip}}});
        document[Json::json_pointer(one.path)] = one.value;
        const ImportedModel model = imported(document.dump());
        std::string warnings;
        for (const std::string& warning : model.messages.warnings)
            warnings += warning + '\n';
        EXPECT_NE(warnings.find(one.message), std::string::npos) << one.path << " " << one.value << ": " << warnings;
        EXPECT_EQ(model.messages.warnings.size(), 1u) << warnings;
        EXPECT_EQ(lodsOf(*model.root).size(), one.lods) << one.path << " " << one.value;
    }
}

// Each node is above the node whose level it is: an unchecked list would make a cycle.
TEST(FileLodsTest, levelsThatContainEachOtherAreNoCycle)
{
    ModelBuilder file;
    const int first = file.node("first"), inFirst = file.node("in first", first, file.triangle());
    const int second = file.node("second"), inSecond = file.node("in second", second, file.triangle());
    Json document = Json::parse(file.text());
    document["nodes"][inFirst]["extensions"]["MSFT_lod"]["ids"] = {second};
    document["nodes"][inSecond]["extensions"]["MSFT_lod"]["ids"] = {first};
    document["scenes"][0]["nodes"] = {first};
    const ImportedModel model = imported(document.dump());
    ASSERT_EQ(model.messages.warnings.size(), 1u);
    EXPECT_EQ(model.messages.warnings[0],
              "nodes[3].extensions.MSFT_lod: expected no levels of detail within others, found nodes[3], a level or "
              "below one; the other levels of nodes[3] \"in second\" are left out");
    EXPECT_EQ(lodsOf(*model.root).size(), 1u);
}

TEST(FileLodsTest, levelsCountAsTheDepthOfTheirNode)
{
    ModelBuilder file;
    int above = file.node("top"), level = file.node("level");
    const int first = level;
    for (int depth = 1; depth < 6; ++depth)
        above = file.node("above", above, depth == 5 ? file.triangle() : -1);
    for (int depth = 1; depth < 4; ++depth)
        level = file.node("below", level, depth == 3 ? file.triangle() : -1);
    Json document = Json::parse(file.text());
    document["nodes"][above]["extensions"]["MSFT_lod"]["ids"] = {first};
    document["scenes"][0]["nodes"] = {0};
    ImportOptions options;
    for (const std::size_t most : {std::size_t(8), std::size_t(9)})
    {
        options.maxNodeDepth = most;
        const Result<ImportedModel> model = importModel(document.dump(), "", options);
        ASSERT_TRUE(model) << model.error().message;
        const std::vector<std::string>& warnings = model.value().messages.warnings;
        if (most == 9)
        {
            EXPECT_TRUE(warnings.empty()) << warnings.front();
            continue;
        }
        ASSERT_EQ(warnings.size(), 1u);
        EXPECT_NE(warnings[0].find("expected a depth of at most 8 nodes (limit maxNodeDepth), found 9"),
                  std::string::npos)
            << warnings[0];
    }
}

TEST(FileLodsTest, levelsOfMaterialsAreOneNote)
{
    Json document = baseDocument();
    document["materials"][0]["extensions"]["MSFT_lod"]["ids"] = {1};
    document["materials"].push_back(document["materials"][0]);
    const ImportedModel model = imported(document.dump());
    EXPECT_TRUE(model.messages.warnings.empty()) << model.messages.warnings.front();
    const std::string expected =
        "materials[0].extensions.MSFT_lod: levels of materials are ignored; the material itself is drawn";
    EXPECT_EQ(std::count(model.messages.notes.begin(), model.messages.notes.end(), expected), 1);
}

} // namespace osgGpuAnimation::gltf
