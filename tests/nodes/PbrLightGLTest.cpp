// SPDX-License-Identifier: MIT
#include "nodes/PbrPanelGLTest.h"

#include <osgGpuAnimation/looks/Environment.h>
#include <osgGpuAnimation/looks/shading/PunctualLight.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <layout.glsl>

#include <osg/Fog>
#include <osg/FrontFace>
#include <osg/MatrixTransform>

#include <algorithm>
#include <cmath>
#include <utility>

#ifndef GL_FRAMEBUFFER_SRGB
#define GL_FRAMEBUFFER_SRGB 0x8DB9
#endif

// Back faces, mirrored tangents, further coordinates, sheen, tone mapping, spots, fog and tints of PbrMaterial's
// surfaces.

namespace osgGpuAnimation
{

namespace
{

using PbrLightGLTest = PbrPanelGLTest;

constexpr double pi = 3.14159265358979;

/// The front side of a panel, turned by half a circle: its back faces are seen.
osg::ref_ptr<osg::Node> seenFromBehind(osg::Node* panel)
{
    auto& indices = static_cast<osg::DrawElementsUShort&>(*findGeometry(*panel)->getPrimitiveSet(0));
    indices.resize(indices.size() / 2);
    osg::ref_ptr<osg::MatrixTransform> turned = new osg::MatrixTransform(osg::Matrix::rotate(pi, 0, 0, 1));
    turned->addChild(panel);
    return turned;
}

/// The panel with tangents along +X, on a joint of that scale along X, with a morph target that is fully shown.
osg::ref_ptr<osg::Node> panelOnJoint(const PbrMaterial& material, float scale, const osg::Vec3& tangentDelta)
{
    const osg::ref_ptr<osg::Node> source = pbrPanel(true, material, {1, 1, 1}, {1, 0, 0, 1});
    const osg::ref_ptr<SkinnedGeometry> mesh = static_cast<SkinnedGeometry*>(findGeometry(*source));
    JointTransform rest;
    rest.scale.x = scale;
    MorphWeights weights;
    weights.defaults = {1.0f};
    const auto set =
        AnimationSet::create({Skeleton::create({{"joint", -1, rest, 0}}).value(), {}, {0}, {weights}, {}}).value();
    mesh->setRigidEntry(static_cast<unsigned short>(set->entryOfRigidJoint(0)));
    MorphTarget target;
    target.tangents = new osg::Vec3Array(mesh->getVertexArray()->getNumElements());
    std::fill(target.tangents->begin(), target.tangents->end(), tangentDelta);
    mesh->setMorphTargets(*set, 0, {target});
    if (scale < 0.0f) mesh->getStateSet()->setAttributeAndModes(new osg::FrontFace(osg::FrontFace::CLOCKWISE));
    osg::ref_ptr<AnimatedCharacter> character = new AnimatedCharacter(set);
    character->addChild(mesh);
    return character;
}

/// Khronos's PBR Neutral Tone Mapper as its specification states it.
osg::Vec3d toneMapped(osg::Vec3d color)
{
    const double least = std::min({color.x(), color.y(), color.z()});
    const double offset = least < 0.08 ? least - 6.25 * least * least : 0.04;
    color -= osg::Vec3d(offset, offset, offset);
    const double peak = std::max({color.x(), color.y(), color.z()}), start = 0.8 - 0.04;
    if (peak < start) return color;
    const double newPeak = 1.0 - (1.0 - start) * (1.0 - start) / (peak + (1.0 - start) - start);
    const double grey = 1.0 - 1.0 / (0.15 * (peak - newPeak) + 1.0);
    return color * (newPeak / peak * (1.0 - grey)) + osg::Vec3d(newPeak, newPeak, newPeak) * grey;
}

} // namespace

// KHR_materials_sheen: white fibres of roughness 1 reflect 14 % of the light along the normal (the integral of their
// distribution), which what lies below lacks. Red fibres take as much of the green light and reflect none of it.
TEST_F(PbrLightGLTest, whatLiesBelowTheSheenIsDarker)
{
    const osg::Vec4 black(0, 0, 0, 1), grey(0.5f, 0.5f, 0.5f, 1);
    for (const auto& [lights, ambient] : {std::pair(grey, black), std::pair(black, grey)})
    {
        light->setDiffuse(lights);
        surrounding->setAmbientIntensity(ambient);
        PbrMaterial material;
        material.metallic = 0.0f;
        const float without = linearColor(middle(*pictureOf(pbrPanel(true, material)))).g();
        material.sheenColor.set(1, 0, 0);
        material.sheenRoughness = 1.0f;
        // The shader's fit is up to 0.03 beside the integral.
        EXPECT_NEAR(linearColor(middle(*pictureOf(pbrPanel(true, material)))).g() / without, 0.86f, 0.04f);
    }
}

// KHR_materials_specular: without the reflection's weight, a black dielectric is black at all angles.
TEST_F(PbrLightGLTest, aSpecularWeightOfZeroReflectsNothing)
{
    surrounding->setAmbientIntensity(osg::Vec4(1, 1, 1, 1));
    PbrMaterial material;
    material.baseColor.set(0, 0, 0, 1);
    material.metallic = 0.0f;
    material.roughness = 0.3f;
    for (const float specular : {1.0f, 0.0f})
    {
        material.specular = specular;
        const osg::ref_ptr<osg::MatrixTransform> tilted = new osg::MatrixTransform(osg::Matrix::rotate(1.3, 1, 0, 0));
        tilted->addChild(pbrPanel(true, material));
        const float found = middle(*pictureOf(tilted)).g();
        if (specular > 0.0f)
            EXPECT_GT(found, 0.3f);
        else
            EXPECT_NEAR(found, 0.0f, 1.0f / 255);
    }
}

// glTF 2.0, section 3.9.6: the normal of a back face is reversed, with the map's lean. Seen from behind, the map's
// right is on the left, so a lean to the right reversed is one to the right again, and one upwards is one downwards.
TEST_F(PbrLightGLTest, backFacesHaveTheReversedNormal)
{
    surrounding->setAmbientIntensity(osg::Vec4(0, 0, 0, 1));
    PbrMaterial level, leaning, up;
    level.metallic = leaning.metallic = up.metallic = 0.0f;
    leaning.normalMap.texture = plainTexture({0.75f, 0.5f, 0.933f, 1});
    up.normalMap.texture = plainTexture({0.5f, 0.75f, 0.933f, 1});
    for (const bool isMoving : {true, false})
        for (const float tangent : {0.0f, 1.0f})
        {
            const auto at = [&](const osg::Vec3& toLight, const PbrMaterial& material, bool fromBehind,
                                bool isFlat = false, float length = 1.0f)
            {
                light->setPosition(osg::Vec4(toLight, 0));
                const osg::ref_ptr<osg::Node> front =
                    pbrPanel(isMoving, material, {1, 1, 1}, {length * tangent, 0, 0, tangent});
                if (isFlat) findGeometry(*front)->getStateSet()->addUniform(new osg::Uniform("flatNormals", true));
                return middle(*pictureOf(fromBehind ? seenFromBehind(front).get() : front.get())).r();
            };
            const osg::Vec3 right(1, -1, 0), above(0, -1, 1), below(0, -1, -1);
            EXPECT_NEAR(at(right, level, true), at(right, level, false), 2.0f / 255);
            EXPECT_NEAR(at(right, leaning, true), at(right, leaning, false), 2.0f / 255) << tangent;
            EXPECT_NEAR(at(above, up, true), at(below, up, false), 2.0f / 255) << tangent;
            EXPECT_GT(at(below, up, true), at(above, up, true) + 0.1f) << tangent;
            EXPECT_NEAR(at(right, level, true, true), at(right, level, true), 2.0f / 255) << "faces' own normals";
            if (tangent == 0.0f) continue;
            EXPECT_NEAR(at(right, leaning, true, false, 0.0f), at(right, level, true), 2.0f / 255) << "no tangent";
        }
}

TEST_F(PbrLightGLTest, mirroringJointsAndMorphTargetsChangeTangents)
{
    surrounding->setAmbientIntensity(osg::Vec4(0, 0, 0, 1));
    PbrMaterial leaning, up;
    leaning.metallic = up.metallic = 0.0f;
    leaning.normalMap.texture = plainTexture({0.75f, 0.5f, 0.933f, 1});
    up.normalMap.texture = plainTexture({0.5f, 0.75f, 0.933f, 1});
    const osg::Vec3 same(0, 0, 0), turned(-2, 0, 0); // tangents along +X, and along -X
    light->setPosition(osg::Vec4(1, -1, 0, 0));
    const float right = middle(*pictureOf(panelOnJoint(leaning, 1, same))).r();
    const float left = middle(*pictureOf(panelOnJoint(leaning, -1, same))).r();
    EXPECT_GT(right, left + 0.1f);
    EXPECT_NEAR(middle(*pictureOf(panelOnJoint(leaning, 1, turned))).r(), left, 2.0f / 255);
    EXPECT_NEAR(middle(*pictureOf(panelOnJoint(leaning, -1, turned))).r(), right, 2.0f / 255);
    // A mirror keeps the bitangent's side; a turned tangent turns it too.
    light->setPosition(osg::Vec4(0, -1, 1, 0));
    const float upwards = middle(*pictureOf(panelOnJoint(up, 1, same))).r();
    EXPECT_NEAR(middle(*pictureOf(panelOnJoint(up, -1, same))).r(), upwards, 2.0f / 255);
    EXPECT_LT(middle(*pictureOf(panelOnJoint(up, 1, turned))).r(), upwards - 0.1f);
}

TEST_F(PbrLightGLTest, theNormalMapOfTheCoatUsesTangents)
{
    surrounding->setAmbientIntensity(osg::Vec4(0, 0, 0, 1));
    light->setPosition(osg::Vec4(1, -1, 0, 0));
    PbrMaterial coated;
    coated.baseColor.set(0, 0, 0, 1);
    coated.metallic = 0.0f;
    coated.clearcoat = 1.0f;
    coated.clearcoatRoughness = 0.5f;
    coated.clearcoatNormalMap.texture = plainTexture({0.75f, 0.5f, 0.933f, 1}); // leans to the right
    const osg::Vec3 plain(1, 1, 1);
    const float derived = middle(*pictureOf(pbrPanel(true, coated))).r();
    EXPECT_NEAR(middle(*pictureOf(pbrPanel(true, coated, plain, {1, 0, 0, 1}))).r(), derived, 2.0f / 255);
    EXPECT_LT(middle(*pictureOf(pbrPanel(true, coated, plain, {-1, 0, 0, 1}))).r(), derived - 0.1f);
}

TEST_F(PbrLightGLTest, mapsReadTheCoordinatesOfTheirNumber)
{
    light->setDiffuse(osg::Vec4(0, 0, 0, 1));
    surrounding->setAmbientIntensity(osg::Vec4(0, 0, 0, 1));
    PbrMaterial material;
    material.hasMoreCoordinates = true;
    material.emissive.set(1, 1, 1);
    const osg::ref_ptr<osg::Texture2D> columns = plainTexture({0.2f, 0.2f, 0.2f, 1});
    columns->getImage()->allocateImage(4, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    const float values[] = {0.1f, 0.3f, 0.5f, 0.9f};
    for (unsigned int column = 0; column < 4; ++column)
        columns->getImage()->setColor(osg::Vec4(1, 1, 1, 1) * values[column], column, 0);
    columns->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
    columns->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
    material.emissiveMap.texture = columns;
    for (const bool isMoving : {true, false})
        for (const int number : {0, 1, 2})
        {
            material.emissiveMap.coordinates = number;
            const osg::ref_ptr<osg::Node> subject = pbrPanel(isMoving, material);
            osg::Geometry& mesh = *findGeometry(*subject);
            for (osg::Vec2& place : static_cast<osg::Vec2Array&>(*mesh.getTexCoordArray(0)))
                place.set(0.125f, 0.5f);
            mesh.setVertexAttribArray(POSE_COORDINATES_LOCATION, attribute(mesh, {0.375f, 0.5f, 0.625f, 0.5f}));
            EXPECT_NEAR(middle(*pictureOf(subject)).r(), encoded(values[number]), 1.5 / 255) << number;
        }
}

/// Maps together, and the factors without which they have no effect.
struct MapsCase
{
    const char* name;
    std::vector<PbrMaterial::Map PbrMaterial::*> maps;
    void (*prepare)(PbrMaterial& material);
};

const MapsCase mapsCases[] = {
    {"core",
     {&PbrMaterial::metallicRoughnessMap, &PbrMaterial::normalMap, &PbrMaterial::occlusionMap,
      &PbrMaterial::emissiveMap},
     [](PbrMaterial& m) { m.emissive.set(0.2f, 0.2f, 0.2f); }},
    {"coat",
     {&PbrMaterial::clearcoatMap, &PbrMaterial::clearcoatRoughnessMap},
     [](PbrMaterial& m) { m.clearcoat = m.clearcoatRoughness = 1.0f; }},
    {"coat's normal, specular colour and sheen",
     {&PbrMaterial::clearcoatNormalMap, &PbrMaterial::specularColorMap, &PbrMaterial::sheenColorMap},
     [](PbrMaterial& m)
     {
         m.clearcoat = 1.0f, m.clearcoatRoughness = 0.5f;
         m.specularColor.set(0.9f, 0.9f, 0.9f);
         m.sheenColor.set(1, 1, 1), m.sheenRoughness = 0.8f;
     }},
    {"sheen's roughness, specular and transmission",
     {&PbrMaterial::sheenRoughnessMap, &PbrMaterial::specularMap, &PbrMaterial::transmissionMap},
     [](PbrMaterial& m)
     {
         m.specularColor.set(0.5f, 0.5f, 0.5f);
         m.sheenColor.set(1, 1, 1), m.sheenRoughness = 1.0f;
         m.transmission = 0.8f;
     }},
    {"glossiness", {&PbrMaterial::specularColorMap}, [](PbrMaterial& m) { m.isSpecularGlossiness = true; }},
};

// A place of the maps by the first or by the second coordinates looks the same, and unlike another place.
TEST_F(PbrLightGLTest, everyMapReadsItsOwnCoordinates)
{
    light->setPosition(osg::Vec4(0, -1, 0.1f, 0));
    for (const MapsCase& each : mapsCases)
    {
        SCOPED_TRACE(each.name);
        PbrMaterial material;
        material.baseColor.set(0.5f, 0.4f, 0.3f, 1);
        material.metallic = 0.3f;
        material.roughness = 0.7f;
        material.hasMoreCoordinates = true;
        each.prepare(material);
        const auto colorWith = [&](int number, float first, float second)
        {
            for (PbrMaterial::Map PbrMaterial::*const map : each.maps)
            {
                const bool isNormal = map == &PbrMaterial::normalMap || map == &PbrMaterial::clearcoatNormalMap;
                const osg::ref_ptr<osg::Texture2D> halves =
                    plainTexture(isNormal ? osg::Vec4(0.5f, 0.5f, 1, 1) : osg::Vec4(0.2f, 0.3f, 0.2f, 0.2f));
                for (unsigned int row = 0; row < 2; ++row)
                    halves->getImage()->setColor(
                        isNormal ? osg::Vec4(0.8f, 0.6f, 0.8f, 1) : osg::Vec4(0.9f, 0.8f, 0.9f, 0.9f), 1, row);
                halves->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
                halves->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
                material.*map = {halves, number};
            }
            const osg::ref_ptr<osg::Node> subject = pbrPanel(true, material, {1, 1, 1}, {1, 0, 0, 1});
            osg::Geometry& mesh = *findGeometry(*subject);
            for (osg::Vec2& place : static_cast<osg::Vec2Array&>(*mesh.getTexCoordArray(0)))
                place.set(first, 0.5f);
            mesh.setVertexAttribArray(POSE_COORDINATES_LOCATION, attribute(mesh, {second, 0.5f, first, 0.5f}));
            return middle(*pictureOf(subject));
        };
        const osg::Vec4 expected = colorWith(0, 0.75f, 0.25f);
        EXPECT_GT((expected - colorWith(0, 0.25f, 0.75f)).length(), 4.0f / 255);
        EXPECT_LT((expected - colorWith(1, 0.25f, 0.75f)).length(), 1.5f / 255);
    }
}

// KHR_texture_transform: the rows 2 n and 2 n + 1 are those of the coordinates n.
TEST_F(PbrLightGLTest, transformsAreThoseOfTheirCoordinates)
{
    light->setDiffuse(osg::Vec4(0, 0, 0, 1));
    surrounding->setAmbientIntensity(osg::Vec4(0, 0, 0, 1));
    PbrMaterial material;
    material.hasMoreCoordinates = true;
    material.emissive.set(1, 1, 1);
    const osg::ref_ptr<osg::Texture2D> squares = plainTexture({0, 0, 0, 1});
    squares->getImage()->allocateImage(4, 4, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    const auto value = [](unsigned int column, unsigned int row) { return 0.05f + 0.06f * float(4 * row + column); };
    for (unsigned int place = 0; place < 16; ++place)
        squares->getImage()->setColor(osg::Vec4(1, 1, 1, 1) * value(place % 4, place / 4), place % 4, place / 4);
    squares->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
    squares->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
    material.emissiveMap.texture = squares;
    const osg::Vec3 rows[] = {{0, 1, 0}, {1, 0, 0.75f}, {1, 0, 0.5f}, {0, 1, 0.25f}, {-1, 0, 1}, {1, 0, 0}};
    const std::pair<unsigned int, unsigned int> squaresOf[] = {{1, 3}, {2, 2}, {3, 0}};
    for (const int number : {0, 1, 2})
    {
        material.emissiveMap.coordinates = number;
        const osg::ref_ptr<osg::Node> subject = pbrPanel(true, material);
        osg::Geometry& mesh = *findGeometry(*subject);
        for (osg::Vec2& place : static_cast<osg::Vec2Array&>(*mesh.getTexCoordArray(0)))
            place.set(0.125f, 0.375f);
        mesh.setVertexAttribArray(POSE_COORDINATES_LOCATION, attribute(mesh, {0.125f, 0.375f, 0.125f, 0.375f}));
        mesh.getStateSet()->setDefine("MATERIAL_TEXTURE_TRANSFORM", "1");
        const osg::ref_ptr<osg::Uniform> transforms =
            new osg::Uniform(osg::Uniform::FLOAT_VEC3, "textureTransforms", 6);
        for (unsigned int row = 0; row < 6; ++row)
            transforms->setElement(row, rows[row]);
        mesh.getStateSet()->addUniform(transforms);
        const auto& [column, row] = squaresOf[number];
        EXPECT_NEAR(middle(*pictureOf(subject)).r(), encoded(value(column, row)), 2.0 / 255) << number;
    }
}

TEST_F(PbrLightGLTest, theToneMapperIsKhronoss)
{
    light->setDiffuse(osg::Vec4(0, 0, 0, 1));
    const std::pair<osg::Vec3, float> cases[] = {{{0.5f, 0.3f, 0.2f}, 1}, {{0.05f, 0.02f, 0.03f}, 1},
                                                 {{0.9f, 0.6f, 0.4f}, 1}, // between the start and 1
                                                 {{1, 0.1f, 0.1f}, 4},    // highlights lose their colour
                                                 {{0.2f, 0.5f, 1}, 8},    {{1, 1, 1}, 2}};
    for (const auto& [color, strength] : cases)
    {
        PbrMaterial glowing;
        glowing.baseColor.set(0, 0, 0, 1);
        glowing.emissive = color;
        glowing.emissiveStrength = strength;
        osg::ref_ptr<Environment> dark = new Environment;
        dark->setIntensity(0.0f);
        dark->setToneMapping(true);
        const osg::Vec4 found = middle(*pictureOf(pbrPanel(true, glowing), dark));
        const osg::Vec3d expected = toneMapped(osg::Vec3d(color) * strength);
        for (int channel = 0; channel < 3; ++channel)
            EXPECT_NEAR(found[channel], encoded(expected[channel]), 2.0 / 255) << color.x() << ", channel " << channel;
    }
}

// KHR_lights_punctual: between the cones the light falls with the square of the cosine's share.
TEST_F(PbrLightGLTest, aSpotFadesToTheEdgeOfItsCone)
{
    surrounding->setAmbientIntensity(osg::Vec4(0, 0, 0, 1));
    PbrMaterial material;
    material.metallic = 0.0f;
    middle(*pictureOf(pbrPanel(true, material)));
    const osg::Vec3 place(position.x(), -2, position.y());
    const auto lit = [&](PunctualLight::Kind kind, double degrees)
    {
        const osg::ref_ptr<PunctualLight> made = new PunctualLight(kind, 0);
        EXPECT_TRUE(made->setIntensity({1, 1, 1}, 8.0f));
        if (kind == PunctualLight::Kind::Spot)
        {
            EXPECT_TRUE(made->setCone(10, 40));
        }
        made->setPosition(osg::Vec4(place, 1));
        made->setDirection(osg::Vec3(std::sin(degrees * pi / 180), std::cos(degrees * pi / 180), 0));
        light = made;
        return linearColor(middle(*pictureOf(pbrPanel(true, material)))).g();
    };
    const float whole = lit(PunctualLight::Kind::Point, 0);
    const auto cosine = [](double degrees) { return std::cos(degrees * pi / 180); };
    for (const double degrees : {0.0, 9.0, 20.0, 30.0, 41.0})
    {
        const double share = std::clamp((cosine(degrees) - cosine(40)) / (cosine(10) - cosine(40)), 0.0, 1.0);
        EXPECT_NEAR(lit(PunctualLight::Kind::Spot, degrees) / whole, share * share, 0.03) << degrees;
    }
}

// KHR_lights_punctual: a window of 1 - (distance / range)^4. The highest light number, which has uniforms of its own.
TEST_F(PbrLightGLTest, aLightEndsAtItsRange)
{
    surrounding->setAmbientIntensity(osg::Vec4(0, 0, 0, 1));
    PbrMaterial material;
    material.metallic = 0.0f;
    middle(*pictureOf(pbrPanel(true, material)));
    const auto lit = [&](float range)
    {
        const osg::ref_ptr<PunctualLight> made = new PunctualLight(PunctualLight::Kind::Point, 7);
        EXPECT_TRUE(made->setIntensity({1, 1, 1}, 8.0f));
        EXPECT_TRUE(made->setRange(range));
        made->setPosition(osg::Vec4(position.x(), -2, position.y(), 1));
        light = made;
        return linearColor(middle(*pictureOf(pbrPanel(true, material)))).g();
    };
    const float whole = lit(0.0f);
    EXPECT_GT(whole, 0.3f);
    for (const double range : {1.9, 2.2, 3.0, 9.0})
        EXPECT_NEAR(lit(static_cast<float>(range)) / whole, std::max(1.0 - std::pow(2.0 / range, 4.0), 0.0), 0.02)
            << range;
}

TEST_F(PbrLightGLTest, theAmbientLightOfALampIsAttenuated)
{
    PbrMaterial white;
    white.metallic = 0.0f;
    light->setDiffuse(osg::Vec4(0, 0, 0, 1));
    const float expected = middle(*pictureOf(pbrPanel(true, white))).g(); // in a surrounding of 0.2
    surrounding->setAmbientIntensity(osg::Vec4(0, 0, 0, 1));
    light->setAmbient(osg::Vec4(0.8f, 0.8f, 0.8f, 1));
    light->setPosition(osg::Vec4(2 * position.x(), -4, 2 * position.y(), 2)); // 2 units before the panel
    light->setConstantAttenuation(0);
    light->setQuadraticAttenuation(1);
    EXPECT_NEAR(middle(*pictureOf(pbrPanel(true, white))).g(), expected, 2.0f / 255);
}

// Fog is mixed as displayed, like the fixed pipeline's; for a framebuffer that encodes, all of the shader is linear.
TEST_F(PbrLightGLTest, fogIsMixedInTheLightOfTheFramebuffer)
{
    PbrMaterial black;
    black.baseColor.set(0, 0, 0, 1);
    black.emissive.set(0.2f, 0.2f, 0.2f);
    light->setDiffuse(osg::Vec4(0, 0, 0, 1));
    surrounding->setAmbientIntensity(osg::Vec4(0, 0, 0, 1));
    for (const bool isEncoding : {false, true})
    {
        const osg::ref_ptr<osg::Node> subject = pbrPanel(true, black);
        osg::StateSet& state = *subject->getOrCreateStateSet();
        const osg::ref_ptr<osg::Fog> fog = new osg::Fog;
        fog->setMode(osg::Fog::LINEAR);
        fog->setColor({0.7f, 0.2f, 0.2f, 1});
        fog->setStart(5);
        fog->setEnd(15); // the panel is 10 units away: a half is fog
        state.setAttributeAndModes(fog);
        if (isEncoding) state.setMode(GL_FRAMEBUFFER_SRGB, osg::StateAttribute::ON);
        const float found = middle(*pictureOf(subject)).r();
        const float fogged =
            isEncoding ? encoded(0.5 * (0.2 + linearColor(fog->getColor()).r())) : 0.5f * (encoded(0.2) + 0.7f);
        EXPECT_NEAR(found, fogged, 2.0f / 255) << isEncoding;
    }
}

// Tints are colours as displayed: on a surface that scatters everything, a tint looks as it is written.
TEST_F(PbrLightGLTest, tintsOfACrowdAreMultipliedInLinearLight)
{
    light->setDiffuse(osg::Vec4(0, 0, 0, 1));
    surrounding->setAmbientIntensity(osg::Vec4(1, 1, 1, 1));
    PbrMaterial matt; // scatters all light of the surroundings
    matt.baseColor.set(1, 0.5f, 1, 1);
    matt.metallic = matt.specular = 0.0f;
    const osg::ref_ptr<osg::Node> subject = pbrPanel(true, matt);
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*findCharacter(*subject));
    const AnimationController controller(crowd->getSharedAnimationSet());
    ASSERT_TRUE(crowd->add(osg::Matrix(), controller, osg::Vec4(0.5f, 0.8f, 0.03f, 1)));
    const osg::Vec4 found = middle(*pictureOf(crowd));
    EXPECT_NEAR(found.r(), 0.5f, 2.0f / 255);
    EXPECT_NEAR(found.g(), encoded(0.5 * linearColor({0, 0.8f, 0, 1}).g()), 2.0 / 255);
    EXPECT_NEAR(found.b(), 0.03f, 2.0f / 255) << "the straight part of the transfer function";
}

// GL 3.3 has 16 units a shader stage at least: of more maps the first three are used, and no unit beyond is touched.
TEST(PbrMaterialTest, onlyTheFirstExtensionMapsHaveUnits)
{
    PbrMaterial material;
    for (PbrMaterial::Map* map : {&material.specularMap, &material.sheenColorMap, &material.clearcoatNormalMap,
                                  &material.clearcoatMap, &material.clearcoatRoughnessMap})
        map->texture = plainTexture({1, 1, 1, 1});
    material.clearcoat = 1.0f;
    const osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    applyPbrMaterial(*state, material);
    for (int unit = 0; unit < PbrMaterial::maxExtensionMaps + 2; ++unit)
        EXPECT_EQ(state->getTextureAttribute(static_cast<unsigned int>(EXTENSION_MAPS_UNIT + unit),
                                             osg::StateAttribute::TEXTURE) != nullptr,
                  unit < PbrMaterial::maxExtensionMaps)
            << unit;
    const osg::StateSet::DefineList& defines = state->getDefineList();
    for (const char* used :
         {"MATERIAL_CLEARCOAT_MAP", "MATERIAL_CLEARCOAT_ROUGHNESS_MAP", "MATERIAL_CLEARCOAT_NORMAL_MAP"})
        EXPECT_EQ(defines.count(used), 1u) << used;
    for (const char* left : {"MATERIAL_SHEEN_COLOR_MAP", "MATERIAL_SPECULAR_MAP"})
        EXPECT_EQ(defines.count(left), 0u) << left;
}

} // namespace osgGpuAnimation
