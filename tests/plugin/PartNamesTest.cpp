// SPDX-License-Identifier: MIT
#include "gltf/GlbText.h"
#include "gltf/PointerFile.h"
#include "plugin/SharedAssets.h"
#include "serializers/RoundTrip.h"
#include "serializers/StoredScene.h"
#include "support/ViewerGLTest.h"

#include <osg/Switch>
#include <osg/ValueObject>
#include <osgUtil/Optimizer>

// A host that looks for the name of a file's node finds what the node shows, as SimGear's animations do, which move all
// nodes of exactly that name below one of their own.

namespace osgGpuAnimation::gltf
{

namespace
{

/// The nodes of exactly that name.
class NodesNamed : public osg::NodeVisitor
{
public:
    NodesNamed(osg::Node& scene, const std::string& name) : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), _name(name)
    {
        scene.accept(*this);
    }
    void apply(osg::Node& node) override
    {
        if (node.getName() == _name) found.push_back(&node);
        traverse(node);
    }
    std::vector<osg::Node*> found;

private:
    const std::string _name;
};

/// As SimGear's SGAnimation does it: inner nodes first, and those of one parent below one group.
class Select : public osg::NodeVisitor
{
public:
    explicit Select(const std::string& name) : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), _name(name) {}
    void apply(osg::Group& group) override
    {
        traverse(group);
        osg::ref_ptr<osg::Switch> condition;
        for (unsigned int child = group.getNumChildren(); child-- > 0;)
        {
            const osg::ref_ptr<osg::Node> node = group.getChild(child);
            if (node->getName() != _name) continue;
            if (!condition) condition = new osg::Switch;
            condition->addChild(node);
            group.removeChild(child);
        }
        if (!condition) return;
        group.addChild(condition);
        conditions.push_back(condition);
    }
    std::vector<osg::ref_ptr<osg::Switch>> conditions;

private:
    const std::string _name;
};

int named(ModelBuilder& file, int mesh, const std::string& name)
{
    file.model.meshes[static_cast<std::size_t>(mesh)].name = name;
    return mesh;
}

/// A triangle as three primitives of the materials Cloth, Skin and Steel.
int threeParts(ModelBuilder& file)
{
    const int mesh = named(file, file.triangle(), "Cube.124");
    tinygltf::Mesh& made = file.model.meshes.back();
    made.primitives.resize(3, made.primitives[0]);
    for (const char* name : {"Cloth", "Skin", "Steel"})
    {
        made.primitives[file.model.materials.size()].material = static_cast<int>(file.model.materials.size());
        file.model.materials.emplace_back().name = name;
    }
    return mesh;
}

int moving(ModelBuilder& file, int node)
{
    file.slidingClip("slide", node);
    return node;
}

std::string bodyOfThreeParts(bool isMoving)
{
    ModelBuilder file;
    const int node = file.node("Body", -1, threeParts(file));
    if (isMoving) moving(file, node);
    return file.text();
}

std::string twoSwordsOfOneMesh(bool isMoving)
{
    ModelBuilder file;
    const int mesh = named(file, file.triangle(), "Blade"), hand = file.node("Hand");
    for (const char* name : {"Sword", "Sword_Offhand"})
        file.node(name, hand, mesh);
    if (isMoving) moving(file, hand);
    return file.text();
}

std::string twoCoatsOfOneSkin()
{
    ModelBuilder file;
    const int hip = file.node("Hip"), skin = file.skin({hip, file.node("Knee", hip)});
    const int mesh = named(file, file.skinnedTriangle(), "Cloth");
    for (const char* name : {"Coat", "Coat", "Wet_Coat"})
        file.at(file.node(name, -1, mesh)).skin = skin;
    moving(file, hip);
    return file.text();
}

/// Blender names a mesh after the object that it was made for.
std::string meshesNamedAsOtherNodes(bool isMoving)
{
    ModelBuilder file;
    const int box = file.node("Box", -1, named(file, file.triangle(), "Lid"));
    const int lid = file.node("Lid", -1, named(file, file.triangle(), "Box"));
    const int same = file.node("Same", -1, named(file, file.triangle(), "Same"));
    for (const int node : {box, lid, same})
        if (isMoving) moving(file, node);
    return file.text();
}

std::string nodeWithoutName()
{
    ModelBuilder file;
    moving(file, file.node("", -1, named(file, file.triangle(), "Sphere")));
    return file.text();
}

std::string instancedStone()
{
    ModelBuilder file;
    file.floats(TINYGLTF_TYPE_VEC3, {0, 0, 0, 5, 0, 0});
    const int stone = file.node("Stone", -1, named(file, file.triangle(), "Rock"));
    file.at(stone).extensions["EXT_mesh_gpu_instancing"] = valueOf(R"({"attributes":{"TRANSLATION":0}})");
    file.model.extensionsUsed = {"EXT_mesh_gpu_instancing"};
    return file.text();
}

/// The osg::LOD has the name, so that a host moves all levels.
std::string levels(bool isMoving)
{
    ModelBuilder file;
    for (const char* name : {"Tree", "Tree_Far"})
    {
        const int node = file.node(name, -1, named(file, file.triangle(), "Wood"));
        if (isMoving) moving(file, node);
    }
    file.at(0).extensions["MSFT_lod"] = valueOf(R"({"ids":[1]})");
    file.model.extensionsUsed = {"MSFT_lod"};
    return file.text();
}

/// A .glb with its first animation alone; empty: the file is not here.
std::string modelBytes(const std::string& model)
{
    if (modelFile(model).empty()) return "";
    GlbParts parts(readBytes(modelFile(model)));
    if (parts.json.contains("animations")) parts.json["animations"] = {parts.json["animations"][0]};
    return parts.whole();
}

struct NamesCase
{
    const char* what;
    std::string bytes; ///< empty: the file is not here
    std::vector<std::pair<const char*, std::size_t>> found;
};

std::vector<NamesCase> namesCases()
{
    return {
        {"primitives of a node that moves", bodyOfThreeParts(true), {{"Body", 3}, {"Cube.124", 0}}},
        {"primitives of a still node", bodyOfThreeParts(false), {{"Body", 1}, {"Cube.124", 0}}},
        {"nodes that move with one mesh", twoSwordsOfOneMesh(true), {{"Sword", 1}, {"Sword_Offhand", 1}, {"Blade", 0}}},
        {"still nodes with one mesh", twoSwordsOfOneMesh(false), {{"Sword", 1}, {"Sword_Offhand", 1}, {"Blade", 0}}},
        {"nodes with one skinned mesh", twoCoatsOfOneSkin(), {{"Coat", 1}, {"Wet_Coat", 1}, {"Cloth", 0}}},
        {"meshes that move, named as other nodes",
         meshesNamedAsOtherNodes(true),
         {{"Box", 1}, {"Lid", 1}, {"Same", 1}}},
        {"still meshes named as other nodes", meshesNamedAsOtherNodes(false), {{"Box", 1}, {"Lid", 1}, {"Same", 1}}},
        {"a node without a name", nodeWithoutName(), {{"Sphere", 1}}},
        {"an instanced node", instancedStone(), {{"Stone", 1}, {"Rock", 0}}},
        {"MaterialBalls", modelBytes("MaterialBalls.glb"), {{"BeatenCopper", 1}, {"Metallic100Roughness0", 1}}},
        {"Wanderer", modelBytes("Wanderer.glb"), {{"Lantern", 2}, {"Body", 1}}},
        {"Serpent", modelBytes("Serpent.glb"), {{"Body", 2}}},
        {"People",
         modelBytes("People.glb"),
         {{"Body", 5},
          {"Hair", 1},
          {"Hood", 1},
          {"Hat", 1},
          {"Cap", 1},
          {"Coat", 3},
          {"Jacket", 2},
          {"Robe", 2},
          {"Bag", 1},
          {"Pack", 3},
          {"Lantern", 2},
          {"Basket", 2},
          {"Staff", 1}}},
        {"Knight",
         modelBytes("assets/Knight/Knight.glb"),
         {{"1H_Sword", 1},
          {"1H_Sword_Offhand", 1},
          {"Knight_Helmet", 1},
          {"Knight_Body", 1},
          {"Cube.124", 0},
          {"PrototypePete_body.020", 0}}},
        {"Fox", modelBytes("assets/Fox/Fox.glb"), {{"fox", 1}, {"fox1", 0}}},
        {"CesiumMan", modelBytes("assets/CesiumMan/CesiumMan.glb"), {{"Cesium_Man", 1}}}};
}

using PartNamesGLTest = ViewerGLTest;

} // namespace

TEST(PartNamesTest, hostsFindNodesOfTheFileInEveryScene)
{
    const StoredScene files;
    for (const NamesCase& each : namesCases())
    {
        SCOPED_TRACE(each.what);
        if (each.bytes.empty()) continue;
        const auto expectNames = [&](const char* scene, const osg::ref_ptr<osg::Node>& node)
        {
            ASSERT_TRUE(node) << scene;
            for (const auto& [name, count] : each.found)
                EXPECT_EQ(NodesNamed(*node, name).found.size(), count) << name << ", " << scene;
        };
        const ImportedModel model = imported(each.bytes);
        ASSERT_TRUE(model.root);
        expectNames("imported", model.root);
        expectNames("cloned", osg::clone(model.root.get(), osg::CopyOp::DEEP_COPY_NODES));
        expectNames("as glTF", throughGlb(*model.root));
        for (const char* format : storedFormats)
            expectNames(format, files.throughFile(*model.root, format));
        osgUtil::Optimizer().optimize(model.root);
        expectNames("optimized", model.root);
    }
}

TEST(PartNamesTest, meshesHaveTheirNamesAndPrimitivesThoseOfTheirMaterials)
{
    for (const bool isMoving : {false, true})
    {
        const ImportedModel model = imported(bodyOfThreeParts(isMoving));
        ASSERT_EQ(model.primitives.size(), 3u);
        const char* const materials[] = {"Cloth", "Skin", "Steel"};
        for (std::size_t i = 0; i < 3; ++i)
        {
            const osg::Geometry& part = *model.primitives[i].geometry;
            std::string mesh;
            EXPECT_TRUE(part.getUserValue("osgGpuAnimation.mesh", mesh));
            EXPECT_EQ(mesh, "Cube.124");
            EXPECT_EQ(part.getName(), isMoving ? "Body" : "");
            EXPECT_EQ(part.getStateSet()->getName(), materials[i]);
        }
    }
}

TEST(PartNamesTest, partsAreFoundByNodeElseByMesh)
{
    const ImportedModel model = imported(bodyOfThreeParts(true));
    ASSERT_TRUE(model.character);
    CharacterMeshes& meshes = model.character->getMeshes();
    EXPECT_EQ(meshes.find("Cube.124"), meshes.find("Body"));
    for (const char* const name : {"Body", "Cube.124"})
        for (const bool isVisible : {false, true})
        {
            ASSERT_TRUE(meshes.setVisible(name, isVisible));
            for (unsigned int part = 0; part < 3; ++part)
                EXPECT_EQ(model.character->getChild(part)->getNodeMask() != 0, isVisible) << name << part;
        }
    const ImportedModel boxes = imported(meshesNamedAsOtherNodes(true));
    EXPECT_EQ(boxes.character->getMeshes().find("Lid"), primitiveOf(boxes, 1).geometry) << "not the mesh of that name";
}

TEST(PartNamesTest, levelsOfDetailHaveTheNameOfTheirNodeAbove)
{
    for (const bool isMoving : {false, true})
    {
        const ImportedModel model = imported(levels(isMoving));
        ASSERT_TRUE(model.root);
        const std::vector<osg::Node*> trees = NodesNamed(*model.root, "Tree").found;
        ASSERT_EQ(trees.size(), 2u) << "all levels and the first";
        EXPECT_STREQ(trees[0]->className(), "LOD");
        EXPECT_EQ(trees[0]->asGroup()->getChild(0), trees[1]);
        EXPECT_EQ(NodesNamed(*model.root, "Tree_Far").found.size(), 1u);
    }
}

// Each drawable has its own copy of the names.
TEST(PartNamesTest, longNamesCountAsMemory)
{
    for (const bool isOfNode : {false, true})
    {
        ModelBuilder file;
        const int mesh = threeParts(file), node = moving(file, file.node("Body", -1, mesh));
        (isOfNode ? file.at(node).name : file.model.meshes[0].name).assign(100000, 'a');
        ImportOptions options;
        options.maxDecodedBytes = 250000;
        const ImportedModel model = imported(file, options);
        EXPECT_EQ(model.primitives.size(), 2u);
        expectWarnings(model, {"would take"});
    }
}

// The part disappears, and all others are drawn as before.
TEST_F(PartNamesGLTest, aHostsSwitchHidesThePart)
{
    viewer().getCamera()->setProjectionMatrixAsOrtho(-2, 2, -1, 3, 1, 20);
    PointerFile file;
    const int white = file.material("white", {1, 1, 1, 1}), body = file.node("Body");
    file.quad("Shield", -2, 0, white, body);
    file.quad("Sword", 2, 0, white, body);
    moving(file, body);
    const std::pair<std::string, const char*> models[] = {{file.text(), "Sword"},
                                                          {modelBytes("Wanderer.glb"), "Lantern"},
                                                          {modelBytes("assets/Knight/Knight.glb"), "1H_Sword"}};
    for (const auto& [bytes, part] : models)
    {
        SCOPED_TRACE(part);
        if (bytes.empty()) continue;
        const ImportedModel hosts = imported(bytes), own = imported(bytes);
        ASSERT_TRUE(hosts.character && own.character);
        const osg::ref_ptr<osg::Image> whole = pictureOf(own.root, {0.0, 0.5});
        Select select(part);
        hosts.root->accept(select);
        ASSERT_EQ(select.conditions.size(), 1u);
        EXPECT_EQ(Picture::pixelsDifferent(*pictureOf(hosts.root, {0.0, 0.5}), *whole), 0);
        select.conditions[0]->setAllChildrenOff();
        ASSERT_TRUE(own.character->getMeshes().setVisible(part, false));
        const osg::ref_ptr<osg::Image> without = pictureOf(own.root, {0.0, 0.5});
        EXPECT_GT(Picture::pixelsDifferent(*without, *whole), 4);
        EXPECT_EQ(Picture::pixelsDifferent(*pictureOf(hosts.root, {0.0, 0.5}), *without), 0);
    }
}

} // namespace osgGpuAnimation::gltf
