// SPDX-License-Identifier: MIT
#include "nodes/PbrPanelGLTest.h"

#include <osgGpuAnimation/looks/Environment.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace osgGpuAnimation
{

namespace
{

using PbrMaterialGLTest = PbrPanelGLTest;

constexpr double pi = 3.14159265358979;

/// Appendix B of glTF 2.0 in double precision: one channel, a light of irradiance 0.7 * pi along the normal's side.
double specified(double base, double metallic, double roughness, const osg::Vec3d& toEye, const osg::Vec3d& toLight)
{
    const osg::Vec3d normal(0, 0, 1);
    osg::Vec3d halfway = toEye + toLight;
    halfway.normalize();
    const double alpha = roughness * roughness, squared = alpha * alpha;
    const double cosHalf = normal * halfway, cosLight = normal * toLight, cosEye = normal * toEye;
    const double spread = cosHalf * cosHalf * (squared - 1) + 1;
    const double distribution = squared / (pi * spread * spread);
    const double visibility = 0.5 / (cosLight * std::sqrt(cosEye * cosEye * (1 - squared) + squared) +
                                     cosEye * std::sqrt(cosLight * cosLight * (1 - squared) + squared));
    const double fresnel = std::pow(1 - toEye * halfway, 5);
    const double dielectric = 0.04 + 0.96 * fresnel;
    const double layers = (1 - metallic) * ((1 - dielectric) * base / pi + dielectric * distribution * visibility) +
                          metallic * (base + (1 - base) * fresnel) * distribution * visibility;
    return 0.7 * pi * cosLight * layers;
}

} // namespace

TEST_F(PbrMaterialGLTest, aLightIsReflectedAsSpecified)
{
    surrounding->setAmbientIntensity(osg::Vec4(0, 0, 0, 1));
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
            PbrMaterial material;
            const auto base = static_cast<float>(one.base);
            material.baseColor.set(base, base, base, 1);
            material.metallic = static_cast<float>(one.metallic);
            material.roughness = static_cast<float>(one.roughness);
            light->setPosition(osg::Vec4(one.toLight, 0));
            const osg::Vec4 found = middle(*pictureOf(pbrPanel(isMoving, material)));
            osg::Vec3d toEye = -position, toLight(one.toLight.x(), one.toLight.z(), -one.toLight.y());
            toEye.normalize();
            toLight.normalize();
            const double expected =
                toLight.z() > 0 ? specified(one.base, one.metallic, one.roughness, toEye, toLight) : 0.0;
            // Two steps of 255; several bounces in the metal, which the specification leaves out, bring two more.
            EXPECT_NEAR(found.r(), encoded(expected), 4.0 / 255)
                << one.base << ' ' << one.metallic << ' ' << one.roughness;
        }
}

TEST_F(PbrMaterialGLTest, aWhiteSurfaceInAWhiteSurroundingIsWhite)
{
    light->setDiffuse(osg::Vec4(0, 0, 0, 1));
    surrounding->setAmbientIntensity(osg::Vec4(1, 1, 1, 1));
    for (const float metallic : {0.0f, 0.5f, 1.0f})
        for (const float roughness : {0.0f, 0.5f, 1.0f})
        {
            PbrMaterial material;
            material.metallic = metallic;
            material.roughness = roughness;
            EXPECT_GE(middle(*pictureOf(pbrPanel(true, material))).g(), 253.0f / 255) << metallic << ' ' << roughness;
        }
}

// Every map, of one colour, does what the factor of that value does; moving and still surfaces look the same.
TEST_F(PbrMaterialGLTest, mapsMultiplyTheirFactors)
{
    const struct
    {
        const char* name;
        void (*withMap)(PbrMaterial& material);
        void (*withFactor)(PbrMaterial& material);
        bool hasEffect = true;
    } cases[] = {
        {"base colour",
         [](PbrMaterial& m) {
             m.baseColorMap.texture = plainTexture({0.5f, 0.25f, 1, 1}, true);
         },
         [](PbrMaterial& m) {
             m.baseColor = componentMultiply(m.baseColor, linearColor({0.5f, 0.25f, 1, 1}));
         }},
        {"metal and roughness",
         [](PbrMaterial& m) {
             m.metallicRoughnessMap.texture = plainTexture({1, 0.4f, 0.6f, 1});
         },
         [](PbrMaterial& m) { m.metallic *= 0.6f, m.roughness *= 0.4f; }},
        {"emission",
         [](PbrMaterial& m) {
             m.emissive.set(1, 1, 1), m.emissiveMap.texture = plainTexture({0.6f, 0.2f, 0, 1}, true);
         },
         [](PbrMaterial& m)
         {
             const osg::Vec4 color = linearColor({0.6f, 0.2f, 0, 1});
             m.emissive.set(color.r(), color.g(), color.b());
         }},
        {"a level normal map",
         [](PbrMaterial& m) {
             m.normalMap.texture = plainTexture({0.5f, 0.5f, 1, 1});
         },
         [](PbrMaterial&) {}, false},
        {"occlusion of half strength",
         [](PbrMaterial& m) {
             m.occlusionMap.texture = plainTexture({0, 0, 0, 1}), m.occlusionStrength = 0.5f;
         },
         [](PbrMaterial& m) {
             m.occlusionMap.texture = plainTexture({0.5f, 0, 0, 1});
         }},
        {"a normal map of half scale",
         [](PbrMaterial& m) {
             m.normalMap.texture = plainTexture({0.9f, 0.5f, 0.8f, 1}), m.normalScale = 0.5f;
         },
         [](PbrMaterial& m) {
             m.normalMap.texture = plainTexture({0.7f, 0.5f, 0.8f, 1});
         }},
        {"no occlusion",
         [](PbrMaterial& m) {
             m.occlusionMap.texture = plainTexture({1, 0, 0, 1});
         },
         [](PbrMaterial&) {}, false},
        {"clear coat",
         [](PbrMaterial& m)
         {
             m.clearcoat = 1.0f, m.clearcoatRoughness = 1.0f;
             m.clearcoatMap.texture = plainTexture({0.5f, 0, 0, 1});
             m.clearcoatRoughnessMap.texture = plainTexture({0, 0.4f, 0, 1});
         },
         [](PbrMaterial& m) { m.clearcoat = 0.5f, m.clearcoatRoughness = 0.4f; }},
        {"sheen",
         [](PbrMaterial& m)
         {
             m.sheenColor.set(1, 1, 1), m.sheenRoughness = 1.0f;
             m.sheenColorMap.texture = plainTexture({0.5f, 0.5f, 0.5f, 1}, true);
             m.sheenRoughnessMap.texture = plainTexture({0, 0, 0, 0.6f});
         },
         [](PbrMaterial& m)
         {
             const float color = linearColor({0.5f, 0, 0, 1}).r();
             m.sheenColor.set(color, color, color), m.sheenRoughness = 0.6f;
         }},
        {"specular",
         [](PbrMaterial& m) {
             m.specularMap.texture = plainTexture({0, 0, 0, 0.2f});
         },
         [](PbrMaterial& m) { m.specular = 0.2f; }},
        {"specular colour",
         [](PbrMaterial& m)
         {
             m.specularColor.set(0.8f, 0.6f, 0.4f);
             m.specularColorMap.texture = plainTexture({0.7f, 0.5f, 1, 1}, true);
         },
         [](PbrMaterial& m)
         {
             const osg::Vec4 color = linearColor({0.7f, 0.5f, 1, 1});
             m.specularColor.set(0.8f * color.r(), 0.6f * color.g(), 0.4f);
         }},
        {"transmission",
         [](PbrMaterial& m) {
             m.transmission = 0.8f, m.transmissionMap.texture = plainTexture({0.5f, 1, 1, 1});
         },
         [](PbrMaterial& m) { m.transmission = 0.4f; }},
        {"glossiness",
         [](PbrMaterial& m)
         {
             m.specularColor.set(0.5f, 0.5f, 0.5f), m.isSpecularGlossiness = true;
             m.specularColorMap.texture = plainTexture({1, 1, 1, 0.2f}, true);
         },
         [](PbrMaterial& m)
         {
             m.specularColor.set(0.5f, 0.5f, 0.5f);
             m.roughness = 1.0f - 0.2f * (1.0f - m.roughness);
         }},
    };
    for (const bool isMoving : {true, false})
        for (const auto& one : cases)
        {
            PbrMaterial base;
            base.baseColor.set(0.2f, 0.15f, 0.1f, 1);
            base.metallic = 0.2f;
            base.roughness = 0.6f;
            surrounding->setAmbientIntensity(osg::Vec4(0.5f, 0.5f, 0.5f, 1));
            PbrMaterial withMap = base, withFactor = base;
            one.withMap(withMap);
            one.withFactor(withFactor);
            const osg::ref_ptr<osg::Image> expected = pictureOf(pbrPanel(true, withFactor));
            // A map's numbers have 8 bits.
            EXPECT_EQ(Picture::pixelsDifferent(*expected, *pictureOf(pbrPanel(isMoving, withMap)), 2.5f / 255), 0)
                << one.name << (isMoving ? ", moving" : ", still");
            const int changed = Picture::pixelsDifferent(*expected, *pictureOf(pbrPanel(true, base)), 2.5f / 255);
            EXPECT_EQ(changed > 20, one.hasEffect) << one.name;
        }
}

// The map leans the normal to the right (+X): a light from there is reflected more. Tangents say where the right is.
TEST_F(PbrMaterialGLTest, normalMapsLeanTheNormal)
{
    surrounding->setAmbientIntensity(osg::Vec4(0, 0, 0, 1));
    light->setPosition(osg::Vec4(1, -1, 0, 0));
    PbrMaterial flat;
    flat.metallic = 0.0f;
    PbrMaterial leaning = flat;
    leaning.normalMap.texture = plainTexture({0.75f, 0.5f, 0.933f, 1}); // 30 degrees
    PbrMaterial up = flat;
    up.normalMap.texture = plainTexture({0.5f, 0.75f, 0.933f, 1});
    const osg::Vec3 plain(1, 1, 1);
    for (const bool isMoving : {true, false})
    {
        const float without = middle(*pictureOf(pbrPanel(isMoving, flat))).r();
        const float derived = middle(*pictureOf(pbrPanel(isMoving, leaning))).r();
        const float right = middle(*pictureOf(pbrPanel(isMoving, leaning, plain, {1, 0, 0, 1}))).r();
        const float left = middle(*pictureOf(pbrPanel(isMoving, leaning, plain, {-1, 0, 0, 1}))).r();
        EXPECT_GT(derived, without + 0.05f);
        EXPECT_NEAR(right, derived, 2.0f / 255);
        EXPECT_LT(left, without - 0.05f);
        // A length of 0 says nothing: the mesh's own normal remains.
        EXPECT_NEAR(middle(*pictureOf(pbrPanel(isMoving, leaning, plain, {0, 0, 0, 1}))).r(), without, 2.0f / 255);
        // Mirrored at the plane x = 0, the map's right is on the left.
        EXPECT_NEAR(middle(*pictureOf(pbrPanel(isMoving, leaning, {-1, 1, 1}, {1, 0, 0, 1}))).r(), left, 2.0f / 255);
        EXPECT_NEAR(middle(*pictureOf(pbrPanel(isMoving, leaning, {-1, 1, 1}))).r(), left, 2.0f / 255);
        // The bitangent's side, which a mirror keeps.
        light->setPosition(osg::Vec4(0, -1, 1, 0));
        const float upwards = middle(*pictureOf(pbrPanel(isMoving, up, plain, {1, 0, 0, 1}))).r();
        EXPECT_NEAR(middle(*pictureOf(pbrPanel(isMoving, up))).r(), upwards, 2.0f / 255);
        EXPECT_NEAR(middle(*pictureOf(pbrPanel(isMoving, up, {-1, 1, 1}, {1, 0, 0, 1}))).r(), upwards, 2.0f / 255);
        EXPECT_LT(middle(*pictureOf(pbrPanel(isMoving, up, plain, {1, 0, 0, -1}))).r(), upwards - 0.1f);
        light->setPosition(osg::Vec4(1, -1, 0, 0));
    }
}

// KHR_materials_clearcoat: seen along its normal, the coat lets 96 % of the light below pass.
TEST_F(PbrMaterialGLTest, whatLiesBelowTheClearCoatIsDarker)
{
    surrounding->setAmbientIntensity(osg::Vec4(0, 0, 0, 1));
    light->setPosition(osg::Vec4(2, -1, 0, 0)); // far from the coat's sharp highlight
    PbrMaterial lit, glowing;
    lit.metallic = glowing.metallic = 0.0f;
    glowing.baseColor.set(0, 0, 0, 1);
    glowing.emissive.set(0.5f, 0.5f, 0.5f);
    for (PbrMaterial* material : {&lit, &glowing})
    {
        const float without = linearColor(middle(*pictureOf(pbrPanel(true, *material)))).g();
        material->clearcoat = 1.0f;
        const float found = middle(*pictureOf(pbrPanel(true, *material))).g();
        EXPECT_NEAR(found, encoded(0.96 * without), 1.5 / 255);
        EXPECT_LT(found, encoded(without) - 1.5f / 255);
    }
}

// A coat over a surface that reflects nothing is a black dielectric with the coat's roughness and normal.
TEST_F(PbrMaterialGLTest, aCoatOverNothingIsASurface)
{
    surrounding->setAmbientIntensity(osg::Vec4(0, 0, 0, 1));
    for (const osg::Vec3& toLight : {osg::Vec3(0.5f, -1, 0.2f), osg::Vec3(2, -1, 0), osg::Vec3(-1, -1, -1)})
        for (const bool isLeaning : {false, true})
        {
            light->setPosition(osg::Vec4(toLight, 0));
            light->setDiffuse(osg::Vec4(6, 6, 6, 1));
            const osg::ref_ptr<osg::Texture2D> leaning = plainTexture({0.75f, 0.5f, 0.933f, 1});
            PbrMaterial coated, plain;
            for (PbrMaterial* material : {&coated, &plain})
            {
                material->baseColor.set(0, 0, 0, 1);
                material->metallic = 0.0f;
            }
            coated.specular = 0.0f;
            coated.clearcoat = 1.0f;
            coated.clearcoatRoughness = plain.roughness = 0.6f;
            if (isLeaning) coated.clearcoatNormalMap.texture = plain.normalMap.texture = leaning;
            coated.clearcoatNormalScale = plain.normalScale = 0.5f;
            const osg::Vec4 expected = middle(*pictureOf(pbrPanel(true, plain)));
            EXPECT_NEAR(middle(*pictureOf(pbrPanel(true, coated))).g(), expected.g(), 1.5f / 255) << toLight.x();
        }
}

// KHR_materials_sheen over a surface that reflects nothing, in double precision: Charlie's distribution and Neubelt's
// visibility; its alpha is the square of the roughness.
TEST_F(PbrMaterialGLTest, sheenIsReflectedAsSpecified)
{
    surrounding->setAmbientIntensity(osg::Vec4(0, 0, 0, 1));
    for (const double roughness : {0.4, 0.6, 1.0})
        for (const osg::Vec3& direction : {osg::Vec3(1, -1, 0), osg::Vec3(2, -1, 0.5f)})
        {
            PbrMaterial material;
            material.baseColor.set(0, 0, 0, 1);
            material.metallic = material.specular = 0.0f;
            material.sheenColor.set(0.8f, 0.8f, 0.8f);
            material.sheenRoughness = static_cast<float>(roughness);
            light->setPosition(osg::Vec4(direction, 0));
            light->setDiffuse(osg::Vec4(2, 2, 2, 1));
            const float found = middle(*pictureOf(pbrPanel(true, material))).g();
            osg::Vec3d toEye = -position, toLight(direction.x(), direction.z(), -direction.y());
            toEye.normalize();
            toLight.normalize();
            osg::Vec3d halfway = toEye + toLight;
            halfway.normalize();
            const double inverse = 1.0 / (roughness * roughness), cosLight = toLight.z(), cosEye = toEye.z();
            const double distribution =
                (2.0 + inverse) * std::pow(1.0 - halfway.z() * halfway.z(), 0.5 * inverse) / (2.0 * pi);
            const double visibility = 0.25 / (cosLight + cosEye - cosLight * cosEye);
            EXPECT_NEAR(found, encoded(2.0 * pi * cosLight * 0.8 * distribution * visibility), 2.0 / 255) << roughness;
        }
}

// Light is added up, so half a coat looks halfway between none and a whole one: in lights and surroundings.
TEST_F(PbrMaterialGLTest, halfACoatIsHalfway)
{
    const osg::Vec4 black(0, 0, 0, 1), grey(0.5f, 0.5f, 0.5f, 1);
    for (const bool isLight : {true, false})
    {
        light->setPosition(osg::Vec4(0.2f, -1, 0.2f, 0));
        light->setDiffuse(isLight ? grey : black);
        surrounding->setAmbientIntensity(isLight ? black : grey);
        float found[3];
        for (int half = 0; half < 3; ++half)
        {
            PbrMaterial material;
            material.baseColor.set(0.1f, 0.1f, 0.1f, 1);
            material.metallic = 0.0f;
            material.clearcoat = 0.5f * static_cast<float>(half);
            material.clearcoatRoughness = 0.5f;
            found[half] = linearColor(middle(*pictureOf(pbrPanel(true, material)))).g();
        }
        EXPECT_GT(found[2], found[0] + 0.01f);
        EXPECT_NEAR(found[1], 0.5f * (found[0] + found[2]), 0.003f) << isLight;
    }
}

TEST_F(PbrMaterialGLTest, occlusionDarkensSurroundingsAlone)
{
    PbrMaterial open, occluded;
    open.metallic = occluded.metallic = 0.0f;
    occluded.occlusionMap.texture = plainTexture({0, 1, 1, 1});
    const osg::ref_ptr<osg::Image> found = pictureOf(pbrPanel(true, occluded));
    EXPECT_GT(Picture::pixelsDifferent(*pictureOf(pbrPanel(true, open)), *found), 100);
    surrounding->setAmbientIntensity(osg::Vec4(0, 0, 0, 1));
    EXPECT_EQ(Picture::pixelsDifferent(*pictureOf(pbrPanel(true, open)), *found), 0);
}

TEST_F(PbrMaterialGLTest, colorsAreMixedInLinearLight)
{
    light->setDiffuse(osg::Vec4(0, 0, 0, 1));
    surrounding->setAmbientIntensity(osg::Vec4(1, 1, 1, 1));
    PbrMaterial material;
    material.baseColor.set(0.5f, 0.25f, 0.0f, 1);
    material.emissive.set(0.1f, 0, 0);
    material.emissiveStrength = 2.0f;
    material.metallic = 1.0f; // an even surrounding times the base colour, but for several bounces
    material.roughness = 0.0f;
    const osg::Vec4 found = middle(*pictureOf(pbrPanel(true, material)));
    EXPECT_NEAR(found.r(), encoded(0.5 + 0.2), 2.0 / 255);
    EXPECT_NEAR(found.g(), encoded(0.25), 2.0 / 255);
}

TEST_F(PbrMaterialGLTest, theEnvironmentTurnsAndHasAnIntensity)
{
    light->setDiffuse(osg::Vec4(0, 0, 0, 1));
    PbrMaterial material;
    material.roughness = 0.5f;
    const auto inStudio = [&](const std::function<void(Environment&)>& set)
    {
        osg::ref_ptr<Environment> studio = new Environment;
        set(*studio);
        return middle(*pictureOf(pbrPanel(true, material), studio));
    };
    const osg::Vec4 plain = inStudio([](Environment&) {});
    const osg::Vec4 dark = inStudio([](Environment& studio) { studio.setIntensity(0.5f); });
    EXPECT_NEAR(dark.g(), encoded(0.5 * linearColor(plain).g()), 2.0 / 255);
    EXPECT_GT((inStudio([](Environment& studio) { studio.setRotation(1.0f); }) - plain).length(), 0.03f);
    EXPECT_NEAR((inStudio([](Environment& studio) { studio.setRotation(float(2 * pi)); }) - plain).length(), 0.0f,
                0.01f);
    EXPECT_LT(inStudio([](Environment& studio) { studio.setIntensity(3), studio.setToneMapping(true); }).g(),
              inStudio([](Environment& studio) { studio.setIntensity(3); }).g());
}

} // namespace osgGpuAnimation
