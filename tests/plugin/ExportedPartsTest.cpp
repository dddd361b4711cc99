// SPDX-License-Identifier: MIT
#include "gltf/write/ClipKeys.h"
#include "plugin/ImportedFile.h"
#include "plugin/PointerFile.h"
#include "plugin/RoundTrip.h"

#include <osgGpuAnimation/animation/ClipBuilder.h>
#include <osgGpuAnimation/nodes/mesh/AnimatedProperties.h>
#include <osgGpuAnimation/nodes/mesh/MeshNames.h>
#include <osgGpuAnimation/nodes/shading/PunctualLight.h>

#include <osg/LightSource>
#include <osg/LOD>
#include <osg/MatrixTransform>
#include <osg/Switch>
#include <osg/Texture2D>

#include <nlohmann/json.hpp>

#include <cmath>

namespace osgGpuAnimation::gltf
{

namespace
{

using Json = nlohmann::json;
using Strings = std::vector<std::string>;

/// The JSON of the scene's GLB. warnings: those that are expected.
Json documentOf(const osg::Node& scene, const Strings& warnings = {})
{
    Messages messages;
    Report report(messages);
    const Result<std::string> glb = exportModel(scene, report);
    EXPECT_TRUE(glb) << glb.error().message;
    EXPECT_EQ(messages.warnings, warnings);
    if (!glb) return Json::object();
    const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(glb.value()[at]); };
    return Json::parse(glb.value().substr(20, byte(12) + 256u * byte(13) + 65536u * byte(14)));
}

Strings namesOf(const Json& document, const char* member)
{
    Strings names;
    for (const Json& each : document.value(member, Json::array()))
        names.push_back(each.value("name", ""));
    return names;
}

osg::ref_ptr<osg::Geometry> triangle(const std::string& name)
{
    osg::ref_ptr<osg::Geometry> made = new osg::Geometry;
    made->setName(name);
    const osg::Vec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}};
    made->setVertexArray(new osg::Vec3Array(3, corners));
    made->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 3));
    return made;
}

/// A skinned character with one mesh at each of the two nodes; all meshes have one name.
ModelBuilder skinnedFile(const std::string& first, const std::string& second)
{
    ModelBuilder file;
    const int joint = file.node("joint");
    const int skin = file.skin({joint, file.node("other", joint)});
    for (const std::string& name : {first, second})
    {
        const int mesh = file.skinnedTriangle();
        file.model.meshes.back().name = "Mesh";
        file.at(file.node(name, -1, mesh)).skin = skin;
    }
    file.animation("move");
    file.slide(joint);
    return file;
}

TEST(ExportedPartsTest, theDepthOfASceneIsNotThatOfTheCallStack)
{
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    constexpr unsigned int depth = 8000;
    osg::Group* deepest = scene;
    for (unsigned int i = 0; i < depth; ++i)
    {
        const osg::ref_ptr<osg::Group> below = new osg::MatrixTransform(osg::Matrix::translate(0.001, 0, 0));
        deepest->addChild(below);
        deepest = below;
    }
    const osg::ref_ptr<osg::LightSource> lamp = new osg::LightSource;
    lamp->setLight(new PunctualLight(PunctualLight::Kind::Point, 0));
    deepest->addChild(lamp);
    EXPECT_EQ(documentOf(*scene)["nodes"].size(), depth);
}

TEST(ExportedPartsTest, ofLevelsOfDetailTheFinestIsWritten)
{
    struct LevelsCase
    {
        osg::LOD::RangeMode mode;
        float ranges[2][2]; ///< of the first level, then of the second
        const char* finest;
    };
    const LevelsCase cases[] = {
        {osg::LOD::DISTANCE_FROM_EYE_POINT, {{0, 10}, {10, 100}}, "first"},
        {osg::LOD::DISTANCE_FROM_EYE_POINT, {{10, 100}, {2, 10}}, "second"},
        {osg::LOD::PIXEL_SIZE_ON_SCREEN, {{100, 1e9f}, {0, 100}}, "first"},
        {osg::LOD::PIXEL_SIZE_ON_SCREEN, {{0, 100}, {100, 1e9f}}, "second"},
    };
    for (const LevelsCase& each : cases)
    {
        const osg::ref_ptr<osg::LOD> levels = new osg::LOD;
        levels->setRangeMode(each.mode);
        levels->addChild(triangle("first"), each.ranges[0][0], each.ranges[0][1]);
        levels->addChild(triangle("second"), each.ranges[1][0], each.ranges[1][1]);
        EXPECT_EQ(namesOf(documentOf(*levels), "meshes"), Strings{each.finest});
    }
}

TEST(ExportedPartsTest, ofACharactersLevelsTheFinestIsWritten)
{
    ModelBuilder file = skinnedFile("near", "far");
    file.model.extensionsUsed = {"MSFT_lod"};
    file.at(2).extensions["MSFT_lod"] =
        tinygltf::Value(tinygltf::Value::Object{{"ids", tinygltf::Value(tinygltf::Value::Array{tinygltf::Value(3)})}});
    const ImportedModel model = imported(file);
    ASSERT_TRUE(model.root);
    const Json document = documentOf(*model.root);
    ASSERT_EQ(document["meshes"].size(), 1u);
    EXPECT_EQ(document["meshes"][0]["primitives"].size(), 1u);
}

TEST(ExportedPartsTest, meshesAreFoundByTheirNodesNames)
{
    const ImportedModel model = imported(skinnedFile("Hat", "Coat"));
    ASSERT_TRUE(model.root);
    const osg::ref_ptr<osg::Group> read = throughGlb(*model.root);
    ASSERT_TRUE(read);
    for (const char* name : {"Hat", "Coat"})
    {
        const SkinnedGeometry* const mesh = findCharacter(*read)->findMesh(name);
        ASSERT_TRUE(mesh) << name;
        EXPECT_EQ(mesh->getName(), "Mesh");
        EXPECT_EQ(nodeNameOf(*mesh), name);
    }
}

TEST(ExportedPartsTest, hiddenMeshesComeBackHidden)
{
    const ImportedModel model = imported(skinnedFile("Hat", "Coat"));
    ASSERT_TRUE(model.root);
    ASSERT_TRUE(findCharacter(*model.root)->setMeshVisible("Coat", false));
    const osg::ref_ptr<osg::Group> read = throughGlb(*model.root);
    ASSERT_TRUE(read);
    for (const auto& [name, isHidden] : {std::pair("Hat", false), std::pair("Coat", true)})
    {
        const SkinnedGeometry* const mesh = findCharacter(*read)->findMesh(name);
        ASSERT_TRUE(mesh) << name;
        EXPECT_EQ(mesh->getNodeMask() == 0, isHidden) << name;
    }
}

TEST(ExportedPartsTest, hiddenGeometryDoesNotHideItsNeighbours)
{
    const osg::ref_ptr<osg::MatrixTransform> scene = new osg::MatrixTransform(osg::Matrix::translate(1, 2, 3));
    scene->setName("place");
    const osg::ref_ptr<osg::Switch> choice = new osg::Switch;
    choice->addChild(triangle("off"), false);
    choice->addChild(triangle("on"), true);
    scene->addChild(choice);
    const osg::ref_ptr<osg::Geometry> masked = triangle("masked");
    masked->setNodeMask(0);
    scene->addChild(masked);
    const Json document = documentOf(*scene);
    EXPECT_EQ(document["extensionsUsed"], Json({"KHR_node_visibility"}));
    Strings hidden, shown;
    for (const Json& node : document["nodes"])
        if (node.contains("mesh"))
            (node.contains("extensions") ? hidden : shown)
                .push_back(document["meshes"][node["mesh"].get<std::size_t>()]["name"]);
    EXPECT_EQ(hidden, Strings({"off", "masked"}));
    EXPECT_EQ(shown, Strings{"on"});
}

TEST(ExportedPartsTest, transformsOfUniformsReachTheCoordinates)
{
    const osg::ref_ptr<osg::Geometry> geometry = triangle("slide");
    geometry->setNormalArray(new osg::Vec3Array(3), osg::Array::BIND_PER_VERTEX);
    for (osg::Vec3& normal : *static_cast<osg::Vec3Array*>(geometry->getNormalArray()))
        normal.set(0, -1, 0);
    const osg::Vec2 places[] = {{0.25f, 0.5f}, {1, 0}, {0, 1}};
    geometry->setTexCoordArray(0, new osg::Vec2Array(3, places));
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(2, 2, 1, GL_RGB, GL_UNSIGNED_BYTE);
    osg::StateSet& state = *geometry->getOrCreateStateSet();
    state.setTextureAttributeAndModes(0, new osg::Texture2D(image));
    const float offset[] = {0.5f, 0.25f}, scale[] = {2, -3}, rotation = 0.7f;
    setTextureTransform(state, 0, offset, rotation, scale);

    const osg::ref_ptr<osg::Group> read = throughGlb(*geometry);
    ASSERT_TRUE(read);
    osg::ref_ptr<const osg::Vec2Array> found;
    struct Finder : osg::NodeVisitor
    {
        explicit Finder(osg::ref_ptr<const osg::Vec2Array>& out) : NodeVisitor(TRAVERSE_ALL_CHILDREN), _out(out) {}
        void apply(osg::Geometry& each) override
        {
            _out = dynamic_cast<const osg::Vec2Array*>(each.getTexCoordArray(0));
        }
        osg::ref_ptr<const osg::Vec2Array>& _out;
    } finder(found);
    read->accept(finder);
    ASSERT_TRUE(found);
    ASSERT_EQ(found->size(), 3u);
    for (unsigned int i = 0; i < 3; ++i)
    {
        const float u = scale[0] * places[i].x(), v = scale[1] * (1.0f - places[i].y());
        EXPECT_NEAR((*found)[i].x(), std::cos(rotation) * u + std::sin(rotation) * v + offset[0], 1e-5);
        EXPECT_NEAR((*found)[i].y(), 1.0f - (-std::sin(rotation) * u + std::cos(rotation) * v + offset[1]), 1e-5);
    }
}

TEST(ExportedPartsTest, animatedPropertiesAreLostWithOneWarning)
{
    PointerFile file;
    file.quad("red", 0, 0, file.material("red", {1, 0, 0, 1}));
    file.animation("fade");
    for (const char* property : {"roughnessFactor", "metallicFactor"})
        file.animate(std::string("/materials/0/pbrMetallicRoughness/") + property, TINYGLTF_TYPE_SCALAR, {0, 1});
    const ImportedModel model = importedFrom(file.document());
    ASSERT_TRUE(model.root);
    documentOf(*model.root, {"animated properties of materials, lights, cameras and nodes: their curves are not "
                             "written; 2 keep one value"});
}

TEST(ExportedPartsTest, arraysOfOtherKindsAreLeftOutWithAWarning)
{
    const osg::ref_ptr<osg::Geometry> geometry = triangle("packed");
    geometry->setNormalArray(new osg::Vec3bArray(3), osg::Array::BIND_PER_VERTEX);
    geometry->setTexCoordArray(0, new osg::Vec2sArray(3));
    const Json document = documentOf(
        *geometry, {"mesh \"packed\": NORMAL is an array of a kind that is not read (Vec3bArray); left out",
                    "mesh \"packed\": TEXCOORD_0 is an array of a kind that is not read (Vec2sArray); left out"});
    EXPECT_EQ(document["meshes"][0]["primitives"][0]["attributes"].size(), 1u);
}

TEST(ExportedPartsTest, arraysAreCutToTheVertices)
{
    const osg::ref_ptr<osg::Geometry> geometry = triangle("flat");
    const osg::Vec2 corners[] = {{0, 0}, {1, 0}, {0, 1}};
    geometry->setVertexArray(new osg::Vec2Array(3, corners));
    geometry->setTexCoordArray(0, new osg::Vec2Array(osg::Array::BIND_PER_VERTEX, 5));
    const Json document = documentOf(*geometry);
    const Json attributes = document["meshes"][0]["primitives"][0]["attributes"];
    EXPECT_EQ(document["accessors"][attributes["TEXCOORD_0"].get<std::size_t>()]["count"], 3);
    // Positions of two components have z = 0.
    EXPECT_EQ(document["accessors"][attributes["POSITION"].get<std::size_t>()]["max"], Json({1, 1, 0}));
}

TEST(ExportedPartsTest, aLongSplineIsWrittenInPiecesOf256Keys)
{
    const Skeleton skeleton = Skeleton::create({{"mover", -1, {}, 0}}).value();
    ClipBuilder builder(skeleton, {});
    Channel channel{Channel::Path::Translation, Channel::Interpolation::CubicSpline, 0, {}, {}};
    for (int key = 0; key <= 1024; ++key) // a straight line: one piece would do
    {
        channel.times.push_back(key / 64.0);
        channel.values.insert(channel.values.end(), {1, 0, 0, key / 64.0, 0, 0, 1, 0, 0});
    }
    ASSERT_TRUE(builder.add(channel));
    const ClipKeys keys = keysOf(builder.build("line"), {0, 0, 3, false}, {0, 0, 0});
    EXPECT_EQ(keys.times, std::vector<float>({0, 4, 8, 12, 16}));
}

} // namespace

} // namespace osgGpuAnimation::gltf
