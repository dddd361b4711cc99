// SPDX-License-Identifier: MIT
#include "gltf/data/Picture.h"
#include "gltf/export/PictureWriter.h"
#include "serializers/RoundTrip.h"
#include "support/StateModes.h"

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
void expectNear(const Json& found, const Json& expected)
{
    const Json flat = found.flatten(), wanted = expected.flatten();
    EXPECT_EQ(flat.size(), wanted.size()) << found;
    for (const auto& [place, value] : wanted.items())
        if (value.is_number() && flat.contains(place))
            EXPECT_NEAR(flat[place].get<double>(), value.get<double>(), 1e-5) << place;
        else
            EXPECT_EQ(flat.value(place, Json("nothing")), value) << place;
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

using SetUp = std::function<void(osg::StateSet&)>;
constexpr auto bothFaces = osg::Material::FRONT_AND_BACK;

/// A white material of OSG, changed.
SetUp fixed(const std::function<void(osg::Material&)>& change)
{
    return [change](osg::StateSet& state)
    {
        osg::ref_ptr<osg::Material> made = new osg::Material;
        made->setDiffuse(bothFaces, osg::Vec4(1, 1, 1, 1));
        change(*made);
        state.setAttribute(made);
    };
}

SetUp pbr(const std::function<void(PbrMaterial&)>& change)
{
    return [change](osg::StateSet& state)
    {
        PbrMaterial material;
        change(material);
        applyPbrMaterial(state, material);
    };
}

SetUp mode(GLenum name, bool isOn)
{
    return [=](osg::StateSet& state)
    { state.setMode(name, isOn ? osg::StateAttribute::ON : osg::StateAttribute::OFF); };
}

SetUp alphaTest(osg::StateAttribute::GLModeValue value)
{
    return [value](osg::StateSet& state)
    { state.setAttributeAndModes(new osg::AlphaFunc(osg::AlphaFunc::GREATER, 0.25f), value); };
}

SetUp both(const SetUp& first, const SetUp& second)
{
    return [=](osg::StateSet& state)
    {
        first(state);
        second(state);
    };
}

void shine(osg::Material& material, float blue)
{
    material.setSpecular(bothFaces, osg::Vec4(0, 0, blue, 1));
    material.setShininess(bothFaces, 30.0f);
}

void setFactors(PbrMaterial& material)
{
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
}

void setSpecularGlossiness(PbrMaterial& material)
{
    material.baseColor.set(0.1f, 0.2f, 0.3f, 0.4f);
    material.isSpecularGlossiness = true;
    material.specularColor.set(0.5f, 0.25f, 0.125f);
    material.roughness = 0.2f;
}

struct LookCase
{
    const char* name;
    SetUp setUp;
    const char* expected; ///< changes of the material of a state without anything
};

/// IEC 61966-2-1: 0.5 as displayed is 0.2140411 in linear light, 0.2 is 0.0331048.
const LookCase looks[] = {
    {"nothing", [](osg::StateSet&) {}, "{}"},
    {"a colour as it is displayed", fixed([](auto& m) { m.setDiffuse(bothFaces, osg::Vec4(0.5f, 0.2f, 0, 0.25f)); }),
     R"({"pbrMetallicRoughness": {"baseColorFactor": [0.2140411, 0.0331048, 0, 0.25]}})"},
    {"emission", fixed([](auto& m) { m.setEmission(bothFaces, osg::Vec4(0, 0.5f, 0.2f, 1)); }),
     R"({"emissiveFactor": [0, 0.2140411, 0.0331048]})"},
    {"a highlight of exponent 30: roughness^4 = 2 / 32", fixed([](auto& m) { shine(m, 0.1f); }),
     R"({"pbrMetallicRoughness": {"roughnessFactor": 0.5}})"},
    {"an exponent without a highlight", fixed([](auto& m) { shine(m, 0.0f); }), "{}"},
    {"the material's name", fixed([](auto& m) { m.setName("brick"); }), R"({"name": "brick"})"},
    {"the state's name counts more",
     both(fixed([](auto& m) { m.setName("brick"); }), [](auto& s) { s.setName("wall"); }), R"({"name": "wall"})"},
    {"culled back faces", mode(GL_CULL_FACE, true), R"({"doubleSided": null})"},
    {"blending", mode(GL_BLEND, true), R"({"alphaMode": "BLEND"})"},
    {"blending that is off", mode(GL_BLEND, false), "{}"},
    {"the bin of transparent surfaces", [](auto& s) { s.setRenderingHint(osg::StateSet::TRANSPARENT_BIN); },
     R"({"alphaMode": "BLEND"})"},
    {"an alpha test", alphaTest(on), R"({"alphaMode": "MASK", "alphaCutoff": 0.25})"},
    {"an alpha test that is off", alphaTest(off), "{}"},
    {"the alpha test counts more than blending", both(alphaTest(on), mode(GL_BLEND, true)),
     R"({"alphaMode": "MASK", "alphaCutoff": 0.25})"},
    {"no lighting", mode(GL_LIGHTING, false), R"({"extensions": {"KHR_materials_unlit": {}}})"},
    {"lighting", mode(GL_LIGHTING, true), "{}"},
    {"PBR: factors", pbr(setFactors),
     R"({"pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0.6,
         "roughnessFactor": 0.7}, "emissiveFactor": [0.5, 0.25, 0], "extensions": {
         "KHR_materials_emissive_strength": {"emissiveStrength": 3},
         "KHR_materials_specular": {"specularColorFactor": [0.5, 1, 2], "specularFactor": 0.5},
         "KHR_materials_clearcoat": {"clearcoatFactor": 0.8, "clearcoatRoughnessFactor": 0.3},
         "KHR_materials_sheen": {"sheenColorFactor": [0, 0.5, 0.25], "sheenRoughnessFactor": 0.9}}})"},
    {"PBR: what transmits light is drawn by blending, but not BLEND",
     pbr([](auto& m) { m.metallic = 0.0f, m.transmission = 0.75f; }),
     R"({"extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.75}}})"},
    {"PBR: specular and glossiness", pbr(setSpecularGlossiness),
     R"({"pbrMetallicRoughness": null, "extensions": {"KHR_materials_pbrSpecularGlossiness": {
         "diffuseFactor": [0.1, 0.2, 0.3, 0.4], "specularFactor": [0.5, 0.25, 0.125], "glossinessFactor": 0.8}}})"},
};

TEST(ExportedLooksTest, statesBecomeMaterials)
{
    const Json plain = Json::parse(R"({"doubleSided": true, "pbrMetallicRoughness": {
        "baseColorFactor": [1, 1, 1, 1], "metallicFactor": 0, "roughnessFactor": 1}})");
    for (const LookCase& each : looks)
    {
        SCOPED_TRACE(each.name);
        Json expected = plain;
        expected.merge_patch(Json::parse(each.expected));
        expectNear(materialOf(each.setUp), expected);
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

TEST(ExportedLooksTest, picturesOfAllFormatsArePng)
{
    constexpr auto bottom = osg::Image::BOTTOM_LEFT, top = osg::Image::TOP_LEFT;
    const struct
    {
        GLenum format, type;
        osg::Image::Origin origin; ///< of the first row
        int colorType;             ///< of the PNG (PNG specification, table 11.1)
    } cases[] = {{GL_LUMINANCE, GL_UNSIGNED_BYTE, bottom, 0}, {GL_LUMINANCE_ALPHA, GL_UNSIGNED_SHORT, bottom, 4},
                 {GL_RGB, GL_UNSIGNED_BYTE, bottom, 2},       {GL_RGB, GL_UNSIGNED_SHORT, top, 2},
                 {GL_RGBA, GL_UNSIGNED_SHORT, bottom, 6},     {GL_BGRA, GL_UNSIGNED_BYTE, bottom, 6},
                 {GL_BGRA, GL_UNSIGNED_BYTE, top, 6},         {GL_RGB, GL_FLOAT, bottom, 6}};
    for (const auto& each : cases)
    {
        SCOPED_TRACE(testing::Message() << std::hex << each.format << ' ' << each.type);
        const osg::ref_ptr<osg::Image> image = new osg::Image;
        image->allocateImage(3, 2, 1, each.format, each.type, 4); // rows of nine bytes take twelve
        image->setOrigin(each.origin);
        for (unsigned int y = 0; y < 2; ++y)
            for (unsigned int x = 0; x < 3; ++x)
                image->setColor(osg::Vec4(0.13f + 0.2f * float(x), 0.4f * float(y), 0.57f, 0.8f), x, y);
        const std::string png = valueOf(encodePng(*image));
        const auto read = valueOf(decodePicture({png.begin(), png.end()}));
        EXPECT_EQ(png[25], each.colorType);
        EXPECT_EQ(read->getPixelFormat(), GLenum(each.colorType < 4 ? GL_RGB : GL_RGBA));
        EXPECT_EQ(read->getDataType() == GL_UNSIGNED_SHORT, each.type == GL_UNSIGNED_SHORT);
        for (unsigned int y = 0; y < 2; ++y) // the decoded one begins at the bottom
            for (unsigned int x = 0; x < 3; ++x)
                EXPECT_LT((read->getColor(x, each.origin == top ? 1 - y : y) - image->getColor(x, y)).length(), 0.01f)
                    << x << ' ' << y;
    }
    const osg::ref_ptr<osg::Image> compressed = new osg::Image;
    compressed->allocateImage(4, 4, 1, GL_COMPRESSED_RGBA_S3TC_DXT5_EXT, GL_UNSIGNED_BYTE);
    EXPECT_FALSE(encodePng(*compressed));
    EXPECT_FALSE(encodePng(*osg::ref_ptr<osg::Image>(new osg::Image)));
}

} // namespace

} // namespace osgGpuAnimation::gltf
