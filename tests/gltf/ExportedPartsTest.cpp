// SPDX-License-Identifier: MIT
#include "gltf/EncodedPicture.h"
#include "gltf/ImportedFile.h"
#include "gltf/PointerFile.h"
#include "serializers/RoundTrip.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/looks/PbrMaterial.h>
#include <osgGpuAnimation/mesh/geometry/MeshNames.h>
#include <osgGpuAnimation/nodes/properties/AnimatedProperties.h>

#include <osg/LOD>
#include <osg/MatrixTransform>
#include <osg/Switch>
#include <osg/Texture2D>

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
    return exported(scene, warnings).json;
}

Strings namesOf(const Json& document, const char* member)
{
    Strings names;
    for (const Json& each : document.value(member, Json::array()))
        names.push_back(each.value("name", ""));
    return names;
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
    file.slidingClip("move", joint);
    return file;
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
        levels->addChild(plainTriangle("first"), each.ranges[0][0], each.ranges[0][1]);
        levels->addChild(plainTriangle("second"), each.ranges[1][0], each.ranges[1][1]);
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
    const Json document = documentOf(*model.root);
    ASSERT_EQ(document["meshes"].size(), 1u);
    EXPECT_EQ(document["meshes"][0]["primitives"].size(), 1u);
}

TEST(ExportedPartsTest, namesOfNodesHiddenMeshesAndTheMatrixComeBack)
{
    const ImportedModel model = imported(skinnedFile("Hat", "Coat"));
    AnimatedCharacter& character = *findCharacter(*model.root);
    ASSERT_TRUE(character.getMeshes().setVisible("Coat", false));
    // It is above the turn of the file's axes.
    character.setMatrix(osg::Matrix::rotate(0.5, osg::Vec3(0, 0, 1)) * osg::Matrix::translate(1, 2, 3));
    const osg::ref_ptr<osg::Group> read = throughGlb(*model.root);
    expectSamePose(*model.root, *read, 0, 0.5);
    for (const auto& [name, isHidden] : {std::pair("Hat", false), std::pair("Coat", true)})
    {
        const SkinnedGeometry* const mesh = findCharacter(*read)->getMeshes().find(name);
        ASSERT_TRUE(mesh) << name;
        EXPECT_EQ(mesh->getName(), name);
        EXPECT_EQ(meshNameOf(*mesh), "Mesh");
        EXPECT_EQ(mesh->getNodeMask() == 0, isHidden) << name;
    }
}

TEST(ExportedPartsTest, hiddenGeometryDoesNotHideItsNeighbours)
{
    const osg::ref_ptr<osg::MatrixTransform> scene = new osg::MatrixTransform(osg::Matrix::translate(1, 2, 3));
    scene->setName("place");
    const osg::ref_ptr<osg::Switch> choice = new osg::Switch;
    choice->addChild(plainTriangle("off"), false);
    choice->addChild(plainTriangle("on"), true);
    scene->addChild(choice);
    const osg::ref_ptr<osg::Geometry> masked = plainTriangle("masked");
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
    const osg::ref_ptr<osg::Geometry> geometry = plainTriangle("slide");
    const osg::Vec2 places[] = {{0.25f, 0.5f}, {1, 0}, {0, 1}};
    geometry->setTexCoordArray(0, new osg::Vec2Array(3, places));
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(2, 2, 1, GL_RGB, GL_UNSIGNED_BYTE);
    osg::StateSet& state = *geometry->getOrCreateStateSet();
    state.setTextureAttributeAndModes(0, new osg::Texture2D(image));
    const float offset[] = {0.5f, 0.25f}, scale[] = {2, -3}, rotation = 0.7f;
    setTextureTransform(state, 0, offset, rotation, scale);

    const GlbParts made = exported(*geometry);
    EXPECT_EQ(made.attribute("TEXCOORD_0"), std::vector<double>({0.25, 0.5, 1, 1, 0, 0}));
    const Json& written =
        made.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"];
    EXPECT_NEAR(written["rotation"].get<double>(), rotation, 1e-6);
    for (std::size_t i = 0; i < 2; ++i)
    {
        EXPECT_NEAR(written["offset"][i].get<double>(), offset[i], 1e-6);
        EXPECT_NEAR(written["scale"][i].get<double>(), scale[i], 1e-6);
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
    documentOf(*model.root, {"animated properties of materials, lights, cameras and nodes: their curves are not "
                             "written; 2 keep one value"});
}

/// Meshes that follow one joint, but not as they are: they become skinned, each with its own number of vertices.
TEST(ExportedPartsTest, meshesOfOneEntryWithAnInverseBindComeBack)
{
    Skin skin{"skin", {0}, {AffineMatrix()}};
    skin.inverseBinds[0].rows[0].w = 5.0f;
    AnimationParts parts{Skeleton::create({{"joint", -1, {}, 0}}).value(), {skin}, {}, {}, {}};
    const auto set = AnimationSet::create(std::move(parts));
    ASSERT_TRUE(set) << set.error().message;
    const osg::ref_ptr<AnimatedCharacter> character = new AnimatedCharacter(set.value());
    for (const unsigned int count : {3u, 6u})
    {
        const osg::ref_ptr<SkinnedGeometry> mesh = new SkinnedGeometry;
        mesh->setName("mesh " + std::to_string(count));
        const osg::ref_ptr<osg::Vec3Array> positions = new osg::Vec3Array, normals = new osg::Vec3Array;
        for (unsigned int i = 0; i < count; ++i)
        {
            positions->push_back(osg::Vec3(i % 3 == 1, static_cast<float>(i), i % 3 == 2));
            normals->push_back(osg::Vec3(0, -1, 0));
        }
        mesh->setVertexArray(positions);
        mesh->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
        mesh->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(count)));
        mesh->setRigidEntry(static_cast<unsigned short>(set.value()->entryOfSkin(0, 0)));
        character->addChild(mesh);
    }
    const osg::ref_ptr<osg::Group> read = throughGlb(*character);
    expectSamePose(*character, *read, -1, 0.0);
}

TEST(ExportedPartsTest, ofTheMeshesOfANodeOneMayBeHidden)
{
    ModelBuilder file = skinnedFile("Hat", "Coat");
    file.model.meshes[0].primitives.push_back(file.model.meshes[0].primitives[0]);
    file.model.materials.resize(2);
    for (std::size_t i = 0; i < 2; ++i)
    {
        file.model.materials[i].name = i == 0 ? "felt" : "band";
        file.model.materials[i].emissiveFactor = {0.5 * double(i), 0, 0};
        file.model.meshes[0].primitives[i].material = static_cast<int>(i);
    }
    const ImportedModel model = imported(file);
    for (const ImportedPrimitive& primitive : model.primitives)
        if (primitive.geometry->getStateSet()->getName() == "band") primitive.geometry->setNodeMask(0);
    const Json document = documentOf(*model.root);
    for (const Json& node : document["nodes"])
        if (node.contains("mesh"))
            for (const Json& primitive : document["meshes"][node["mesh"].get<std::size_t>()]["primitives"])
            {
                const Json& material = document["materials"][primitive["material"].get<std::size_t>()];
                EXPECT_EQ(node.contains("extensions"), material.value("name", "") == "band") << material;
            }
}

/// The joints of a skin have a node above them all, so nothing warns of the file that is read again.
TEST(ExportedPartsTest, aSkinOfTwoRootsGetsANodeAbove)
{
    ModelBuilder file;
    const int mesh = file.skinnedTriangle();
    const int first = file.node("first"), second = file.node("second");
    file.at(file.node("skinned", -1, mesh)).skin = file.skin({first, second});
    file.slidingClip("move", second);
    const ImportedModel model = imported(file);
    EXPECT_EQ(model.messages.warnings.size(), 1u);
    const osg::ref_ptr<osg::Group> read = throughGlb(*model.root);
    expectSamePose(*model.root, *read, 0, 0.5);
}

/// A surface of the kit has all of its state; plain ones have that of the nodes above, too.
TEST(ExportedPartsTest, statesAboveReachPlainSurfacesOnly)
{
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->getOrCreateStateSet()->setMode(GL_BLEND, osg::StateAttribute::ON);
    const osg::ref_ptr<osg::Geometry> plain = plainTriangle("plain"), own = plainTriangle("own");
    PbrMaterial material;
    material.metallic = 0.25f;
    applyPbrMaterial(*own->getOrCreateStateSet(), material);
    scene->addChild(plain);
    scene->addChild(own);
    const Json document = documentOf(*scene);
    for (const Json& mesh : document["meshes"])
    {
        const Json& made = document["materials"][mesh["primitives"][0]["material"].get<std::size_t>()];
        EXPECT_EQ(made.value("alphaMode", "OPAQUE"), mesh["name"] == "plain" ? "BLEND" : "OPAQUE") << mesh["name"];
    }
}

/// A picture that is kept as it was is a JPEG again; others become PNG.
TEST(ExportedPartsTest, keptPicturesStayJpegs)
{
    PointerFile file;
    file.quad("red", 0, 0, file.material("red", {1, 1, 1, 1}));
    file.model.textures.resize(1);
    file.model.textures[0].source = 0;
    file.model.materials[0].pbrMetallicRoughness.baseColorTexture.index = 0;
    Json json = Json::parse(file.text());
    const std::string jpeg = encodedPicture("jpg", 4, 4);
    std::string uri = "data:image/jpeg,";
    for (const char byte : jpeg)
    {
        constexpr const char* digits = "0123456789ABCDEF";
        const auto value = static_cast<unsigned char>(byte);
        uri.append({'%', digits[value / 16], digits[value % 16]});
    }
    json["images"] = {{{"uri", uri}}};
    for (const bool isKept : {false, true})
    {
        ImportOptions options;
        options.keepEncoded = isKept;
        const ImportedModel model = importedFrom(json, options);
        const GlbParts made = exported(*model.root);
        ASSERT_EQ(made.json["images"].size(), 1u);
        EXPECT_EQ(made.json["images"][0]["mimeType"], isKept ? "image/jpeg" : "image/png");
        EXPECT_EQ(made.bytes(made.json["images"][0]["bufferView"]) == jpeg, isKept);
    }
}

/// The primitive has its own material, whatever the character shows.
TEST(ExportedPartsTest, variantsAreWrittenBesideTheOwnMaterial)
{
    PointerFile file;
    const int node = file.quad("coat", 0, 0, file.material("own", {1, 0, 0, 1}));
    static_cast<void>(file.material("snow", {1, 1, 1, 1}));
    file.slidingClip("move", node);
    Json json = file.document();
    json["extensionsUsed"].push_back("KHR_materials_variants");
    json["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "summer"}}, {{"name", "winter"}}};
    json["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"] = {
        {{"material", 1}, {"variants", {1}}}};
    for (const char* const shown : {"", "winter"})
    {
        const ImportedModel model = importedFrom(json);
        if (*shown)
        {
            ASSERT_TRUE(findCharacter(*model.root)->getMeshes().setVariant(shown));
        }
        const Json document = documentOf(*model.root);
        const Json& primitive = document["meshes"][0]["primitives"][0];
        const auto nameOf = [&](const Json& material)
        { return document["materials"][material.get<std::size_t>()]["name"]; };
        EXPECT_EQ(nameOf(primitive["material"]), "own") << shown;
        EXPECT_EQ(namesOf(document["extensions"]["KHR_materials_variants"], "variants"), Strings({"summer", "winter"}));
        const Json& mappings = primitive["extensions"]["KHR_materials_variants"]["mappings"];
        ASSERT_EQ(mappings.size(), 1u);
        EXPECT_EQ(nameOf(mappings[0]["material"]), "snow");
        EXPECT_EQ(mappings[0]["variants"], Json({1}));
    }
}

} // namespace

} // namespace osgGpuAnimation::gltf
