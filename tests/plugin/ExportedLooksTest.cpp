// SPDX-License-Identifier: MIT
#include "gltf/data/Picture.h"
#include "gltf/write/PictureWriter.h"
#include "plugin/ExportedDocument.h"

#include <osgGpuAnimation/looks/PbrMaterial.h>

#include <osg/AlphaFunc>
#include <osg/Material>
#include <osg/Texture2D>

#include <algorithm>
#include <functional>
#include <set>

namespace osgGpuAnimation::gltf
{

namespace
{

using Json = nlohmann::json;

/// Equal but for the rounding of floats.
void expectNear(const Json& found, const Json& expected, const std::string& place)
{
    if (found.is_number() && expected.is_number())
    {
        EXPECT_NEAR(found.get<double>(), expected.get<double>(), 1e-5) << place;
        return;
    }
    ASSERT_EQ(found.type(), expected.type()) << place << ": " << found;
    ASSERT_EQ(found.size(), expected.size()) << place << ": " << found;
    if (!found.is_structured())
    {
        EXPECT_EQ(found, expected) << place;
        return;
    }
    for (const auto& [key, value] : expected.items())
    {
        const bool isThere = found.is_array() || found.contains(key);
        EXPECT_TRUE(isThere) << place << " lacks " << key << ": " << found;
        if (isThere)
            expectNear(found.is_array() ? found[static_cast<std::size_t>(std::stoul(key))] : found[key], value,
                       place + '/' + key);
    }
}

/// The only material of a triangle with texture coordinates of all three sets.
Json materialOf(const std::function<void(osg::StateSet&)>& setUp, bool hasCoordinates = true)
{
    const osg::ref_ptr<osg::Geometry> geometry = plainTriangle("triangle");
    if (hasCoordinates)
    {
        geometry->setTexCoordArray(0, new osg::Vec2Array(3), osg::Array::BIND_PER_VERTEX);
        geometry->setVertexAttribArray(9, new osg::Vec4Array(3), osg::Array::BIND_PER_VERTEX);
    }
    setUp(*geometry->getOrCreateStateSet());
    const GlbParts made = exported(*geometry);
    EXPECT_EQ(made.json["materials"].size(), 1u);
    return made.json["materials"][0];
}

struct LookCase
{
    const char* name;
    std::function<void(osg::StateSet&)> setUp;
    const char* expected; ///< changes of the material of a state without anything
};

osg::Material& colorsOf(osg::StateSet& state)
{
    osg::ref_ptr<osg::Material> made = new osg::Material;
    made->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(1, 1, 1, 1));
    state.setAttribute(made);
    return *made;
}

/// IEC 61966-2-1: 0.5 as displayed is 0.2140411 in linear light, 0.2 is 0.0331048.
const LookCase fixedLooks[] = {
    {"nothing", [](osg::StateSet&) {}, "{}"},
    {"a colour as it is displayed",
     [](osg::StateSet& state)
     { colorsOf(state).setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(0.5f, 0.2f, 0, 0.25f)); },
     R"({"pbrMetallicRoughness": {"baseColorFactor": [0.2140411, 0.0331048, 0, 0.25]}})"},
    {"emission",
     [](osg::StateSet& state)
     { colorsOf(state).setEmission(osg::Material::FRONT_AND_BACK, osg::Vec4(0, 0.5f, 0.2f, 1)); },
     R"({"emissiveFactor": [0, 0.2140411, 0.0331048]})"},
    {"a highlight of exponent 30: roughness^4 = 2 / 32",
     [](osg::StateSet& state)
     {
         osg::Material& shining = colorsOf(state);
         shining.setSpecular(osg::Material::FRONT_AND_BACK, osg::Vec4(0, 0, 0.1f, 1));
         shining.setShininess(osg::Material::FRONT_AND_BACK, 30.0f);
     },
     R"({"pbrMetallicRoughness": {"roughnessFactor": 0.5}})"},
    {"an exponent without a highlight",
     [](osg::StateSet& state)
     {
         osg::Material& dull = colorsOf(state);
         dull.setSpecular(osg::Material::FRONT_AND_BACK, osg::Vec4(0, 0, 0, 1));
         dull.setShininess(osg::Material::FRONT_AND_BACK, 30.0f);
     },
     "{}"},
    {"the material's name", [](osg::StateSet& state) { colorsOf(state).setName("brick"); }, R"({"name": "brick"})"},
    {"the state's name counts more",
     [](osg::StateSet& state)
     {
         colorsOf(state).setName("brick");
         state.setName("wall");
     },
     R"({"name": "wall"})"},
    {"culled back faces", [](osg::StateSet& state) { state.setMode(GL_CULL_FACE, osg::StateAttribute::ON); },
     R"({"doubleSided": null})"},
    {"blending", [](osg::StateSet& state) { state.setMode(GL_BLEND, osg::StateAttribute::ON); },
     R"({"alphaMode": "BLEND"})"},
    {"blending that is off", [](osg::StateSet& state) { state.setMode(GL_BLEND, osg::StateAttribute::OFF); }, "{}"},
    {"the bin of transparent surfaces",
     [](osg::StateSet& state) { state.setRenderingHint(osg::StateSet::TRANSPARENT_BIN); }, R"({"alphaMode": "BLEND"})"},
    {"an alpha test",
     [](osg::StateSet& state) { state.setAttributeAndModes(new osg::AlphaFunc(osg::AlphaFunc::GREATER, 0.25f)); },
     R"({"alphaMode": "MASK", "alphaCutoff": 0.25})"},
    {"an alpha test that is off",
     [](osg::StateSet& state)
     { state.setAttributeAndModes(new osg::AlphaFunc(osg::AlphaFunc::GREATER, 0.25f), osg::StateAttribute::OFF); },
     "{}"},
    {"the alpha test counts more than blending",
     [](osg::StateSet& state)
     {
         state.setAttributeAndModes(new osg::AlphaFunc(osg::AlphaFunc::GREATER, 0.25f));
         state.setMode(GL_BLEND, osg::StateAttribute::ON);
     },
     R"({"alphaMode": "MASK", "alphaCutoff": 0.25})"},
    {"no lighting", [](osg::StateSet& state) { state.setMode(GL_LIGHTING, osg::StateAttribute::OFF); },
     R"({"extensions": {"KHR_materials_unlit": {}}})"},
    {"lighting", [](osg::StateSet& state) { state.setMode(GL_LIGHTING, osg::StateAttribute::ON); }, "{}"},
    {"PBR: factors",
     [](osg::StateSet& state)
     {
         PbrMaterial material;
         material.baseColor.set(0.1f, 0.2f, 0.3f, 0.4f);
         material.metallic = 0.6f;
         material.roughness = 0.7f;
         material.emissive.set(0.5f, 0.25f, 0);
         material.emissiveStrength = 3.0f;
         material.specularColor.set(0.02f, 0.04f, 0.08f);
         material.specular = 0.5f;
         material.clearcoat = 0.8f;
         material.clearcoatRoughness = 0.3f;
         material.sheenColor.set(0, 0.5f, 0.25f);
         material.sheenRoughness = 0.9f;
         applyPbrMaterial(state, material);
     },
     R"({"pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0.6,
         "roughnessFactor": 0.7}, "emissiveFactor": [0.5, 0.25, 0], "extensions": {
         "KHR_materials_emissive_strength": {"emissiveStrength": 3},
         "KHR_materials_specular": {"specularColorFactor": [0.5, 1, 2], "specularFactor": 0.5},
         "KHR_materials_clearcoat": {"clearcoatFactor": 0.8, "clearcoatRoughnessFactor": 0.3},
         "KHR_materials_sheen": {"sheenColorFactor": [0, 0.5, 0.25], "sheenRoughnessFactor": 0.9}}})"},
    {"PBR: what transmits light is drawn by blending, but not BLEND",
     [](osg::StateSet& state)
     {
         PbrMaterial material;
         material.metallic = 0.0f;
         material.transmission = 0.75f;
         applyPbrMaterial(state, material);
     },
     R"({"extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.75}}})"},
    {"PBR: specular and glossiness",
     [](osg::StateSet& state)
     {
         PbrMaterial material;
         material.baseColor.set(0.1f, 0.2f, 0.3f, 0.4f);
         material.isSpecularGlossiness = true;
         material.specularColor.set(0.5f, 0.25f, 0.125f);
         material.roughness = 0.2f;
         applyPbrMaterial(state, material);
     },
     R"({"pbrMetallicRoughness": null, "extensions": {"KHR_materials_pbrSpecularGlossiness": {
         "diffuseFactor": [0.1, 0.2, 0.3, 0.4], "specularFactor": [0.5, 0.25, 0.125], "glossinessFactor": 0.8}}})"},
};

TEST(ExportedLooksTest, statesBecomeMaterials)
{
    const Json plain = Json::parse(R"({"doubleSided": true, "pbrMetallicRoughness": {
        "baseColorFactor": [1, 1, 1, 1], "metallicFactor": 0, "roughnessFactor": 1}})");
    for (const LookCase& each : fixedLooks)
    {
        SCOPED_TRACE(each.name);
        Json expected = plain;
        expected.merge_patch(Json::parse(each.expected));
        expectNear(materialOf(each.setUp), expected, "");
    }
}

osg::ref_ptr<osg::Texture2D> texture(unsigned char grey, int size = 2)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(size, size, 1, GL_RGB, GL_UNSIGNED_BYTE, 1);
    std::fill_n(image->data(), image->getTotalSizeInBytes(), grey);
    image->setName("grey " + std::to_string(grey));
    osg::ref_ptr<osg::Texture2D> made = new osg::Texture2D(image);
    made->setInternalFormat(GL_RGB8);
    return made;
}

/// A material with all its maps, the i-th with the coordinates i % 3.
void setMaps(osg::StateSet& state)
{
    PbrMaterial material;
    material.clearcoat = 1.0f;
    material.normalScale = 0.5f;
    material.occlusionStrength = 0.25f;
    material.clearcoatNormalScale = 2.0f;
    material.hasMoreCoordinates = true;
    int number = 0;
    for (PbrMaterial::Map PbrMaterial::*const map :
         {&PbrMaterial::baseColorMap, &PbrMaterial::metallicRoughnessMap, &PbrMaterial::normalMap,
          &PbrMaterial::occlusionMap, &PbrMaterial::emissiveMap, &PbrMaterial::clearcoatMap,
          &PbrMaterial::clearcoatRoughnessMap, &PbrMaterial::clearcoatNormalMap})
    {
        material.*map = {texture(static_cast<unsigned char>(number)), number % 3};
        ++number;
    }
    applyPbrMaterial(state, material);
}

TEST(ExportedLooksTest, mapsKeepTheirCoordinatesAndFactors)
{
    const Json found = materialOf(setMaps);
    struct MapCase
    {
        const char* place;
        int coordinates;
        const char* factor; ///< null: none
        double value;
    };
    const MapCase cases[] = {
        {"/pbrMetallicRoughness/baseColorTexture", 0, nullptr, 0},
        {"/pbrMetallicRoughness/metallicRoughnessTexture", 1, nullptr, 0},
        {"/normalTexture", 2, "scale", 0.5},
        {"/occlusionTexture", 0, "strength", 0.25},
        {"/emissiveTexture", 1, nullptr, 0},
        {"/extensions/KHR_materials_clearcoat/clearcoatTexture", 2, nullptr, 0},
        {"/extensions/KHR_materials_clearcoat/clearcoatRoughnessTexture", 0, nullptr, 0},
        {"/extensions/KHR_materials_clearcoat/clearcoatNormalTexture", 1, "scale", 2.0},
    };
    std::set<int> textures;
    for (const MapCase& each : cases)
    {
        SCOPED_TRACE(each.place);
        const Json::json_pointer place(each.place);
        ASSERT_TRUE(found.contains(place)) << found;
        EXPECT_EQ(found[place].value("texCoord", 0), each.coordinates);
        if (each.factor)
        {
            EXPECT_EQ(found[place].value(each.factor, 1.0), each.value);
        }
        textures.insert(found[place]["index"].get<int>());
    }
    EXPECT_EQ(textures.size(), std::size(cases)) << "each map has its own picture";
    EXPECT_FALSE(materialOf(setMaps, false).contains("emissiveTexture")) << "without coordinates";
}

TEST(ExportedLooksTest, picturesAndSamplersAreWrittenOnce)
{
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    const osg::ref_ptr<osg::Texture2D> textures[] = {texture(1), texture(2), texture(1), texture(255, 1)};
    textures[0]->setWrap(osg::Texture::WRAP_S, osg::Texture::REPEAT);
    textures[0]->setWrap(osg::Texture::WRAP_T, osg::Texture::MIRROR);
    textures[0]->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST_MIPMAP_LINEAR);
    textures[0]->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
    textures[1]->setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_BORDER);
    textures[1]->setWrap(osg::Texture::WRAP_T, osg::Texture::REPEAT);
    textures[1]->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
    textures[1]->setFilter(osg::Texture::MAG_FILTER, osg::Texture::LINEAR);
    for (int i = 0; i < 4; ++i)
    {
        const osg::ref_ptr<osg::Geometry> geometry = plainTriangle("triangle " + std::to_string(i));
        geometry->setTexCoordArray(0, new osg::Vec2Array(3), osg::Array::BIND_PER_VERTEX);
        geometry->getOrCreateStateSet()->setTextureAttributeAndModes(0, textures[i]);
        scene->addChild(geometry);
    }
    const Json json = exported(*scene).json;
    ASSERT_EQ(json["images"].size(), 2u) << "of equal pictures one is written, of the white pixel none";
    EXPECT_EQ(json["images"][0]["name"], "grey 1");
    ASSERT_EQ(json["textures"].size(), 3u);
    EXPECT_EQ(json["textures"][2]["source"], 0);
    const int wanted[][4] = {{10497, 33648, 9986, 9728}, {33071, 10497, 9729, 9729}};
    for (std::size_t i = 0; i < 2; ++i)
    {
        const Json& sampler = json["samplers"][json["textures"][i]["sampler"].get<std::size_t>()];
        const char* const members[] = {"wrapS", "wrapT", "minFilter", "magFilter"};
        for (std::size_t member = 0; member < 4; ++member)
            EXPECT_EQ(sampler[members[member]], wanted[i][member]) << i << members[member];
    }
    EXPECT_EQ(json["materials"].size(), 4u);
}

TEST(ExportedLooksTest, picturesWithTheirFirstRowOnTopStayUpright)
{
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(2, 3, 1, GL_RGB, GL_UNSIGNED_SHORT, 2);
    image->setOrigin(osg::Image::TOP_LEFT);
    for (unsigned int row = 0; row < 3; ++row)
        for (unsigned int i = 0; i < 6; ++i)
            reinterpret_cast<std::uint16_t*>(image->data(0, row))[i] =
                static_cast<std::uint16_t>(1000 * row + 7 * i + 1);
    const Result<std::string> png = encodePng(*image);
    ASSERT_TRUE(png) << png.error().message;
    const auto read = decodePicture({png.value().begin(), png.value().end()});
    ASSERT_TRUE(read) << read.error().message;
    ASSERT_EQ(read.value()->getDataType(), GLenum(GL_UNSIGNED_SHORT));
    for (unsigned int row = 0; row < 3; ++row) // the decoded one begins at the bottom
        EXPECT_EQ(std::memcmp(read.value()->data(0, 2 - row), image->data(0, row), 12), 0) << row;
}

} // namespace

} // namespace osgGpuAnimation::gltf
