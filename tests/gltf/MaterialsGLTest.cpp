// SPDX-License-Identifier: MIT
#include "gltf/data/MaterialMaps.h"
#include "gltf/EncodedPicture.h"
#include "gltf/import/Materials.h"
#include "gltf/ImportedFile.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/looks/CharacterProgram.h>

#include <gtest/gtest.h>
#include <osg/AlphaFunc>
#include <osg/CullFace>
#include <osg/Depth>
#include <osg/FrontFace>
#include <osg/LightModel>
#include <osg/LightSource>
#include <osg/Material>

#include <algorithm>
#include <set>

namespace osgGpuAnimation::gltf
{

namespace
{

using MaterialChange = void (*)(MaterialUse&);

void keep(MaterialUse&) {}

/// Null if the material has no such map.
const MaterialMap* mapAt(const MaterialMaps& maps, PbrMaterial::Map PbrMaterial::*place)
{
    const auto found = std::find_if(maps.maps.begin(), maps.maps.end(),
                                    [place](const MaterialMap& map) { return map.place == place; });
    return found == maps.maps.end() ? nullptr : &*found;
}

/// The state of a file's materials. Material 0 is for tests to change, and texture 0 has a picture.
class MaterialsTest : public ::testing::Test
{
protected:
    MaterialsTest()
    {
        file.texture(encodedPicture("png", 4, 4));
        file.model.materials.resize(1);
    }

    tinygltf::Material& material() { return file.model.materials[0]; }

    osg::ref_ptr<osg::StateSet> state(bool palette, MaterialChange change = keep)
    {
        return states(palette, change).front();
    }

    /// States of all materials, in the file's order, of meshes with all texture coordinates.
    std::vector<osg::ref_ptr<osg::StateSet>> states(bool palette, MaterialChange change = keep,
                                                    bool fixedLighting = true)
    {
        Report report(messages);
        Textures textures(file.model, report, !fixedLighting);
        Materials materials(file.model, fixedLighting, textures, report);
        std::vector<osg::ref_ptr<osg::StateSet>> made;
        for (int index = 0; index < static_cast<int>(file.model.materials.size()); ++index)
        {
            MaterialUse use;
            use.material = index;
            use.palette = palette;
            use.coordinates = materials.wantedCoordinates(index);
            change(use);
            made.emplace_back(materials.stateSet(use));
            EXPECT_EQ(materials.stateSet(use), made.back()) << "shared";
            use.mirrored = !use.mirrored; // another use, which warns of nothing again
            materials.stateSet(use);
        }
        return made;
    }

    template <typename Attribute>
    static const Attribute* get(const osg::StateSet& state, osg::StateAttribute::Type type)
    {
        return dynamic_cast<const Attribute*>(state.getAttribute(type));
    }

    template <typename Value>
    static Value uniform(const osg::StateSet& state, const char* name)
    {
        Value value{};
        if (const osg::Uniform* found = state.getUniform(name)) found->get(value);
        return value;
    }

    ModelBuilder file;
    Messages messages;
};

std::string definesOf(const osg::StateSet& state)
{
    std::string text;
    for (const auto& [name, define] : state.getDefineList())
        if (name.compare(0, 9, "MATERIAL_") == 0) text += name + ' ' + define.first + '\n';
    return text;
}

PbrMaterial read(const tinygltf::Material& material)
{
    PbrMaterial result;
    readMaterialExtensions(material, result);
    return result;
}

class MaterialsGLTest : public ViewerGLTest
{
protected:
    /// A triangle with that material, from before. isMoving: it slides, so that it is drawn from the palette. above:
    /// what it is added to.
    osg::ref_ptr<osg::Image> pictureOf(const tinygltf::Material& material, bool isMoving, bool isColored = false,
                                       osg::Group* above = nullptr)
    {
        ModelBuilder file;
        const int mesh = file.triangle();
        if (isColored)
            file.primitive(mesh).attributes["COLOR_0"] = file.floats(TINYGLTF_TYPE_VEC3, {1, 1, 0, 1, 1, 0, 1, 1, 0});
        if (above)
            file.primitive(mesh).attributes["NORMAL"] = file.floats(TINYGLTF_TYPE_VEC3, {0, 0, 1, 0, 0, 1, 0, 0, 1});
        file.model.materials = {material};
        file.model.extensionsUsed = {"KHR_materials_unlit"};
        file.primitive(mesh).material = 0;
        const int node = file.node("leaf", -1, mesh);
        if (isMoving) file.slidingClip("slide", node);
        ImportOptions options;
        options.noRotation = true;
        viewer().getCamera()->setViewMatrixAsLookAt({0.25, 0.25, 10}, {0.25, 0.25, 0}, {0, 1, 0});
        viewer().getCamera()->setClearColor({0, 0, 0, 1});
        const osg::ref_ptr<osg::Node> root = imported(file, options).root;
        if (above) above->addChild(root);
        return ViewerGLTest::pictureOf(above ? above : root.get(), {0.0});
    }
};

/// OSG with the fixed pipeline, such as Debian's, causes GL errors of its own in the core profile.
class CoreMaterialsGLTest : public InCoreProfile<MaterialsGLTest>
{
protected:
    void TearDown() override
    {
        if (!IsSkipped() && !HasFatalFailure()) takeGLErrors();
        InCoreProfile<MaterialsGLTest>::TearDown();
    }
};

} // namespace

TEST_F(MaterialsTest, colorsAreBroughtToDisplaySpace)
{
    material().pbrMetallicRoughness.baseColorFactor = {1.0, 0.2140411, 0.0, 0.5};
    material().emissiveFactor = {0.1070205, 0.0, 1.0};
    material().extensions["KHR_materials_emissive_strength"] = valueOf(R"({"emissiveStrength":2.0})");
    const auto expectColors = [&](bool palette, bool fixedLighting)
    {
        const osg::ref_ptr<osg::StateSet> made = states(palette, keep, fixedLighting).front();
        const auto* surface = get<osg::Material>(*made, osg::StateAttribute::MATERIAL);
        ASSERT_TRUE(surface);
        const osg::Vec4 color = surface->getDiffuse(osg::Material::FRONT);
        EXPECT_LT((color - osg::Vec4(1.0f, 0.5f, 0.0f, 0.5f)).length(), 1e-5f) << palette << fixedLighting;
        EXPECT_EQ(surface->getAmbient(osg::Material::FRONT), color);
        if (!fixedLighting) return; // the strength is a uniform's
        EXPECT_LT((surface->getEmission(osg::Material::FRONT) - osg::Vec4(0.5f, 0.0f, 1.0f, 1.0f)).length(), 1e-4f);
    };
    expectColors(false, true);
    expectColors(true, true);
    material().pbrMetallicRoughness.baseColorFactor = {0, 0, 0, 1};
    material().extensions["KHR_materials_pbrSpecularGlossiness"] =
        valueOf(R"({"diffuseFactor":[1.0,0.2140411,0.0,0.5]})");
    expectColors(false, true);
    expectColors(false, false);
}

TEST_F(MaterialsTest, alphaModes)
{
    EXPECT_EQ(state(false)->getRenderingHint(), osg::StateSet::DEFAULT_BIN);
    EXPECT_EQ(uniform<float>(*state(true), "alphaCutoff"), 0.0f);
    material().alphaMode = "MASK";
    material().alphaCutoff = 0.25;
    const osg::ref_ptr<osg::StateSet> masked = state(false);
    const auto* function = get<osg::AlphaFunc>(*masked, osg::StateAttribute::ALPHAFUNC);
    ASSERT_TRUE(function);
    EXPECT_EQ(function->getFunction(), osg::AlphaFunc::GEQUAL);
    EXPECT_EQ(function->getReferenceValue(), 0.25f);
    EXPECT_EQ(uniform<float>(*state(true), "alphaCutoff"), 0.25f);
    material().alphaMode = "BLEND";
    const osg::ref_ptr<osg::StateSet> blend = state(true);
    EXPECT_EQ(blend->getRenderingHint(), osg::StateSet::TRANSPARENT_BIN);
    EXPECT_FALSE(get<osg::Depth>(*blend, osg::StateAttribute::DEPTH)->getWriteMask());
    EXPECT_EQ(uniform<float>(*blend, "alphaCutoff"), 0.0f);
}

TEST_F(MaterialsTest, sidesAndWinding)
{
    EXPECT_EQ(state(false)->getMode(GL_CULL_FACE), osg::StateAttribute::ON);
    EXPECT_FALSE(state(false)->getAttribute(osg::StateAttribute::FRONTFACE));
    for (const bool isDoubleSided : {false, true})
    {
        material().doubleSided = isDoubleSided;
        const osg::ref_ptr<osg::StateSet> mirrored = state(true, [](MaterialUse& use) { use.mirrored = true; });
        EXPECT_EQ(get<osg::FrontFace>(*mirrored, osg::StateAttribute::FRONTFACE)->getMode(), osg::FrontFace::CLOCKWISE);
    }
    EXPECT_EQ(state(false)->getMode(GL_CULL_FACE), osg::StateAttribute::OFF);
    EXPECT_TRUE(get<osg::LightModel>(*state(false), osg::StateAttribute::LIGHTMODEL)->getTwoSided());
}

TEST_F(MaterialsTest, unlitByExtensionOrForWantOfNormals)
{
    EXPECT_FALSE(uniform<bool>(*state(true), "unlit"));
    EXPECT_EQ(state(false)->getMode(GL_LIGHTING), osg::StateAttribute::INHERIT);
    const auto withoutNormals = [](MaterialUse& use) { use.lit = false; };
    EXPECT_TRUE(uniform<bool>(*state(true, withoutNormals), "unlit"));
    EXPECT_EQ(state(false, withoutNormals)->getMode(GL_LIGHTING), osg::StateAttribute::OFF);
    material().extensions["KHR_materials_unlit"] = valueOf("{}");
    EXPECT_TRUE(uniform<bool>(*state(true), "unlit"));
}

TEST_F(MaterialsTest, stateBelongsToItsPipeline)
{
    material().pbrMetallicRoughness.baseColorTexture.index = 0;
    EXPECT_EQ(state(true)->getAttribute(osg::StateAttribute::PROGRAM), characterProgram());
    EXPECT_FALSE(state(false)->getAttribute(osg::StateAttribute::PROGRAM));
    EXPECT_TRUE(state(false)->getTextureAttribute(0, osg::StateAttribute::TEXTURE));
    EXPECT_TRUE(state(false, [](MaterialUse& use) { use.material = -1; })) << "the default material";
}

// Each set of maps and coordinate numbers needs programs of its own.
TEST_F(MaterialsTest, aFileHasALimitedNumberOfSetsOfMaps)
{
    file.model.materials.clear();
    for (int set = 0; set < 81; ++set)
    {
        tinygltf::Material material;
        int rest = set;
        const auto next = [&rest](auto& map)
        {
            if (rest % 3 > 0) map.index = 0, map.texCoord = rest % 3 - 1;
            rest /= 3;
        };
        material.pbrMetallicRoughness.baseColorTexture.index = 0;
        next(material.normalTexture);
        next(material.occlusionTexture);
        next(material.emissiveTexture);
        next(material.pbrMetallicRoughness.metallicRoughnessTexture);
        file.model.materials.push_back(material);
    }
    std::set<std::string> sets;
    for (const osg::ref_ptr<osg::StateSet>& made : states(
             false, [](MaterialUse&) {}, false))
    {
        sets.insert(definesOf(*made));
        EXPECT_TRUE(made->getTextureAttribute(0, osg::StateAttribute::TEXTURE));
    }
    EXPECT_EQ(sets.size(), Materials::maxSets);
    ASSERT_EQ(messages.warnings.size(), 1u);
    EXPECT_EQ(messages.warnings[0], "materials: they have more than 64 different sets of maps and extensions; of the "
                                    "others, the base colour map alone is shown");
}

TEST_F(MaterialsTest, eachMaterialWarnsOnceOfTheMapsThatHaveNoRoom)
{
    tinygltf::Material full;
    full.pbrMetallicRoughness.baseColorTexture.index = 0;
    full.normalTexture.index = full.emissiveTexture.index = full.occlusionTexture.index = 0;
    full.normalTexture.texCoord = 1;
    full.emissiveTexture.texCoord = 2;
    full.occlusionTexture.texCoord = 3;
    full.extensions["KHR_materials_clearcoat"] =
        valueOf(R"({"clearcoatFactor":0.5,"clearcoatTexture":{"index":0},"clearcoatRoughnessTexture":{"index":0},
                    "clearcoatNormalTexture":{"index":0}})");
    full.extensions["KHR_materials_specular"] = valueOf(R"({"specularTexture":{"index":0}})");
    file.model.materials.push_back(full);
    states(
        false, [](MaterialUse&) {}, false);
    EXPECT_EQ(messages.warnings,
              (std::vector<std::string>{
                  "materials[1].occlusionTexture: a vertex has room for 3 texture coordinates; left out",
                  "materials[1].specularTexture: a material has room for 3 maps of extensions; left out"}));
}

// The file's tangents serve the normal map of the clear coat, too. Tangents without a direction serve none.
TEST_F(MaterialsTest, tangentsAreReadForNormalMapsOfTheClearCoat)
{
    const char* const coats[] = {R"({"clearcoatFactor":1.0,"clearcoatNormalTexture":{"index":0}})",
                                 R"({"clearcoatFactor":0.0,"clearcoatNormalTexture":{"index":0}})"};
    for (const auto& [coat, length] : {std::pair(0, 1.0f), {1, 1.0f}, {0, 0.0f}})
    {
        ModelBuilder wall;
        const int mesh = wall.triangle();
        std::map<std::string, int>& attributes = wall.primitive(mesh).attributes;
        attributes["TANGENT"] = wall.floats(TINYGLTF_TYPE_VEC4, {1, 0, 0, 1, length, 0, 0, 1, 1, 0, 0, 1});
        attributes["TEXCOORD_0"] = wall.floats(TINYGLTF_TYPE_VEC2, {0, 0, 1, 0, 0, 1});
        wall.texture();
        wall.model.materials.resize(1);
        wall.model.materials[0].emissiveFactor = {0, 0, 0};
        wall.model.materials[0].extensions["KHR_materials_clearcoat"] = valueOf(coats[coat]);
        wall.model.extensionsUsed = {"KHR_materials_clearcoat"};
        wall.primitive(mesh).material = 0;
        const int node = wall.node("wall", -1, mesh);
        const ImportedModel model = imported(wall);
        const bool isRead = primitiveOf(model, node).geometry->getVertexAttribArray(4) != nullptr;
        EXPECT_EQ(isRead, coat == 0 && length > 0.0f);
        expectWarnings(model, std::vector<std::string>(length > 0.0f ? 0 : 1, "TANGENT: expected directions"));
    }
}

// A still mesh with colours, which may be below a scale.
TEST_F(MaterialsTest, plainMeshesWithColorsAreNormalizedAndShowThem)
{
    ModelBuilder scene;
    const int mesh = scene.triangle();
    scene.primitive(mesh).attributes["COLOR_0"] = scene.floats(TINYGLTF_TYPE_VEC3, {1, 0, 0, 0, 1, 0, 0, 0, 1});
    const int still = scene.node("still", -1, mesh);
    const ImportedModel model = imported(scene);
    const osg::StateSet& plain = *primitiveOf(model, still).geometry->getStateSet();
    EXPECT_EQ(plain.getMode(GL_NORMALIZE), osg::StateAttribute::ON);
    EXPECT_FALSE(plain.getAttribute(osg::StateAttribute::LIGHTMODEL));
    const auto* const colors = get<osg::Material>(plain, osg::StateAttribute::MATERIAL);
    ASSERT_TRUE(colors);
    EXPECT_EQ(colors->getColorMode(), osg::Material::AMBIENT_AND_DIFFUSE) << "the vertices' colours";
}

TEST(MaterialExtensionsTest, factorsAndMapsOfTheExtensions)
{
    tinygltf::Material material;
    tinygltf::ExtensionMap& extensions = material.extensions;
    extensions["KHR_materials_specular"] = valueOf(R"({"specularFactor":0.5})");
    extensions["KHR_materials_clearcoat"] =
        valueOf(R"({"clearcoatFactor":0.7,"clearcoatRoughnessFactor":0.2,"clearcoatTexture":{"index":3},
                    "clearcoatNormalTexture":{"index":0,"scale":0.25}})");
    extensions["KHR_materials_sheen"] = valueOf(R"({"sheenColorFactor":[0.1,0.2,0.3],"sheenRoughnessFactor":0.4})");
    extensions["KHR_materials_transmission"] = valueOf(R"({"transmissionFactor":0.8})");
    const PbrMaterial result = read(material);
    EXPECT_FLOAT_EQ(result.specular, 0.5f);
    EXPECT_FLOAT_EQ(result.clearcoat, 0.7f);
    EXPECT_FLOAT_EQ(result.clearcoatRoughness, 0.2f);
    EXPECT_FLOAT_EQ(result.clearcoatNormalScale, 0.25f);
    EXPECT_EQ(result.sheenColor, osg::Vec3(0.1f, 0.2f, 0.3f));
    EXPECT_FLOAT_EQ(result.sheenRoughness, 0.4f);
    EXPECT_FLOAT_EQ(result.transmission, 0.8f);
    const MaterialMaps maps = mapsOf(material, true);
    ASSERT_TRUE(mapAt(maps, &PbrMaterial::clearcoatMap));
    EXPECT_EQ(mapAt(maps, &PbrMaterial::clearcoatMap)->texture, 3);
    EXPECT_FALSE(mapAt(maps, &PbrMaterial::sheenColorMap));
}

TEST(MaterialExtensionsTest, defaultsAreTheSpecifications)
{
    const PbrMaterial plain = read(tinygltf::Material());
    EXPECT_EQ(plain.specularColor, osg::Vec3(0.04f, 0.04f, 0.04f));
    EXPECT_EQ(plain.specular, 1.0f);
    EXPECT_EQ(plain.emissiveStrength, 1.0f);
    EXPECT_EQ(plain.clearcoat + plain.transmission + plain.sheenColor.length(), 0.0f);
    tinygltf::Material material;
    material.extensions["KHR_materials_pbrSpecularGlossiness"] = valueOf("{}");
    const PbrMaterial glossy = read(material);
    EXPECT_EQ(baseColorOf(material), osg::Vec4(1, 1, 1, 1));
    EXPECT_EQ(glossy.specularColor, osg::Vec3(1, 1, 1));
    EXPECT_EQ(glossy.roughness, 0.0f);
    EXPECT_EQ(glossy.metallic, 0.0f);
}

TEST(MaterialExtensionsTest, indicesOfRefractionAreReflections)
{
    for (const auto& [ior, reflection] : {std::pair("1.5", 0.04f), {"1.0", 0.0f}, {"2.0", 1.0f / 9.0f}, {"0.0", 1.0f}})
    {
        tinygltf::Material material;
        material.extensions["KHR_materials_ior"] = valueOf("{\"ior\":" + std::string(ior) + "}");
        material.extensions["KHR_materials_specular"] = valueOf(R"({"specularColorFactor":[1.0,0.5,0.0]})");
        EXPECT_LT((read(material).specularColor - osg::Vec3(1.0f, 0.5f, 0.0f) * reflection).length(), 1e-6f) << ior;
    }
}

TEST(MaterialExtensionsTest, specularGlossinessReplacesMetalAndRoughness)
{
    tinygltf::Material material;
    material.pbrMetallicRoughness.baseColorTexture.index = 0;
    material.pbrMetallicRoughness.metallicRoughnessTexture.index = 1;
    material.extensions["KHR_materials_pbrSpecularGlossiness"] =
        valueOf(R"({"diffuseFactor":[0.1,0.2,0.3,0.5],"specularFactor":[0.4,0.5,0.6],"glossinessFactor":0.75,
                    "diffuseTexture":{"index":2},"specularGlossinessTexture":{"index":3}})");
    const PbrMaterial result = read(material);
    EXPECT_EQ(baseColorOf(material), osg::Vec4(0.1f, 0.2f, 0.3f, 0.5f));
    EXPECT_EQ(result.metallic, 0.0f);
    EXPECT_FLOAT_EQ(result.roughness, 0.25f);
    EXPECT_EQ(result.specularColor, osg::Vec3(0.4f, 0.5f, 0.6f));
    EXPECT_TRUE(result.isSpecularGlossiness);
    const MaterialMaps maps = mapsOf(material, true);
    EXPECT_EQ(mapAt(maps, &PbrMaterial::baseColorMap)->texture, 2);
    EXPECT_EQ(mapAt(maps, &PbrMaterial::specularColorMap)->texture, 3);
    EXPECT_FALSE(mapAt(maps, &PbrMaterial::metallicRoughnessMap));
    EXPECT_EQ(mapAt(mapsOf(material, false), &PbrMaterial::baseColorMap)->texture, 2) << "lighting=fixed";
}

// The maps of the clear coat come before those of sheen and transmission.
TEST(MaterialExtensionsTest, mapsOfExtensionsHaveThreeTextureUnitsIfTheyHaveAnEffect)
{
    const struct
    {
        const char *clearcoat, *transmission;
        bool isUnlit;
        MapUse coat, sheen, transmitted;
    } cases[] = {
        {"1.0", "1.0", false, MapUse::Shown, MapUse::NoTextureUnit, MapUse::NoTextureUnit},
        {"0.0", "1.0", false, MapUse::WithoutEffect, MapUse::Shown, MapUse::Shown},
        {"0.0", "0.0", false, MapUse::WithoutEffect, MapUse::Shown, MapUse::WithoutEffect},
        {"0.0", "1.0", true, MapUse::WithoutEffect, MapUse::Shown, MapUse::WithoutEffect},
    };
    for (const auto& one : cases)
    {
        tinygltf::Material material;
        tinygltf::ExtensionMap& extensions = material.extensions;
        extensions["KHR_materials_clearcoat"] = valueOf(
            R"({"clearcoatTexture":{"index":0},"clearcoatRoughnessTexture":{"index":1},
                "clearcoatNormalTexture":{"index":2},"clearcoatFactor":)" +
            std::string(one.clearcoat) + '}');
        extensions["KHR_materials_sheen"] =
            valueOf(R"({"sheenColorFactor":[0.1,0.2,0.3],"sheenColorTexture":{"index":3}})");
        extensions["KHR_materials_transmission"] = valueOf(
            R"({"transmissionTexture":{"index":4},"transmissionFactor":)" + std::string(one.transmission) + '}');
        if (one.isUnlit) material.extensions["KHR_materials_unlit"] = valueOf("{}");
        const MaterialMaps maps = mapsOf(material, true);
        EXPECT_EQ(mapAt(maps, &PbrMaterial::clearcoatNormalMap)->use, one.coat);
        EXPECT_EQ(mapAt(maps, &PbrMaterial::sheenColorMap)->use, one.sheen);
        EXPECT_EQ(mapAt(maps, &PbrMaterial::transmissionMap)->use, one.transmitted);
        EXPECT_EQ(maps.hasNormalMap(), one.coat == MapUse::Shown);
    }
}

// Section 3.9.4 of glTF 2.0: an alpha of at least the cutoff is opaque.
TEST_F(MaterialsGLTest, anAlphaThatEqualsTheCutoffIsDrawn)
{
    struct Case
    {
        double alpha, cutoff;
        bool isDrawn;
    };
    const Case cases[] = {{1.0, 1.0, true}, {0.5, 0.5, true}, {0.0, 0.0, true}, {0.4, 0.5, false}, {0.6, 0.5, true}};
    for (const bool isMoving : {false, true})
        for (const Case& masked : cases)
        {
            tinygltf::Material material;
            material.pbrMetallicRoughness.baseColorFactor = {1.0, 1.0, 1.0, masked.alpha};
            material.alphaMode = "MASK";
            material.alphaCutoff = masked.cutoff;
            pictureOf(material, isMoving);
            EXPECT_EQ(picture().pixelsDrawn() > 20, masked.isDrawn)
                << masked.alpha << " of " << masked.cutoff << (isMoving ? ", moving" : ", still");
        }
}

// A red light from the eye.
TEST_F(CoreMaterialsGLTest, osgsLightsShineOnFiles)
{
    viewer().setLightingMode(osg::View::NO_LIGHT);
    viewer().getCamera()->getOrCreateStateSet()->clear();
    tinygltf::Material material;
    material.pbrMetallicRoughness.metallicFactor = 0.0;
    for (const bool isMoving : {false, true})
    {
        const osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
        source->getLight()->setPosition(osg::Vec4(0, 0, 1, 0));
        source->getLight()->setAmbient(osg::Vec4(0, 0, 0, 1));
        source->getLight()->setDiffuse(osg::Vec4(1, 0, 0, 1));
        source->setStateSetModes(*source->getOrCreateStateSet(), osg::StateAttribute::ON);
        source->getStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::ON);
        const osg::ref_ptr<osg::LightModel> dark = new osg::LightModel;
        dark->setAmbientIntensity(osg::Vec4(0, 0, 0, 1));
        source->getStateSet()->setAttribute(dark);
        const osg::Vec4 found = pictureOf(material, isMoving, false, source)->getColor(32u, 32u);
        EXPECT_GT(found.r(), 0.8f) << isMoving;
        EXPECT_LT(found.g(), 0.02f) << isMoving;
    }
}

TEST_F(MaterialsGLTest, withoutLightTheColorIsTheFactorTimesTheVertices)
{
    tinygltf::Material material;
    material.pbrMetallicRoughness.baseColorFactor = {0.0, 1.0, 1.0, 1.0};
    material.extensions["KHR_materials_unlit"] = tinygltf::Value(tinygltf::Value::Object());
    for (const bool isMoving : {false, true})
        for (const bool isColored : {false, true}) // yellow
            EXPECT_EQ(pictureOf(material, isMoving, isColored)->getColor(32u, 32u),
                      osg::Vec4(0, 1, isColored ? 0 : 1, 1))
                << (isMoving ? "moving" : "still") << (isColored ? ", with colours" : "");
}

} // namespace osgGpuAnimation::gltf
