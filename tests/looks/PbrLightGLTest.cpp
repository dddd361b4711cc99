// SPDX-License-Identifier: MIT
#include "looks/PbrPanelGLTest.h"

#include <osgGpuAnimation/looks/Environment.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <layout.glsl>

#include <osg/Fog>
#include <osg/FrontFace>
#include <osg/MatrixTransform>

#include <algorithm>
#include <utility>

#ifndef GL_FRAMEBUFFER_SRGB
#define GL_FRAMEBUFFER_SRGB 0x8DB9
#endif

// Normals, tangents, coordinates, lamps, surroundings, tone mapping, fog and tints of PbrMaterial's surfaces.

namespace osgGpuAnimation
{

namespace
{

using PbrLightGLTest = PbrPanelGLTest;

/// A dielectric whose normals a map leans by 30 degrees to the right (+X) or upwards.
PbrMaterial leaning(bool isUp)
{
    PbrMaterial material = dielectric();
    material.normalMap.texture = plainTexture({isUp ? 0.5f : 0.75f, isUp ? 0.75f : 0.5f, 0.933f, 1});
    return material;
}

/// Its back faces are seen.
osg::ref_ptr<osg::Node> seenFromBehind(osg::Node* panel)
{
    keepFront(*panel);
    osg::ref_ptr<osg::MatrixTransform> turned = new osg::MatrixTransform(osg::Matrix::rotate(osg::PI, 0, 0, 1));
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
    target.tangents = new osg::Vec3Array;
    target.tangents->assign(mesh->getVertexArray()->getNumElements(), tangentDelta);
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

// The map leans the normal to the right: a light from there is reflected more. Tangents say where the right is.
TEST_F(PbrLightGLTest, normalMapsLeanTheNormal)
{
    setSurrounding(0);
    const osg::Vec3 plain(1, 1, 1), mirrored(-1, 1, 1);
    for (const bool isMoving : {true, false})
    {
        const auto with = [&](const osg::Vec4& tangent, const osg::Vec3& scale, bool isUp = false)
        { return colorOf(pbrPanel(isMoving, leaning(isUp), scale, tangent)).r(); };
        setDirection({1, -1, 0});
        const float without = colorOf(pbrPanel(isMoving, dielectric())).r();
        const float derived = with({}, plain), left = with({-1, 0, 0, 1}, plain);
        EXPECT_GT(derived, without + 0.05f);
        EXPECT_NEAR(with({1, 0, 0, 1}, plain), derived, 2.0f / 255);
        EXPECT_LT(left, without - 0.05f);
        EXPECT_NEAR(with({0, 0, 0, 1}, plain), without, 2.0f / 255) << "of length 0: the mesh's own normal";
        // Mirrored at the plane x = 0, the map's right is on the left.
        EXPECT_NEAR(with({1, 0, 0, 1}, mirrored), left, 2.0f / 255);
        EXPECT_NEAR(with({}, mirrored), left, 2.0f / 255);
        // The bitangent's side, which a mirror keeps.
        setDirection({0, -1, 1});
        const float upwards = with({1, 0, 0, 1}, plain, true);
        EXPECT_NEAR(with({}, plain, true), upwards, 2.0f / 255);
        EXPECT_NEAR(with({1, 0, 0, 1}, mirrored, true), upwards, 2.0f / 255);
        EXPECT_LT(with({1, 0, 0, -1}, plain, true), upwards - 0.1f);
    }
}

// glTF 2.0, section 3.9.6: the normal of a back face is reversed, with the map's lean. Seen from behind, the map's
// right is on the left, so a lean to the right reversed is one to the right again, and one upwards is one downwards.
TEST_F(PbrLightGLTest, backFacesHaveTheReversedNormal)
{
    setSurrounding(0);
    const PbrMaterial level = dielectric(), aside = leaning(false), up = leaning(true);
    for (const bool isMoving : {true, false})
        for (const float tangent : {0.0f, 1.0f})
        {
            const auto at = [&](const osg::Vec3& toLight, const PbrMaterial& material, bool fromBehind,
                                bool isFlat = false, float length = 1.0f)
            {
                setDirection(toLight);
                const osg::ref_ptr<osg::Node> front =
                    pbrPanel(isMoving, material, {1, 1, 1}, {length * tangent, 0, 0, tangent});
                if (isFlat) findGeometry(*front)->getStateSet()->addUniform(new osg::Uniform("flatNormals", true));
                return colorOf(fromBehind ? seenFromBehind(front).get() : front.get()).r();
            };
            const osg::Vec3 right(1, -1, 0), above(0, -1, 1), below(0, -1, -1);
            EXPECT_NEAR(at(right, level, true), at(right, level, false), 2.0f / 255);
            EXPECT_NEAR(at(right, aside, true), at(right, aside, false), 2.0f / 255) << tangent;
            EXPECT_NEAR(at(above, up, true), at(below, up, false), 2.0f / 255) << tangent;
            EXPECT_GT(at(below, up, true), at(above, up, true) + 0.1f) << tangent;
            EXPECT_NEAR(at(right, level, true, true), at(right, level, true), 2.0f / 255) << "faces' own normals";
            if (tangent == 0.0f) continue;
            EXPECT_NEAR(at(right, aside, true, false, 0.0f), at(right, level, true), 2.0f / 255) << "no tangent";
        }
}

TEST_F(PbrLightGLTest, mirroringJointsAndMorphTargetsChangeTangents)
{
    setSurrounding(0);
    const osg::Vec3 same(0, 0, 0), turned(-2, 0, 0); // tangents along +X, and along -X
    const auto on = [&](float scale, const osg::Vec3& delta, bool isUp)
    { return colorOf(panelOnJoint(leaning(isUp), scale, delta)).r(); };
    setDirection({1, -1, 0});
    const float right = on(1, same, false), left = on(-1, same, false);
    EXPECT_GT(right, left + 0.1f);
    EXPECT_NEAR(on(1, turned, false), left, 2.0f / 255);
    EXPECT_NEAR(on(-1, turned, false), right, 2.0f / 255);
    // A mirror keeps the bitangent's side; a turned tangent turns it too.
    setDirection({0, -1, 1});
    const float upwards = on(1, same, true);
    EXPECT_NEAR(on(-1, same, true), upwards, 2.0f / 255);
    EXPECT_LT(on(1, turned, true), upwards - 0.1f);
}

TEST_F(PbrLightGLTest, aNormalOfLengthZeroFacesTheViewer)
{
    for (const bool isInStudio : {false, true})
    {
        const auto with = [&](const osg::Vec3& normal)
        { return colorOf(frontOfPanel(PbrMaterial(), normal), isInStudio ? new Environment : new osg::Group); };
        EXPECT_LT((with({0, 0, 0}) - with({0, -1, 0})).length(), 2.0f / 255) << (isInStudio ? "studio" : "one light");
    }
}

// KHR_texture_transform: the rows 2 n and 2 n + 1 are those of the coordinates n.
TEST_F(PbrLightGLTest, mapsReadTheCoordinatesOfTheirNumberByItsTransform)
{
    setLight(0);
    setSurrounding(0);
    const auto value = [](int column, int row) { return 0.05f + 0.06f * static_cast<float>(4 * row + column); };
    PbrMaterial material;
    material.hasMoreCoordinates = true;
    material.emissive.set(1, 1, 1);
    material.emissiveMap.texture =
        texels(4, 4, [&](int column, int row) { return osg::Vec4(1, 1, 1, 1) * value(column, row); });
    const osg::Vec3 rows[] = {{0, 1, 0}, {1, 0, 0.75f}, {1, 0, 0.5f}, {0, 1, 0.25f}, {-1, 0, 1}, {1, 0, 0}};
    const struct
    {
        std::pair<int, int> plain, transformed; ///< column and row
    } texelsOf[] = {{{0, 1}, {1, 3}}, {{1, 2}, {3, 3}}, {{3, 0}, {0, 3}}};
    const osg::ref_ptr<osg::Uniform> transforms = new osg::Uniform(osg::Uniform::FLOAT_VEC3, "textureTransforms", 6);
    for (unsigned int row = 0; row < 6; ++row)
        transforms->setElement(row, rows[row]);
    for (const bool isMoving : {true, false})
        for (const bool isTransformed : {false, true})
            for (const int number : {0, 1, 2})
            {
                material.emissiveMap.coordinates = number;
                const osg::ref_ptr<osg::Node> subject = pbrPanel(isMoving, material);
                osg::Geometry& mesh = *findGeometry(*subject);
                setCoordinates(mesh, {0.125f, 0.375f}, {0.375f, 0.625f, 0.875f, 0.125f});
                if (isTransformed) mesh.getStateSet()->setDefine("MATERIAL_TEXTURE_TRANSFORM", "1");
                mesh.getStateSet()->addUniform(transforms);
                const auto& [column, row] = isTransformed ? texelsOf[number].transformed : texelsOf[number].plain;
                EXPECT_NEAR(colorOf(subject).r(), encoded(value(column, row)), 2.0 / 255)
                    << number << (isTransformed ? ", transformed" : "");
            }
}

TEST_F(PbrLightGLTest, theAmbientLightOfALampIsAttenuated)
{
    setLight(0);
    const float expected = colorOf(dielectric()).g(); // in a surrounding of 0.2
    setSurrounding(0);
    light->setAmbient(osg::Vec4(0.8f, 0.8f, 0.8f, 1));
    light->setPosition(osg::Vec4d(2 * position.x(), -4, 2 * position.y(), 2)); // 2 units before the panel
    light->setConstantAttenuation(0);
    light->setQuadraticAttenuation(1);
    EXPECT_NEAR(colorOf(dielectric()).g(), expected, 2.0f / 255);
}

// The scale above surroundings has no effect on their light, even if it is small or different along the axes.
TEST_F(PbrLightGLTest, scalesAboveSurroundingsChangeNoLight)
{
    setLight(0);
    setSurrounding(0);
    const auto with = [&](const osg::Vec3d& scale)
    {
        const osg::ref_ptr<Environment> studio = new Environment;
        studio->setRotation(1.0f);
        PbrMaterial material;
        material.roughness = 0.4f;
        const osg::Matrix matrix = osg::Matrix::scale(scale) * osg::Matrix::rotate(0.5, 0, 0, 1);
        const osg::ref_ptr<osg::MatrixTransform> above = new osg::MatrixTransform(matrix),
                                                 below = new osg::MatrixTransform(osg::Matrix::inverse(matrix));
        above->addChild(studio);
        studio->addChild(below);
        below->addChild(frontOfPanel(material));
        return colorOf(above);
    };
    const osg::Vec4 expected = with({1, 1, 1});
    EXPECT_GT(expected.g(), 0.1f);
    for (const osg::Vec3d& scale : {osg::Vec3d(1e-6, 1e-6, 1e-6), osg::Vec3d(0.2, 3, 1), osg::Vec3d(1, 0.001, 40)})
        EXPECT_LT((with(scale) - expected).length(), 2.0f / 255) << scale.x() << ' ' << scale.y() << ' ' << scale.z();
}

TEST_F(PbrLightGLTest, theToneMapperIsKhronoss)
{
    setLight(0);
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
        const osg::Vec4 found = colorOf(pbrPanel(true, glowing), dark);
        const osg::Vec3d expected = toneMapped(osg::Vec3d(color) * strength);
        for (int channel = 0; channel < 3; ++channel)
            EXPECT_NEAR(found[channel], encoded(expected[channel]), 2.0 / 255) << color.x() << ", channel " << channel;
    }
}

// Fog is mixed as displayed, like the fixed pipeline's; for a framebuffer that encodes, all of the shader is linear.
TEST_F(PbrLightGLTest, fogIsMixedInTheLightOfTheFramebuffer)
{
    PbrMaterial black = dielectric(0);
    black.specular = 0.0f;
    black.emissive.set(0.2f, 0.2f, 0.2f);
    setLight(0);
    setSurrounding(0);
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
        const float fogged =
            isEncoding ? encoded(0.5 * (0.2 + linearColor(fog->getColor()).r())) : 0.5f * (encoded(0.2) + 0.7f);
        EXPECT_NEAR(colorOf(subject).r(), fogged, 2.0f / 255) << isEncoding;
    }
}

// Tints are colours as displayed: on a surface that scatters everything, a tint looks as it is written.
TEST_F(PbrLightGLTest, tintsOfACrowdAreMultipliedInLinearLight)
{
    setLight(0);
    setSurrounding(1);
    PbrMaterial matt = dielectric(); // scatters all light of the surroundings
    matt.baseColor.g() = 0.5f;
    matt.specular = 0.0f;
    const osg::ref_ptr<osg::Node> subject = pbrPanel(true, matt);
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*findCharacter(*subject));
    const AnimationController controller(crowd->getSharedAnimationSet());
    ASSERT_TRUE(crowd->add(osg::Matrix(), controller, osg::Vec4(0.5f, 0.8f, 0.03f, 1)));
    const osg::Vec4 found = colorOf(crowd);
    EXPECT_NEAR(found.r(), 0.5f, 2.0f / 255);
    EXPECT_NEAR(found.g(), encoded(0.5 * linearColor({0, 0.8f, 0, 1}).g()), 2.0 / 255);
    EXPECT_NEAR(found.b(), 0.03f, 2.0f / 255) << "the straight part of the transfer function";
}

} // namespace osgGpuAnimation
