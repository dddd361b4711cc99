// SPDX-License-Identifier: MIT
#include "looks/PbrPanelGLTest.h"

#include <osgGpuAnimation/looks/Environment.h>

#include <algorithm>
#include <cmath>

// Layers and maps of PbrMaterial's surfaces.

namespace osgGpuAnimation
{

namespace
{

using PbrMaterialGLTest = PbrPanelGLTest;

constexpr double pi = 3.14159265358979;

/// In eye space, of a direction in the world.
osg::Vec3d inEyeSpace(const osg::Vec3& direction)
{
    osg::Vec3d found(direction.x(), direction.z(), -direction.y());
    found.normalize();
    return found;
}

osg::Vec3d normalized(osg::Vec3d vector)
{
    vector.normalize();
    return vector;
}

/// Appendix B of glTF 2.0 in double precision: one channel, a light of irradiance 0.7 * pi along the normal's side.
double specified(double base, double metallic, double roughness, const osg::Vec3d& toEye, const osg::Vec3d& toLight)
{
    const osg::Vec3d halfway = normalized(toEye + toLight);
    const double alpha = roughness * roughness, squared = alpha * alpha;
    const double cosHalf = halfway.z(), cosLight = toLight.z(), cosEye = toEye.z();
    const double spread = cosHalf * cosHalf * (squared - 1) + 1;
    const double distribution = squared / (pi * spread * spread);
    const double visibility = 0.5 / (cosLight * std::sqrt(cosEye * cosEye * (1 - squared) + squared) +
                                     cosEye * std::sqrt(cosLight * cosLight * (1 - squared) + squared));
    const double fresnel = std::pow(1 - toEye * halfway, 5);
    const double reflected = 0.04 + 0.96 * fresnel;
    const double layers = (1 - metallic) * ((1 - reflected) * base / pi + reflected * distribution * visibility) +
                          metallic * (base + (1 - base) * fresnel) * distribution * visibility;
    return 0.7 * pi * cosLight * layers;
}

} // namespace

TEST_F(PbrMaterialGLTest, aLightIsReflectedAsSpecified)
{
    setSurrounding(0);
    const struct
    {
        double base, metallic, roughness;
        osg::Vec3 toLight; // in the world
    } cases[] = {{0.5, 0.0, 1.0, {0, -1, 0}},    {0.5, 0.0, 0.3, {0.1f, -1, 0.1f}}, {0.2, 1.0, 0.4, {0, -1, 0}},
                 {0.8, 0.5, 0.5, {0.5f, -1, 1}}, {0.8, 0.0, 0.5, {-2, -1, 0}},      {0.0, 0.0, 0.4, {0, -1, 0.1f}},
                 {0.5, 0.0, 0.5, {0, 1, 0}} /* from behind */};
    for (const bool isMoving : {true, false})
        for (const auto& one : cases)
        {
            PbrMaterial material = dielectric(static_cast<float>(one.base));
            material.metallic = static_cast<float>(one.metallic);
            material.roughness = static_cast<float>(one.roughness);
            setDirection(one.toLight);
            const osg::Vec4 found = colorOf(pbrPanel(isMoving, material));
            const osg::Vec3d toEye = normalized(-position), toLight = inEyeSpace(one.toLight);
            const double expected =
                toLight.z() > 0 ? specified(one.base, one.metallic, one.roughness, toEye, toLight) : 0.0;
            // Two steps of 255; several bounces in the metal, which the specification leaves out, bring two more.
            EXPECT_NEAR(found.r(), encoded(expected), 4.0 / 255)
                << one.base << ' ' << one.metallic << ' ' << one.roughness;
        }
}

TEST_F(PbrMaterialGLTest, aWhiteSurfaceInAWhiteSurroundingIsWhite)
{
    setLight(0);
    setSurrounding(1);
    for (const float metallic : {0.0f, 0.5f, 1.0f})
        for (const float roughness : {0.0f, 0.5f, 1.0f})
        {
            PbrMaterial material;
            material.metallic = metallic;
            material.roughness = roughness;
            EXPECT_GE(colorOf(material).g(), 253.0f / 255) << metallic << ' ' << roughness;
        }
}

/// A map of that value in its right half, and of another one in its left half.
PbrMaterial::Map mapOf(float red, float green, float blue, float alpha = 1)
{
    const auto other = [](float value) { return value < 0.45f ? value + 0.5f : value - 0.45f; };
    const osg::Vec4 values[] = {{other(red), other(green), other(blue), other(alpha)}, {red, green, blue, alpha}};
    return {texels(2, 1, [&](int column, int) { return values[column]; }), 0};
}

PbrMaterial::Map colorMapOf(float red, float green, float blue, float alpha = 1)
{
    const PbrMaterial::Map map = mapOf(red, green, blue, alpha);
    map.texture->setInternalFormat(GL_SRGB8_ALPHA8);
    return map;
}

constexpr PbrMaterial::Map PbrMaterial::*mapsWithNumbers[] = {
    &PbrMaterial::metallicRoughnessMap, &PbrMaterial::normalMap,
    &PbrMaterial::occlusionMap,         &PbrMaterial::emissiveMap,
    &PbrMaterial::specularColorMap,     &PbrMaterial::specularMap,
    &PbrMaterial::clearcoatMap,         &PbrMaterial::clearcoatRoughnessMap,
    &PbrMaterial::clearcoatNormalMap,   &PbrMaterial::sheenColorMap,
    &PbrMaterial::sheenRoughnessMap,    &PbrMaterial::transmissionMap};

/// A panel whose maps have those coordinates, which alone lead to the right half.
osg::ref_ptr<osg::Node> panelWith(bool isMoving, PbrMaterial material, int coordinates)
{
    for (const auto map : mapsWithNumbers)
        (material.*map).coordinates = coordinates;
    material.hasMoreCoordinates = coordinates > 0;
    osg::ref_ptr<osg::Node> panel = pbrPanel(isMoving, material, {1, 1, 1}, {1, 0, 0, 1});
    const auto place = [&](int number) { return number == coordinates ? 0.75f : 0.25f; };
    setCoordinates(*findGeometry(*panel), {material.baseColorMap.texture ? 0.75f : place(0), 0.5f},
                   {place(1), 0.5f, place(2), 0.5f});
    return panel;
}

osg::Vec3 linear(float red, float green, float blue)
{
    const osg::Vec4 color = linearColor({red, green, blue, 1});
    return {color.r(), color.g(), color.b()};
}

// Every map, of one colour, does what the factor of that value does; moving and still surfaces look the same.
TEST_F(PbrMaterialGLTest, mapsMultiplyTheirFactors)
{
    const struct
    {
        const char* name;
        void (*withMap)(PbrMaterial& m);
        void (*withFactor)(PbrMaterial& m);
        bool hasEffect = true;
    } cases[] = {
        {"base colour", [](PbrMaterial& m) { m.baseColorMap = colorMapOf(0.5f, 0.25f, 1); },
         [](PbrMaterial& m) {
             m.baseColor = componentMultiply(m.baseColor, linearColor({0.5f, 0.25f, 1, 1}));
         }},
        {"metal and roughness", [](PbrMaterial& m) { m.metallicRoughnessMap = mapOf(1, 0.4f, 0.6f); },
         [](PbrMaterial& m) { m.metallic *= 0.6f, m.roughness *= 0.4f; }},
        {"emission", [](PbrMaterial& m) { m.emissive.set(1, 1, 1), m.emissiveMap = colorMapOf(0.6f, 0.2f, 0); },
         [](PbrMaterial& m) { m.emissive = linear(0.6f, 0.2f, 0); }},
        {"a level normal map", [](PbrMaterial& m) { m.normalMap = mapOf(0.5f, 0.5f, 1); }, [](PbrMaterial&) {}, false},
        {"a normal map of half scale",
         [](PbrMaterial& m) { m.normalMap = mapOf(0.9f, 0.5f, 0.8f), m.normalScale = 0.5f; },
         [](PbrMaterial& m) { m.normalMap = mapOf(0.7f, 0.5f, 0.8f); }},
        {"occlusion of half strength",
         [](PbrMaterial& m) { m.occlusionMap = mapOf(0, 0, 0), m.occlusionStrength = 0.5f; },
         [](PbrMaterial& m) { m.occlusionMap = mapOf(0.5f, 0, 0); }},
        {"no occlusion", [](PbrMaterial& m) { m.occlusionMap = mapOf(1, 0, 0); }, [](PbrMaterial&) {}, false},
        {"clear coat",
         [](PbrMaterial& m)
         {
             m.clearcoat = m.clearcoatRoughness = 1.0f;
             m.clearcoatMap = mapOf(0.5f, 0, 0), m.clearcoatRoughnessMap = mapOf(0, 0.4f, 0);
         },
         [](PbrMaterial& m) { m.clearcoat = 0.5f, m.clearcoatRoughness = 0.4f; }},
        {"a coat's normal map of half scale",
         [](PbrMaterial& m)
         {
             m.clearcoat = 1.0f, m.clearcoatRoughness = m.clearcoatNormalScale = 0.5f;
             m.clearcoatNormalMap = mapOf(0.9f, 0.5f, 0.8f);
         },
         [](PbrMaterial& m)
         {
             m.clearcoat = 1.0f, m.clearcoatRoughness = 0.5f;
             m.clearcoatNormalMap = mapOf(0.7f, 0.5f, 0.8f);
         }},
        {"sheen",
         [](PbrMaterial& m)
         {
             m.sheenColor.set(1, 1, 1), m.sheenColorMap = colorMapOf(0.5f, 0.5f, 0.5f);
             m.sheenRoughness = 1.0f, m.sheenRoughnessMap = mapOf(0, 0, 0, 0.6f);
         },
         [](PbrMaterial& m) { m.sheenColor = linear(0.5f, 0.5f, 0.5f), m.sheenRoughness = 0.6f; }},
        {"specular", [](PbrMaterial& m) { m.specularMap = mapOf(0, 0, 0, 0.2f); },
         [](PbrMaterial& m) { m.specular = 0.2f; }},
        {"specular colour",
         [](PbrMaterial& m) { m.specularColor.set(0.8f, 0.6f, 0.4f), m.specularColorMap = colorMapOf(0.7f, 0.5f, 1); },
         [](PbrMaterial& m) {
             m.specularColor = componentMultiply(linear(0.7f, 0.5f, 1), {0.8f, 0.6f, 0.4f});
         }},
        {"glossiness",
         [](PbrMaterial& m)
         {
             m.isSpecularGlossiness = true, m.specularColor.set(0.5f, 0.5f, 0.5f);
             m.specularColorMap = colorMapOf(1, 1, 1, 0.2f);
         },
         [](PbrMaterial& m) { m.specularColor.set(0.5f, 0.5f, 0.5f), m.roughness = 1 - 0.2f * (1 - m.roughness); }},
        {"transmission", [](PbrMaterial& m) { m.transmission = 0.8f, m.transmissionMap = mapOf(0.5f, 1, 1); },
         [](PbrMaterial& m) { m.transmission = 0.4f; }},
        {"a metal lets no light through", [](PbrMaterial& m) { m.metallic = 1, m.transmission = 0.8f; },
         [](PbrMaterial& m) { m.metallic = 1; }},
        {"what a map of metal lets through",
         [](PbrMaterial& m) { m.metallic = 1, m.transmission = 0.8f, m.metallicRoughnessMap = mapOf(1, 1, 0); },
         [](PbrMaterial& m) { m.metallic = 0, m.transmission = 0.8f; }},
        {"an opaque material with an alpha", [](PbrMaterial& m) { m.baseColor.a() = 0.3f, m.transmission = 0.8f; },
         [](PbrMaterial& m) { m.transmission = 0.8f; }},
    };
    setSurrounding(0.5f);
    for (const auto& one : cases)
    {
        PbrMaterial base;
        base.baseColor.set(0.2f, 0.15f, 0.1f, 1);
        base.metallic = 0.2f;
        base.roughness = 0.6f;
        PbrMaterial withMap = base, withFactor = base;
        one.withMap(withMap);
        one.withFactor(withFactor);
        const osg::ref_ptr<osg::Image> expected = pictureOf(panelWith(true, withFactor, 0));
        for (const auto& [isMoving, number] : {std::pair(true, 0), {true, 1}, {true, 2}, {false, 2}})
            // A map's numbers have 8 bits.
            EXPECT_EQ(Picture::pixelsDifferent(*expected, *pictureOf(panelWith(isMoving, withMap, number)), 2.5f / 255),
                      0)
                << one.name << (isMoving ? ", moving" : ", still") << ", coordinates " << number;
        const int changed = Picture::pixelsDifferent(*expected, *pictureOf(panelWith(true, base, 0)), 2.5f / 255);
        EXPECT_EQ(changed > 20, one.hasEffect) << one.name;
    }
}

// KHR_materials_clearcoat: seen along its normal, the coat lets 96 % of the light below pass.
TEST_F(PbrMaterialGLTest, whatLiesBelowTheClearCoatIsDarker)
{
    setSurrounding(0);
    setDirection({2, -1, 0}); // far from the coat's sharp highlight
    PbrMaterial lit = dielectric(), glowing = dielectric(0);
    glowing.emissive.set(0.5f, 0.5f, 0.5f);
    for (PbrMaterial* material : {&lit, &glowing})
    {
        const float without = linearColor(colorOf(*material)).g();
        material->clearcoat = 1.0f;
        const float found = colorOf(*material).g();
        EXPECT_NEAR(found, encoded(0.96 * without), 1.5 / 255);
        EXPECT_LT(found, encoded(without) - 1.5f / 255);
    }
}

// A coat over a surface that reflects nothing is a black dielectric with the coat's roughness, normal and tangents;
// light is added up, so half a coat has half its light.
TEST_F(PbrMaterialGLTest, aCoatOverNothingIsASurface)
{
    const osg::ref_ptr<osg::Texture2D> leaning = plainTexture({0.75f, 0.5f, 0.933f, 1});
    const osg::Vec4 tangents[] = {{}, {1, 0, 0, 1}, {-1, 0, 0, 1}};
    const osg::Vec3 fromSurrounding, directions[] = {{0.5f, -1, 0.2f}, {2, -1, 0}, {-1, -1, -1}, fromSurrounding};
    for (const osg::Vec3& toLight : directions)
        for (const bool isLeaning : {false, true})
            for (const osg::Vec4& tangent : tangents)
            {
                setDirection(toLight);
                setLight(toLight == fromSurrounding ? 0 : 6);
                setSurrounding(toLight == fromSurrounding ? 1 : 0);
                PbrMaterial coated = dielectric(0), plain = dielectric(0);
                coated.specular = 0.0f;
                coated.clearcoat = 0.5f;
                coated.clearcoatRoughness = plain.roughness = 0.6f;
                if (isLeaning) coated.clearcoatNormalMap.texture = plain.normalMap.texture = leaning;
                coated.clearcoatNormalScale = plain.normalScale = 0.5f;
                const osg::Vec4 whole = linearColor(colorOf(pbrPanel(true, plain, {1, 1, 1}, tangent)));
                EXPECT_NEAR(colorOf(pbrPanel(true, coated, {1, 1, 1}, tangent)).g(), encoded(0.5 * whole.g()),
                            1.5f / 255)
                    << toLight.x() << ", tangent " << tangent.x();
            }
}

// KHR_materials_sheen over a surface that reflects nothing, in double precision: Charlie's distribution and Neubelt's
// visibility; its alpha is the square of the roughness.
TEST_F(PbrMaterialGLTest, sheenIsReflectedAsSpecified)
{
    setSurrounding(0);
    setLight(2);
    for (const double roughness : {0.4, 0.6, 1.0})
        for (const osg::Vec3& direction : {osg::Vec3(1, -1, 0), osg::Vec3(2, -1, 0.5f)})
        {
            PbrMaterial material = dielectric(0);
            material.specular = 0.0f;
            material.sheenColor.set(0.8f, 0.8f, 0.8f);
            material.sheenRoughness = static_cast<float>(roughness);
            setDirection(direction);
            const float found = colorOf(material).g();
            const osg::Vec3d toEye = normalized(-position), toLight = inEyeSpace(direction);
            const osg::Vec3d halfway = normalized(toEye + toLight);
            const double inverse = 1.0 / (roughness * roughness), cosLight = toLight.z(), cosEye = toEye.z();
            const double distribution =
                (2.0 + inverse) * std::pow(1.0 - halfway.z() * halfway.z(), 0.5 * inverse) / (2.0 * pi);
            const double visibility = 0.25 / (cosLight + cosEye - cosLight * cosEye);
            EXPECT_NEAR(found, encoded(2.0 * pi * cosLight * 0.8 * distribution * visibility), 2.0 / 255) << roughness;
        }
}

// White fibres of roughness 1 reflect 14 % of the light along the normal (the integral of their distribution), which
// what lies below lacks. Red fibres take as much of the green light and reflect none of it.
TEST_F(PbrMaterialGLTest, whatLiesBelowTheSheenIsDarker)
{
    for (const bool isLight : {true, false})
    {
        setLight(isLight ? 0.5f : 0);
        setSurrounding(isLight ? 0 : 0.5f);
        PbrMaterial material = dielectric();
        const float without = linearColor(colorOf(material)).g();
        material.sheenColor.set(1, 0, 0);
        material.sheenRoughness = 1.0f;
        // The shader's fit is up to 0.03 beside the integral.
        EXPECT_NEAR(linearColor(colorOf(material)).g() / without, 0.86f, 0.04f);
    }
}

// Towards the studio's key light, over a surface that reflects nothing: the roughness below does not count.
TEST_F(PbrMaterialGLTest, coatAndSheenHaveTheirOwnRoughness)
{
    setLight(0);
    setSurrounding(0);
    const auto inStudio = [&](const PbrMaterial& material) {
        return colorOf(frontOfPanel(material, {0.389f, -1.583f, 0.713f}), new Environment).g();
    };
    PbrMaterial plain = dielectric(0), coated = dielectric(0), fibres = dielectric(0);
    plain.roughness = coated.clearcoatRoughness = fibres.roughness = 0.2f;
    coated.specular = fibres.specular = 0.0f;
    coated.clearcoat = 1.0f;
    EXPECT_GT(inStudio(plain), 0.3f);
    EXPECT_NEAR(inStudio(coated), inStudio(plain), 3.0f / 255);
    fibres.sheenColor.set(1, 1, 1);
    fibres.sheenRoughness = 1.0f;
    const float smooth = inStudio(fibres);
    fibres.roughness = 1.0f;
    EXPECT_GT(smooth, 0.1f);
    EXPECT_NEAR(inStudio(fibres), smooth, 1.0f / 255);
}

TEST_F(PbrMaterialGLTest, occlusionDarkensSurroundingsAlone)
{
    PbrMaterial open = dielectric(), occluded = dielectric();
    occluded.occlusionMap.texture = plainTexture({0, 1, 1, 1});
    const osg::ref_ptr<osg::Image> found = pictureOf(pbrPanel(true, occluded));
    EXPECT_GT(Picture::pixelsDifferent(*pictureOf(pbrPanel(true, open)), *found), 100);
    setSurrounding(0);
    EXPECT_EQ(Picture::pixelsDifferent(*pictureOf(pbrPanel(true, open)), *found), 0);
    // Also those that the clear coat reflects.
    setLight(0);
    occluded.baseColor.set(0, 0, 0, 1);
    occluded.clearcoat = 1.0f;
    EXPECT_LT(colorOf(pbrPanel(true, occluded), new Environment).g(), 2.0f / 255);
    occluded.occlusionMap.texture = nullptr;
    EXPECT_GT(colorOf(pbrPanel(true, occluded), new Environment).g(), 0.1f);
}

// KHR_materials_specular: without the reflection's weight, a black dielectric is black at all angles.
TEST_F(PbrMaterialGLTest, aSpecularWeightOfZeroReflectsNothing)
{
    setSurrounding(1);
    PbrMaterial black = dielectric(0);
    black.roughness = 0.3f;
    const osg::Vec3 grazing(0, -0.27f, 0.96f);
    EXPECT_GT(colorOf(frontOfPanel(black, grazing)).g(), 0.3f);
    black.specular = 0.0f;
    EXPECT_NEAR(colorOf(frontOfPanel(black, grazing)).g(), 0.0f, 1.0f / 255);
}

// Light that passes through is not scattered: half of it is missing. The share of the cover is 1 - 0.96 * 0.5.
TEST_F(PbrMaterialGLTest, transmittedLightIsNotScattered)
{
    PbrMaterial material = dielectric();
    material.specular = 0.0f;
    const float scattered = linearColor(colorOf(frontOfPanel(material))).g();
    EXPECT_GT(scattered, 0.2f);
    material.transmission = 0.5f;
    const float found = colorOf(frontOfPanel(material)).g();
    EXPECT_NEAR(found, 0.52f * encoded(0.5 * static_cast<double>(scattered) / 0.52), 2.0f / 255);
    material.isBlended = true;
    material.baseColor.a() = 0.3f;
    EXPECT_LT(colorOf(frontOfPanel(material)).g(), found - 0.05f);
    material.emissive.set(1, 1, 1);
    material.isBlended = false;
    EXPECT_GT(colorOf(frontOfPanel(material)).g(), 0.98f) << "highlights cover the background";
}

TEST_F(PbrMaterialGLTest, colorsAreMixedInLinearLight)
{
    setLight(0);
    setSurrounding(1);
    PbrMaterial material;
    material.baseColor.set(0.5f, 0.25f, 0.0f, 1);
    material.emissive.set(0.1f, 0, 0);
    material.emissiveStrength = 2.0f;
    material.metallic = 1.0f; // an even surrounding times the base colour, but for several bounces
    material.roughness = 0.0f;
    const osg::Vec4 found = colorOf(material);
    EXPECT_NEAR(found.r(), encoded(0.5 + 0.2), 2.0 / 255);
    EXPECT_NEAR(found.g(), encoded(0.25), 2.0 / 255);
}

} // namespace osgGpuAnimation
