// SPDX-License-Identifier: MIT
#include "support/TestCharacter.h"

#include <osgGpuAnimation/looks/CharacterProgram.h>
#include <osgGpuAnimation/mesh/lod/SurfaceColor.h>

#include <osg/BlendFunc>
#include <osg/CullFace>
#include <osg/FrontFace>
#include <osg/ImageStream>
#include <osg/Material>
#include <osg/TexMat>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>

namespace osgGpuAnimation
{

namespace
{

using Bytes = std::initializer_list<unsigned char>;

const Bytes fourTexels{255, 0, 0, 0, 255, 0, 0, 0, 255, 51, 102, 204}; ///< from the lower left one, RGB

/// A picture of two by two texels.
osg::ref_ptr<osg::Texture2D> makeMap(GLenum format = GL_RGB, const Bytes& bytes = fourTexels)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(2, 2, 1, format, GL_UNSIGNED_BYTE);
    std::fill_n(image->data(), image->getTotalSizeInBytes(), static_cast<unsigned char>(255));
    std::copy_n(bytes.begin(), std::min<std::size_t>(bytes.size(), image->getTotalSizeInBytes()), image->data());
    osg::ref_ptr<osg::Texture2D> map = new osg::Texture2D(image);
    for (const auto wrap : {osg::Texture::WRAP_S, osg::Texture::WRAP_T})
        map->setWrap(wrap, osg::Texture::REPEAT);
    return map;
}

/// A lit square with a picture: vertex i shows texel i of the lower left, lower right, upper right and upper left ones.
osg::ref_ptr<SkinnedGeometry> makeSquare()
{
    osg::ref_ptr<SkinnedGeometry> square = makeTestSquare(1);
    square->setColorArray(nullptr);
    osg::ref_ptr<osg::Vec2Array> coordinates = new osg::Vec2Array;
    for (const osg::Vec2 corner :
         {osg::Vec2(0.25f, 0.25f), osg::Vec2(0.75f, 0.25f), osg::Vec2(0.75f, 0.75f), osg::Vec2(0.25f, 0.75f)})
        coordinates->push_back(corner);
    square->setTexCoordArray(0, coordinates);
    square->getOrCreateStateSet()->setTextureAttributeAndModes(0, makeMap());
    return square;
}

void setPicture(SkinnedGeometry& mesh, osg::Image* image)
{
    mesh.getStateSet()->setTextureAttributeAndModes(0, image ? new osg::Texture2D(image) : new osg::Texture2D);
}

osg::Image& pictureOf(SkinnedGeometry& mesh)
{
    auto* texture = mesh.getStateSet()->getTextureAttribute(0, osg::StateAttribute::TEXTURE);
    return *static_cast<osg::Texture2D&>(*texture).getImage();
}

void makePbr(SkinnedGeometry& mesh, PbrMaterial::Map PbrMaterial::*map, int coordinates = 0)
{
    PbrMaterial material;
    material.emissive.set(1, 1, 1);
    material.clearcoat = material.transmission = 0.5f;
    material.sheenColor.set(1, 1, 1);
    material.hasMoreCoordinates = coordinates > 0;
    if (map) (material.*map) = {makeMap(), coordinates};
    applyPbrMaterial(*mesh.getStateSet(), material);
    // What transmission adds: the map alone is tested.
    mesh.getStateSet()->removeAttribute(osg::StateAttribute::BLENDFUNC);
    mesh.getStateSet()->removeMode(GL_BLEND);
    mesh.getStateSet()->setRenderingHint(osg::StateSet::DEFAULT_BIN);
}

template <typename Array, typename Value>
osg::ref_ptr<Array> arrayOf(unsigned int count, const Value& value, osg::Array::Binding binding, bool isNormalized)
{
    osg::ref_ptr<Array> array = new Array(count);
    std::fill(array->begin(), array->end(), value);
    array->setBinding(binding);
    array->setNormalize(isNormalized);
    return array;
}

struct MaterialCase
{
    const char* name;
    bool isTaken;
    void (*change)(SkinnedGeometry&);
};

constexpr osg::Array::Binding perVertex = osg::Array::BIND_PER_VERTEX;

const MaterialCase materialCases[] = {
    {"a picture", true, [](SkinnedGeometry&) {}},
    {"white", true,
     [](SkinnedGeometry& mesh)
     {
         mesh.setTexCoordArray(0, nullptr);
         mesh.getStateSet()->removeTextureAttribute(0, osg::StateAttribute::TEXTURE);
         applyCharacterProgram(*mesh.getStateSet());
     }},
    {"grey", true,
     [](SkinnedGeometry& mesh) { mesh.getStateSet()->setTextureAttribute(0, makeMap(GL_LUMINANCE_ALPHA)); }},
    {"two-sided", true,
     [](SkinnedGeometry& mesh) { mesh.getStateSet()->setMode(GL_CULL_FACE, osg::StateAttribute::OFF); }},
    {"culled from behind", true,
     [](SkinnedGeometry& mesh) { mesh.getStateSet()->setAttributeAndModes(new osg::CullFace); }},
    {"colours", true,
     [](SkinnedGeometry& mesh)
     { mesh.setColorArray(arrayOf<osg::Vec4Array>(4, osg::Vec4(1, 0, 0, 1), perVertex, false)); }},
    {"colours in bytes", true,
     [](SkinnedGeometry& mesh)
     { mesh.setColorArray(arrayOf<osg::Vec4ubArray>(4, osg::Vec4ub(255, 0, 0, 255), perVertex, true)); }},
    {"one colour", true,
     [](SkinnedGeometry& mesh)
     { mesh.setColorArray(arrayOf<osg::Vec4Array>(1, osg::Vec4(1, 0, 0, 1), osg::Array::BIND_OVERALL, false)); }},
    {"base colour", true, [](SkinnedGeometry& mesh) { makePbr(mesh, &PbrMaterial::baseColorMap); }},
    {"metallic, roughness", true, [](SkinnedGeometry& mesh) { makePbr(mesh, &PbrMaterial::metallicRoughnessMap); }},
    {"occlusion", true, [](SkinnedGeometry& mesh) { makePbr(mesh, &PbrMaterial::occlusionMap, 1); }},
    {"normals", true, [](SkinnedGeometry& mesh) { makePbr(mesh, &PbrMaterial::normalMap, 1); }},

    {"no state", false, [](SkinnedGeometry& mesh) { mesh.setStateSet(nullptr); }},
    {"no program", false,
     [](SkinnedGeometry& mesh) { mesh.getStateSet()->removeAttribute(osg::StateAttribute::PROGRAM); }},
    {"a program of its own", false, [](SkinnedGeometry& mesh) { mesh.getStateSet()->setAttribute(new osg::Program); }},
    {"holes", false, [](SkinnedGeometry& mesh) { mesh.getStateSet()->getUniform("alphaCutoff")->set(0.5f); }},
    {"blending", false, [](SkinnedGeometry& mesh) { applyBlending(*mesh.getStateSet(), GL_SRC_ALPHA); }},
    {"blending in the order of the scene", false,
     [](SkinnedGeometry& mesh) { mesh.getStateSet()->setAttributeAndModes(new osg::BlendFunc); }},
    {"a bin of its own", false, [](SkinnedGeometry& mesh) { mesh.getStateSet()->setRenderBinDetails(3, "RenderBin"); }},
    {"culled from the front", false,
     [](SkinnedGeometry& mesh) { mesh.getStateSet()->setAttributeAndModes(new osg::CullFace(osg::CullFace::FRONT)); }},
    {"clockwise", false,
     [](SkinnedGeometry& mesh) { mesh.getStateSet()->setAttribute(new osg::FrontFace(osg::FrontFace::CLOCKWISE)); }},
    {"a texture matrix", false,
     [](SkinnedGeometry& mesh) { mesh.getStateSet()->setTextureAttribute(0, new osg::TexMat); }},
    {"an animated texture transform", false,
     [](SkinnedGeometry& mesh) { mesh.getStateSet()->setDefine("MATERIAL_TEXTURE_TRANSFORM"); }},
    {"no picture", false, [](SkinnedGeometry& mesh) { setPicture(mesh, nullptr); }},
    {"a picture that is gone", false, [](SkinnedGeometry& mesh) { setPicture(mesh, new osg::Image); }},
    {"a compressed picture", false,
     [](SkinnedGeometry& mesh) { pictureOf(mesh).setPixelFormat(GL_COMPRESSED_RGB_S3TC_DXT1_EXT); }},
    {"a picture of floats", false,
     [](SkinnedGeometry& mesh) { pictureOf(mesh).allocateImage(2, 2, 1, GL_RGB, GL_FLOAT); }},
    {"a picture that changes", false,
     [](SkinnedGeometry& mesh) { pictureOf(mesh).setDataVariance(osg::Object::DYNAMIC); }},
    {"a film", false,
     [](SkinnedGeometry& mesh)
     {
         osg::ref_ptr<osg::ImageStream> film = new osg::ImageStream;
         film->allocateImage(2, 2, 1, GL_RGB, GL_UNSIGNED_BYTE);
         setPicture(mesh, film);
     }},
    {"no coordinates", false, [](SkinnedGeometry& mesh) { mesh.setTexCoordArray(0, nullptr); }},
    {"too few coordinates", false, [](SkinnedGeometry& mesh) { mesh.setTexCoordArray(0, new osg::Vec2Array(3)); }},
    {"too few colours", false, [](SkinnedGeometry& mesh) { mesh.setColorArray(new osg::Vec4Array(perVertex, 3)); }},
    {"colours without alpha", false,
     [](SkinnedGeometry& mesh) { mesh.setColorArray(new osg::Vec3Array(perVertex, 4)); }},
    {"colours up to 255", false,
     [](SkinnedGeometry& mesh)
     { mesh.setColorArray(arrayOf<osg::Vec4ubArray>(4, osg::Vec4ub(255, 0, 0, 255), perVertex, false)); }},
    {"second coordinates", false, [](SkinnedGeometry& mesh) { makePbr(mesh, &PbrMaterial::metallicRoughnessMap, 1); }},
    {"a map of light", false, [](SkinnedGeometry& mesh) { makePbr(mesh, &PbrMaterial::emissiveMap); }},
    {"a map of specular colours", false, [](SkinnedGeometry& mesh) { makePbr(mesh, &PbrMaterial::specularColorMap); }},
    {"a map of clear coat", false, [](SkinnedGeometry& mesh) { makePbr(mesh, &PbrMaterial::clearcoatMap); }},
    {"a map of sheen", false, [](SkinnedGeometry& mesh) { makePbr(mesh, &PbrMaterial::sheenColorMap); }},
    {"a map of transmission", false, [](SkinnedGeometry& mesh) { makePbr(mesh, &PbrMaterial::transmissionMap); }},
};

TEST(SurfaceColorTest, takesMaterialsThatVertexColoursReplace)
{
    for (const MaterialCase& material : materialCases)
    {
        const osg::ref_ptr<SkinnedGeometry> square = makeSquare();
        material.change(*square);
        EXPECT_EQ(SurfaceColor::of(*square).has_value(), material.isTaken) << material.name;
    }
}

void expectColor(const osg::Vec4& found, const osg::Vec4& expected, const char* what)
{
    for (int channel = 0; channel < 4; ++channel)
        EXPECT_NEAR(found[channel], expected[channel], 1e-5f) << what << ", channel " << channel;
}

TEST(SurfaceColorTest, isTheTexelTimesTheColourOfTheVertices)
{
    const osg::ref_ptr<SkinnedGeometry> square = makeSquare();
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array(perVertex);
    for (const osg::Vec4 color : {osg::Vec4(1, 1, 1, 1), osg::Vec4(0.5f, 0.5f, 0.5f, 0.5f),
                                  osg::Vec4(0.5f, 0.25f, 1, 1), osg::Vec4(0, 0, 0.2f, 1)})
        colors->push_back(color);
    square->setColorArray(colors);
    const osg::Vec4 last(0.2f, 0.4f, 0.8f, 1); // of the picture
    const osg::Vec4 ofLast(0.5f, 0.25f, 1, 1);
    const glm::vec3 corner(1, 0, 0), middle(0.0f, 0.5f, 0.5f);

    const SurfaceColor display = *SurfaceColor::of(*square);
    expectColor(display.at({0, 1, 2}, corner).color, {1, 0, 0, 1}, "lower left");
    expectColor(display.at({1, 0, 0}, corner).color, {0, 0.5f, 0, 1}, "lower right: alpha does not count");
    expectColor(display.at({2, 0, 0}, corner).color, osg::componentMultiply(last, ofLast), "upper right");
    // The coordinates are (0.5, 0.25 to 0.75) there: the right half of the picture.
    expectColor(display.at({0, 2, 3}, middle).color, {0.2f * 0.25f, 0.4f * 0.125f, 0.8f * 0.6f, 1}, "means");
    expectColor(display.stored({0.1f, 0.2f, 0.3f, 1}), {0.1f, 0.2f, 0.3f, 1}, "display");
    EXPECT_EQ(display.at({0, 1, 2}, corner).metallicRoughness, osg::Vec2(1, 1));

    PbrMaterial material;
    material.baseColorMap.texture = makeMap();
    material.metallicRoughnessMap.texture = makeMap();
    applyPbrMaterial(*square->getStateSet(), material);
    const SurfaceColor linear = *SurfaceColor::of(*square);
    expectColor(linear.at({2, 0, 0}, corner).color, osg::componentMultiply(linearColor(last), linearColor(ofLast)),
                "linear light");
    expectColor(linear.stored(linearColor(last)), last, "stored for the display");
    const osg::Vec2 metallicRoughness = linear.at({2, 0, 0}, corner).metallicRoughness;
    EXPECT_NEAR(metallicRoughness.x(), 0.8f, 1e-5f) << "blue is metallic";
    EXPECT_NEAR(metallicRoughness.y(), 0.4f, 1e-5f) << "green is roughness";
}

TEST(SurfaceColorTest, picturesRepeat)
{
    const osg::ref_ptr<SkinnedGeometry> square = makeSquare();
    auto& coordinates = static_cast<osg::Vec2Array&>(*square->getTexCoordArray(0));
    const auto colorAt = [&](float x, float y)
    {
        coordinates[0].set(x, y);
        return SurfaceColor::of(*square)->at({0, 0, 0}, {1, 0, 0}).color;
    };
    expectColor(colorAt(-0.25f, 0.25f), {0, 1, 0, 1}, "left of it");
    expectColor(colorAt(3.75f, -1.25f), {0.2f, 0.4f, 0.8f, 1}, "right of it and below");
    expectColor(colorAt(1.0f, -1e-9f), {0, 0, 1, 1}, "its border");
    expectColor(colorAt(std::nanf(""), 1e30f), {1, 0, 0, 1}, "not a number: some texel");
}

TEST(SurfaceColorTest, theNewStateHasTheMaterialWithoutItsMaps)
{
    const osg::ref_ptr<SkinnedGeometry> square = makeSquare();
    PbrMaterial material;
    material.baseColor.set(0.5f, 0.25f, 1, 1);
    material.metallic = 0.5f;
    material.roughness = 0.8f;
    for (const auto map : {&PbrMaterial::baseColorMap, &PbrMaterial::metallicRoughnessMap, &PbrMaterial::occlusionMap,
                           &PbrMaterial::normalMap})
        (material.*map).texture = makeMap();
    square->getStateSet()->setMode(GL_CULL_FACE, osg::StateAttribute::OFF);
    applyPbrMaterial(*square->getStateSet(), material);
    const osg::ref_ptr<osg::StateSet> state = SurfaceColor::of(*square)->state(3, {0.5f, 0.25f});
    const std::optional<PbrMaterial> made = pbrMaterialOf(*state);
    ASSERT_TRUE(made);
    EXPECT_EQ(made->baseColor, material.baseColor);
    EXPECT_FLOAT_EQ(made->metallic, 0.25f);
    EXPECT_FLOAT_EQ(made->roughness, 0.2f);
    for (const auto map : {&PbrMaterial::metallicRoughnessMap, &PbrMaterial::occlusionMap, &PbrMaterial::normalMap})
        EXPECT_EQ((*made.*map).texture, nullptr);
    EXPECT_NE(state->getTextureAttribute(0, osg::StateAttribute::TEXTURE),
              square->getStateSet()->getTextureAttribute(0, osg::StateAttribute::TEXTURE));
    EXPECT_TRUE(state->getMode(GL_CULL_FACE) & osg::StateAttribute::ON) << "the merged surface has one side";
    EXPECT_EQ(state->getAttribute(osg::StateAttribute::PROGRAM),
              square->getStateSet()->getAttribute(osg::StateAttribute::PROGRAM));
    EXPECT_TRUE((pbrMaterialOf(*square->getStateSet())->normalMap.texture)) << "the mesh's own is as before";

    // What an application changes later shows at all levels.
    const osg::ref_ptr<SkinnedGeometry> plain = makeSquare();
    plain->getStateSet()->setAttribute(new osg::Material);
    const osg::ref_ptr<osg::StateSet> ofPlain = SurfaceColor::of(*plain)->state(1, {1, 1});
    EXPECT_EQ(ofPlain->getAttribute(osg::StateAttribute::MATERIAL),
              plain->getStateSet()->getAttribute(osg::StateAttribute::MATERIAL));
    EXPECT_EQ(ofPlain->getUniform("unlit"), plain->getStateSet()->getUniform("unlit"));
}

} // namespace

} // namespace osgGpuAnimation
