// SPDX-License-Identifier: MIT
#include "gltf/data/Accessor.h"
#include "gltf/scene/TriangleMesh.h"
#include "plugin/EncodedPicture.h"
#include "plugin/ImportedFile.h"
#include "plugin/PackedDocument.h"
#include "plugin/PointerFile.h"
#include "support/ScratchFolder.h"

#include <osgGpuAnimation/animation/bounds/TransformBound.h>
#include <osgGpuAnimation/looks/PbrMaterial.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <osg/FrontFace>
#include <osg/Material>
#include <osg/Texture2D>

#include <cmath>
#include <cstdint>

namespace osgGpuAnimation::gltf
{

namespace
{

using Json = nlohmann::json;

/// The picture as a data URI.
std::string uriOf(const std::string& bytes)
{
    constexpr const char* digits = "0123456789ABCDEF";
    std::string uri = "data:application/octet-stream,";
    for (const char byte : bytes)
    {
        const auto value = static_cast<unsigned char>(byte);
        uri.append({'%', digits[value / 16], digits[value % 16]});
    }
    return uri;
}

PbrMaterial materialOf(const ImportedModel& model, std::size_t primitive = 0)
{
    const osg::ref_ptr<osg::Geometry> geometry = model.primitives.at(primitive).geometry;
    return pbrMaterialOf(*geometry->getStateSet()).value_or(PbrMaterial());
}

// Values of a sparse accessor are as normalized as the others, and the second byte of an index counts.
TEST(ImportedDetailsTest, sparseElementsAreLikeTheOthers)
{
    PackedDocument file;
    const std::vector<std::uint16_t> indices{2, 259};
    const std::vector<std::uint8_t> values{255, 51};
    const std::size_t first = file.addView(std::string(reinterpret_cast<const char*>(indices.data()), 4));
    const std::size_t second = file.addView(std::string(reinterpret_cast<const char*>(values.data()), 2));
    const int accessor = file.accessor("SCALAR", TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, 300, -1, true);
    file.json["accessors"][0]["sparse"] = {
        {"count", 2},
        {"indices", {{"bufferView", first}, {"componentType", TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT}}},
        {"values", {{"bufferView", second}}}};
    const Result<tinygltf::Model> model = file.load();
    ASSERT_TRUE(model) << model.error().message;
    std::vector<float> expected(300);
    expected[2] = 1.0f;
    expected[259] = 0.2f;
    EXPECT_EQ(readFloats(model.value(), accessor), expected);
}

TEST(ImportedDetailsTest, changesOfColoursWithoutAlphaLeaveIt)
{
    ModelBuilder file;
    const int mesh = file.triangle();
    file.primitive(mesh).attributes["COLOR_0"] =
        file.floats(TINYGLTF_TYPE_VEC4, {0.5f, 0.5f, 0.5f, 0.25f, 0, 0, 0, 0, 1, 1, 1, 0.5f});
    file.primitive(mesh).targets = {{{"COLOR_0", file.floats(TINYGLTF_TYPE_VEC3, {0.5f, 0, 0, 0, 0, 0, 0, 0, 0})}}};
    file.node("mesh", -1, mesh);
    const ImportedModel model = imported(file);
    ASSERT_EQ(model.primitives.size(), 1u);
    const auto& skinned = dynamic_cast<const SkinnedGeometry&>(*model.primitives[0].geometry);
    const osg::ref_ptr<osg::Vec4Array> changes = skinned.getMorphTargets().at(0).colors;
    ASSERT_TRUE(changes);
    EXPECT_NEAR((*changes)[0].r(), 1.0f - 0.7353569f, 1e-5) << "IEC 61966-2-1 of 1 and of 0.5";
    for (const osg::Vec4& change : *changes)
        EXPECT_EQ(change.a(), 0.0f);
}

TEST(ImportedDetailsTest, indicesOfRefractionAreReflections)
{
    const std::pair<double, float> cases[] = {{1.5, 0.04f}, {1.0, 0.0f}, {2.0, 1.0f / 9.0f}, {0.0, 1.0f}};
    for (const auto& [ior, reflection] : cases)
    {
        PointerFile file;
        file.quad("glass", 0, 0, file.material("glass", {1, 1, 1, 1}, true));
        Json json = Json::parse(file.text());
        json["materials"][0]["extensions"] = {{"KHR_materials_ior", {{"ior", ior}}},
                                              {"KHR_materials_specular", {{"specularColorFactor", {1, 0.5, 0}}}}};
        const PbrMaterial found = materialOf(importedFrom(json));
        EXPECT_NEAR(found.specularColor.x(), reflection, 1e-6) << ior;
        EXPECT_NEAR(found.specularColor.y(), reflection / 2, 1e-6) << ior;
        EXPECT_EQ(found.specularColor.z(), 0.0f) << ior;
    }
}

/// Both orders of a blended and an opaque material: triangles of blended surfaces stay in the file's order in both.
TEST(ImportedDetailsTest, variantsOfOnePrimitiveCountTogether)
{
    for (const bool isOwnBlended : {false, true})
        for (const bool isSkinned : {false, true})
        {
            PointerFile file;
            const int own = file.material("own", {1, 1, 1, 0.5}), other = file.material("other", {1, 1, 1, 0.5});
            file.model.materials[static_cast<std::size_t>(isOwnBlended ? own : other)].alphaMode = "BLEND";
            file.model.textures.resize(1);
            file.model.textures[0].name = "bumps";
            tinygltf::Material& bumpy = file.model.materials[static_cast<std::size_t>(isOwnBlended ? own : other)];
            bumpy.normalTexture.index = 0;
            tinygltf::Material& even = file.model.materials[static_cast<std::size_t>(isOwnBlended ? other : own)];
            even.occlusionTexture.index = 0; // the same coordinates
            const int node = file.quad("fan", 0, 0, own);
            tinygltf::Primitive& primitive = file.primitive(0);
            primitive.mode = TINYGLTF_MODE_TRIANGLES;
            const std::vector<unsigned int> corners{3, 1, 2, 0, 1, 2, 1, 0, 3, 2, 0, 3, 0, 1, 3};
            primitive.indices = file.integers(TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, corners);
            primitive.attributes["TANGENT"] =
                file.floats(TINYGLTF_TYPE_VEC4, {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1});
            if (isSkinned)
            {
                file.animation("move");
                file.slide(node);
            }
            Json json = Json::parse(file.text());
            json["extensionsUsed"].push_back("KHR_materials_variants");
            json["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "second"}}};
            json["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"] = {
                {{"material", other}, {"variants", {0}}}};
            const ImportedModel model = importedFrom(json);
            ASSERT_EQ(model.primitives.size(), 1u);
            const osg::Geometry& geometry = *model.primitives[0].geometry;
            ASSERT_EQ(geometry.getNumPrimitiveSets(), 1u);
            std::vector<unsigned int> found;
            for (unsigned int i = 0; i < geometry.getPrimitiveSet(0)->getNumIndices(); ++i)
                found.push_back(geometry.getPrimitiveSet(0)->index(i));
            EXPECT_EQ(found, corners) << isOwnBlended;
            EXPECT_TRUE(geometry.getVertexAttribArray(4)) << "the tangents for the normal map of either";
        }
}

TEST(ImportedDetailsTest, alphaOfGreyPicturesIsKept)
{
    for (const GLenum type : {GL_UNSIGNED_BYTE, GL_UNSIGNED_SHORT})
    {
        PointerFile file;
        file.quad("grey", 0, 0, file.material("grey", {1, 1, 1, 1}));
        file.model.textures.resize(1);
        file.model.textures[0].source = 0;
        file.model.materials[0].pbrMetallicRoughness.baseColorTexture.index = 0;
        Json json = Json::parse(file.text());
        json["images"] = {{{"uri", uriOf(encodedPicture("png", 2, 2, GL_LUMINANCE_ALPHA, type))}}};
        const osg::ref_ptr<osg::Texture2D> texture = materialOf(importedFrom(json)).baseColorMap.texture;
        ASSERT_TRUE(texture && texture->getImage());
        EXPECT_EQ(texture->getImage()->getPixelFormat(), GLenum(GL_RGBA));
        EXPECT_LT((texture->getImage()->getColor(0u, 0u) - osg::Vec4(0, 0, 0, 0.5f)).length(), 0.01f);
        EXPECT_LT((texture->getImage()->getColor(0u, 1u) - osg::Vec4(1, 1, 1, 1)).length(), 0.01f);
    }
}

/// A picture that one texture names by an extension for other formats and another one as its source.
TEST(ImportedDetailsTest, aPictureOfAnyTextureIsRead)
{
    PointerFile file;
    file.quad("red", 0, 0, file.material("red", {1, 1, 1, 1}));
    file.model.textures.resize(2);
    file.model.textures[0].source = file.model.textures[1].source = 0;
    file.model.materials[0].pbrMetallicRoughness.baseColorTexture.index = 0;
    Json json = Json::parse(file.text());
    json["textures"][1]["extensions"]["KHR_texture_basisu"]["source"] = 0;
    json["images"] = {{{"uri", uriOf(encodedPicture("png", 2, 2))}}};
    EXPECT_TRUE(materialOf(importedFrom(json)).baseColorMap.texture);
}

/// Names that exporters write for a nameless clip give way to the file's name.
TEST(ImportedDetailsTest, clipsOfOtherFilesAreFoundByNamesThatSaySomething)
{
    const ScratchFolder folder;
    ModelBuilder model;
    const int spine = model.node("Spine"), named = model.node("rig:Spine");
    const int skinned = model.skinnedTriangle();
    model.at(model.node("body", -1, skinned)).skin = model.skin({spine, named});
    const std::pair<const char*, const char*> cases[] = {
        {"Take 001", "run"}, {"mixamo.com", "run"}, {"", "run"}, {"Walk", "Walk"}, {"Take 002", "Take 002"}};
    for (const auto& [name, expected] : cases)
    {
        ModelBuilder clips;
        const int joint = clips.node("Spine");
        clips.animation(name);
        clips.slide(joint);
        folder.write("run.gltf", clips.text());
        ImportOptions options;
        options.clipsFiles = {"run.gltf"};
        const std::string path = folder.write("model.gltf", model.text());
        const Result<ImportedModel> read = importModel(model.text(), path, options);
        ASSERT_TRUE(read) << read.error().message;
        ASSERT_EQ(read.value().set->clips().size(), 1u) << name;
        EXPECT_EQ(read.value().set->clips()[0].name(), expected) << name;
    }
}

/// By the areas of the triangles: 0.5 of +Z and 2 of +X.
TEST(ImportedDetailsTest, smoothNormalsFollowTheLargerTriangles)
{
    const osg::Vec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 2, 0}, {0, 0, 2}};
    const osg::ref_ptr<osg::Vec3Array> positions = new osg::Vec3Array(5, corners);
    const osg::ref_ptr<osg::Vec3Array> normals = smoothNormals(*positions, {0, 1, 2, 0, 3, 4});
    ASSERT_EQ(normals->size(), 5u);
    osg::Vec3 expected(2, 0, 0.5f);
    expected.normalize();
    EXPECT_LT(((*normals)[0] - expected).length(), 1e-6f);
    EXPECT_EQ((*normals)[1], osg::Vec3(0, 0, 1));
    EXPECT_EQ((*normals)[4], osg::Vec3(1, 0, 0));
}

/// A bound of what a clip does is that of its largest axis, and a spline may reach the sum of its value and tangents.
TEST(ImportedDetailsTest, boundsOfClipsTakeTheLargestAxisAndTheTangents)
{
    Joint joint{"joint", -1, {}, 0};
    joint.rest.scale = {1, -4, 2, 0};
    joint.rest.translation = {3, 4, 0, 0};
    const Skeleton skeleton = Skeleton::create({joint}).value();
    EXPECT_EQ(boundsAtRest(skeleton)[0].stretch, 4.0);
    EXPECT_EQ(boundsAtRest(skeleton)[0].distance, 5.0);
    ClipParts parts;
    parts.name = "spline";
    parts.form = Clip::Form::Spline;
    parts.jointCount = parts.trackCount = 1;
    parts.times = {0, 1};
    for (int i = 0; i < 6; ++i) // value, tangent before, tangent after
    {
        JointTransform transform;
        transform.translation = {0, i == 4 ? 10 : 1, 0, 0};
        transform.scale = {1, 1, i == 5 ? -20 : 2, 0};
        parts.data.push_back(transform);
    }
    const Result<Clip> clip = Clip::create(parts);
    ASSERT_TRUE(clip) << clip.error().message;
    EXPECT_EQ(boundsOfClip(skeleton, clip.value())[0].distance, 12.0);
    EXPECT_EQ(boundsOfClip(skeleton, clip.value())[0].stretch, 24.0);
}

TEST(ImportedDetailsTest, weightsBelow0MoveVerticesAsFarAsOthers)
{
    for (const float weight : {0.5e10f, -0.5e10f, 0.5f, -0.5f})
    {
        ModelBuilder file;
        const int mesh = file.triangle();
        file.primitive(mesh).targets = {
            {{"POSITION", file.floats(TINYGLTF_TYPE_VEC3, {1e10f, 0, 0, 0, 0, 0, 0, 0, 0})}}};
        const int node = file.node("mesh", -1, mesh);
        file.animation("stretch");
        file.channel(node, "weights", {0, 1}, TINYGLTF_TYPE_SCALAR, {0, weight});
        const ImportedModel model = imported(file);
        const bool isFar = std::abs(weight) > 1.0f; // 0.5e20 is beyond 1e18
        EXPECT_EQ(model.primitives.size(), isFar ? 0u : 1u) << weight;
        EXPECT_EQ(model.messages.warnings.size(), isFar ? 1u : 0u) << weight;
    }
}

/// Of a still mesh with colours below a scale, and of a moving, mirrored one that is drawn from both sides.
TEST(ImportedDetailsTest, statesOfPlainAndOfMirroredMeshes)
{
    for (const bool isFixed : {false, true})
        for (const bool isDoubleSided : {false, true})
        {
            ModelBuilder file;
            const int mesh = file.triangle();
            file.primitive(mesh).attributes["COLOR_0"] = file.floats(TINYGLTF_TYPE_VEC3, {1, 0, 0, 0, 1, 0, 0, 0, 1});
            file.primitive(mesh).material = 0;
            file.model.materials.resize(1);
            file.model.materials[0].emissiveFactor = {0, 0, 0};
            file.model.materials[0].doubleSided = isDoubleSided;
            const int still = file.node("still", -1, mesh), moving = file.node("moving", -1, mesh);
            file.at(moving).scale = {1, 1, -1};
            file.animation("move");
            file.slide(moving);
            ImportOptions options;
            options.fixedLighting = isFixed;
            const ImportedModel model = imported(file, options);
            const osg::StateSet& plain = *primitiveOf(model, still).geometry->getStateSet();
            EXPECT_EQ(plain.getMode(GL_NORMALIZE), osg::StateAttribute::ON);
            const auto* const colors =
                dynamic_cast<const osg::Material*>(plain.getAttribute(osg::StateAttribute::MATERIAL));
            ASSERT_TRUE(colors);
            EXPECT_EQ(colors->getColorMode(), osg::Material::AMBIENT_AND_DIFFUSE) << "the vertices' colours";
            const bool isLitFromBothSides = plain.getAttribute(osg::StateAttribute::LIGHTMODEL) != nullptr;
            EXPECT_EQ(isLitFromBothSides, isFixed && isDoubleSided);
            const osg::StateSet& mirrored = *primitiveOf(model, moving).geometry->getStateSet();
            const auto* const winding =
                dynamic_cast<const osg::FrontFace*>(mirrored.getAttribute(osg::StateAttribute::FRONTFACE));
            ASSERT_TRUE(winding) << isDoubleSided;
            EXPECT_EQ(winding->getMode(), osg::FrontFace::CLOCKWISE);
        }
}

/// What clips show later is hidden at first, with all below it.
TEST(ImportedDetailsTest, hiddenAtRestIsHiddenAtFirst)
{
    for (const bool isVisible : {false, true})
    {
        PointerFile file;
        const int above = file.node("above");
        file.quad("child", 0, 0, file.material("red", {1, 0, 0, 1}), above);
        file.animation("show");
        file.show(above, {0, 1});
        Json json = file.document();
        json["nodes"][0]["extensions"]["KHR_node_visibility"]["visible"] = isVisible;
        const ImportedModel model = importedFrom(json);
        ASSERT_EQ(model.primitives.size(), 1u);
        EXPECT_EQ(model.primitives[0].geometry->getNodeMask() != 0, isVisible);
    }
}

/// Without normals, equal vertices of a skinned mesh become one, and each keeps its own influences.
TEST(ImportedDetailsTest, weldedVerticesKeepTheirInfluences)
{
    ModelBuilder file;
    const std::vector<float> corners{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1};
    const int mesh = file.mesh({{"POSITION", file.floats(TINYGLTF_TYPE_VEC3, corners)}});
    std::vector<unsigned int> joints;
    std::vector<float> weights;
    const float shares[] = {1.0f, 0.75f, 0.5f, 1.0f, 0.5f, 0.25f}; // vertices 3 and 4 equal 0 and 2
    for (const float share : shares)
    {
        joints.insert(joints.end(), {0, 1, 0, 0});
        weights.insert(weights.end(), {share, 1.0f - share, 0, 0});
    }
    file.primitive(mesh).attributes["JOINTS_0"] =
        file.integers(TINYGLTF_TYPE_VEC4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, joints);
    file.primitive(mesh).attributes["WEIGHTS_0"] = file.floats(TINYGLTF_TYPE_VEC4, weights);
    const int first = file.node("first"), second = file.node("second", first);
    file.at(file.node("skinned", -1, mesh)).skin = file.skin({first, second});
    const ImportedModel model = imported(file);
    ASSERT_EQ(model.primitives.size(), 1u);
    const ImportedPrimitive& primitive = model.primitives[0];
    const auto& skinned = dynamic_cast<const SkinnedGeometry&>(*primitive.geometry);
    ASSERT_TRUE(primitive.geometryVertex);
    EXPECT_EQ(skinned.getVertexCount(), 4u);
    for (std::size_t vertex = 0; vertex < 6; ++vertex)
        EXPECT_EQ((*skinned.getWeights(0))[(*primitive.geometryVertex)[vertex]].x(), shares[vertex]) << vertex;
}

} // namespace

} // namespace osgGpuAnimation::gltf
