// SPDX-License-Identifier: MIT
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/looks/CharacterProgram.h>
#include <osgGpuAnimation/looks/Environment.h>
#include <osgGpuAnimation/looks/PbrMaterial.h>

#include <osg/Geometry>
#include <osg/LightModel>
#include <osg/LightSource>
#include <osg/MatrixTransform>

// Materials at the edges of what glTF allows.

namespace osgGpuAnimation
{

namespace
{

/// A picture of one colour. value: as stored, in [0, 1].
osg::ref_ptr<osg::Texture2D> plainTexture(const osg::Vec4& value)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(1, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    image->setColor(value, 0, 0);
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(image);
    texture->setInternalFormat(GL_RGBA8);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
    return texture;
}

/// A square of 4 x 4 units in the XZ plane that faces the camera.
osg::ref_ptr<osg::Geometry> square(const PbrMaterial& material, const osg::Vec3& normal = {0, -1, 0})
{
    osg::ref_ptr<osg::Geometry> mesh = new osg::Geometry;
    mesh->setUseVertexBufferObjects(true);
    osg::ref_ptr<osg::Vec3Array> corners = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec2Array> coordinates = new osg::Vec2Array;
    for (const float z : {0.0f, 1.0f})
        for (const float x : {0.0f, 1.0f})
        {
            corners->push_back(osg::Vec3(4 * x - 2, 0, 4 * z - 2));
            coordinates->push_back(osg::Vec2(x, z));
        }
    osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array;
    normals->assign(4, normal);
    mesh->setVertexArray(corners);
    mesh->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    mesh->setTexCoordArray(0, coordinates, osg::Array::BIND_PER_VERTEX);
    mesh->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLE_STRIP, 0, 4));
    applyPbrMaterial(*mesh->getOrCreateStateSet(), material);
    applySurfaceProgram(*mesh->getOrCreateStateSet(), false);
    return mesh;
}

class PbrMaterialEdgesGLTest : public ViewerGLTest
{
protected:
    /// The colour in the middle, before red, under one light and an even surrounding.
    osg::Vec4 middleOf(osg::Node* subject, float surrounding = 0.4f)
    {
        const osg::ref_ptr<osg::Group> root = new osg::Group;
        const osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
        source->getLight()->setPosition(osg::Vec4(0.5f, -1.0f, 0.3f, 0.0f));
        source->getLight()->setAmbient(osg::Vec4(0, 0, 0, 1));
        source->getLight()->setDiffuse(surrounding > 0.0f ? osg::Vec4(0.4f, 0.4f, 0.4f, 1) : osg::Vec4(0, 0, 0, 1));
        osg::StateSet& state = *root->getOrCreateStateSet();
        source->setStateSetModes(state, osg::StateAttribute::ON);
        state.setMode(GL_LIGHTING, osg::StateAttribute::ON);
        const osg::ref_ptr<osg::LightModel> ambient = new osg::LightModel;
        ambient->setAmbientIntensity(osg::Vec4(surrounding, surrounding, surrounding, 1));
        state.setAttribute(ambient);
        root->addChild(source);
        root->addChild(subject);
        viewer().setLightingMode(osg::View::NO_LIGHT);
        viewer().getCamera()->setClearColor({1, 0, 0, 1});
        const osg::ref_ptr<osg::Image> image = pictureOf(root, {0.0});
        EXPECT_NO_GL_ERROR();
        return image->getColor(image->s() / 2, image->t() / 2);
    }
};

PbrMaterial glass(float alpha)
{
    PbrMaterial material;
    material.baseColor.set(1, 1, 1, alpha);
    material.metallic = 0.0f;
    material.transmission = 0.8f;
    return material;
}

TEST_F(PbrMaterialEdgesGLTest, materialsThatLookTheSame)
{
    PbrMaterial metalByFactor = glass(1);
    metalByFactor.metallic = 0.0f;
    PbrMaterial metalByMap = glass(1);
    metalByMap.metallic = 1.0f;
    metalByMap.metallicRoughnessMap.texture = plainTexture({1, 1, 0, 1});
    PbrMaterial coated;
    coated.clearcoat = 1.0f;
    coated.clearcoatRoughness = 0.5f;
    coated.clearcoatNormalMap.texture = plainTexture({0.7f, 0.5f, 0.8f, 1});
    PbrMaterial coatedByScale = coated;
    coatedByScale.clearcoatNormalMap.texture = plainTexture({0.9f, 0.5f, 0.8f, 1});
    coatedByScale.clearcoatNormalScale = 0.5f;
    PbrMaterial metal = glass(1);
    metal.metallic = 1.0f;
    metal.baseColor.set(0.5f, 0.3f, 0.4f, 1);
    PbrMaterial opaqueMetal = metal;
    opaqueMetal.transmission = 0.0f;
    const struct
    {
        const char* name;
        PbrMaterial expected, found;
    } cases[] = {{"a metal lets no light through", opaqueMetal, metal},
                 {"what the metal's map lets through", metalByFactor, metalByMap},
                 {"an opaque material with an alpha", glass(1), glass(0.3f)},
                 {"a coat's normal map of half scale", coated, coatedByScale}};
    for (const auto& one : cases)
    {
        const osg::Vec4 expected = middleOf(square(one.expected)), found = middleOf(square(one.found));
        for (int channel = 0; channel < 3; ++channel)
            EXPECT_NEAR(found[channel], expected[channel], 2.0f / 255) << one.name << ", channel " << channel;
    }
    PbrMaterial glowing = glass(1);
    glowing.emissive.set(1, 1, 1);
    EXPECT_GT(middleOf(square(glowing)).g(), 0.98f) << "highlights cover the background";
    PbrMaterial blended = glass(0.3f);
    blended.isBlended = true;
    EXPECT_LT(middleOf(square(blended)).g(), middleOf(square(glass(1))).g() - 0.05f);
}

// Light that passes through is not scattered: half of it is missing. The share of the cover is 1 - 0.96 * 0.5.
TEST_F(PbrMaterialEdgesGLTest, transmittedLightIsNotScattered)
{
    PbrMaterial material;
    material.metallic = material.specular = 0.0f;
    const float scattered = linearColor(middleOf(square(material))).g();
    EXPECT_GT(scattered, 0.2f);
    material.transmission = 0.5f;
    const float shown = displayColor(osg::Vec4(0, 0.5f * scattered / 0.52f, 0, 1)).g();
    EXPECT_NEAR(middleOf(square(material)).g(), 0.52f * shown, 2.0f / 255);
}

TEST_F(PbrMaterialEdgesGLTest, occlusionReachesTheClearCoat)
{
    PbrMaterial material;
    material.baseColor.set(0, 0, 0, 1);
    material.clearcoat = 1.0f;
    const osg::ref_ptr<osg::Group> surroundings = new Environment;
    EXPECT_GT(middleOf(square(material)).g(), 0.1f);
    material.occlusionMap.texture = plainTexture({0, 0, 0, 1});
    surroundings->addChild(square(material));
    EXPECT_LT(middleOf(surroundings, 0.0f).g(), 2.0f / 255);
}

// A coat and fibres over a surface that reflects nothing, towards the studio's key light: the roughness below does not
// count.
TEST_F(PbrMaterialEdgesGLTest, coatAndSheenHaveTheirOwnRoughness)
{
    const auto inStudio = [&](const PbrMaterial& material)
    {
        const osg::ref_ptr<osg::Group> studio = new Environment;
        studio->addChild(square(material, osg::Vec3(0.389f, -1.583f, 0.713f)));
        return middleOf(studio, 0.0f).g();
    };
    PbrMaterial plain;
    plain.baseColor.set(0, 0, 0, 1);
    plain.metallic = 0.0f;
    plain.roughness = 0.2f;
    PbrMaterial coated = plain;
    coated.specular = 0.0f;
    PbrMaterial fibres = coated;
    coated.roughness = 1.0f;
    coated.clearcoat = 1.0f;
    coated.clearcoatRoughness = 0.2f;
    EXPECT_GT(inStudio(plain), 0.3f);
    EXPECT_NEAR(inStudio(coated), inStudio(plain), 3.0f / 255);
    fibres.sheenColor.set(1, 1, 1);
    fibres.sheenRoughness = 1.0f;
    const float smooth = inStudio(fibres);
    fibres.roughness = 1.0f;
    EXPECT_GT(smooth, 0.1f);
    EXPECT_NEAR(inStudio(fibres), smooth, 1.0f / 255);
}

TEST_F(PbrMaterialEdgesGLTest, aNormalOfLengthZeroFacesTheViewer)
{
    for (const bool isInStudio : {false, true})
    {
        const auto middle = [&](const osg::Vec3& normal)
        {
            const osg::ref_ptr<osg::Group> group = isInStudio ? new Environment : new osg::Group;
            group->addChild(square(PbrMaterial(), normal));
            return middleOf(group);
        };
        const osg::Vec4 expected = middle({0, -1, 0}), found = middle({0, 0, 0});
        EXPECT_LT((found - expected).length(), 2.0f / 255) << (isInStudio ? "studio" : "one light");
    }
}

// The scale above surroundings has no effect on their light, even if it is small or different along the axes.
TEST_F(PbrMaterialEdgesGLTest, scalesAboveSurroundingsChangeNoLight)
{
    const auto middle = [&](const osg::Vec3d& scale)
    {
        const osg::ref_ptr<Environment> studio = new Environment;
        studio->setRotation(1.0f);
        PbrMaterial material;
        material.roughness = 0.4f;
        const osg::ref_ptr<osg::MatrixTransform> below = new osg::MatrixTransform(
            osg::Matrix::inverse(osg::Matrix::scale(scale) * osg::Matrix::rotate(0.5, 0, 0, 1)));
        below->addChild(square(material));
        studio->addChild(below);
        const osg::ref_ptr<osg::MatrixTransform> above =
            new osg::MatrixTransform(osg::Matrix::scale(scale) * osg::Matrix::rotate(0.5, 0, 0, 1));
        above->addChild(studio);
        return middleOf(above, 0.0f);
    };
    const osg::Vec4 expected = middle({1, 1, 1});
    EXPECT_GT(expected.g(), 0.1f);
    for (const osg::Vec3d& scale :
         {osg::Vec3d(1e-3, 1e-3, 1e-3), osg::Vec3d(1e-6, 1e-6, 1e-6), osg::Vec3d(0.2, 3, 1), osg::Vec3d(1, 0.001, 40)})
        EXPECT_LT((middle(scale) - expected).length(), 2.0f / 255) << scale.x() << ' ' << scale.y() << ' ' << scale.z();
}

std::string describe(const osg::StateSet& state)
{
    std::string text = "hint " + std::to_string(state.getRenderingHint());
    for (const auto& [name, define] : state.getDefineList())
        text += ", " + name + " " + define.first;
    for (const auto& attribute : state.getAttributeList())
        text += std::string(", ") + attribute.second.first->className();
    for (const auto& [mode, value] : state.getModeList())
        text += ", mode " + std::to_string(mode) + " " + std::to_string(value);
    for (unsigned int unit = 0; unit < state.getTextureAttributeList().size(); ++unit)
        if (state.getTextureAttribute(unit, osg::StateAttribute::TEXTURE)) text += ", map " + std::to_string(unit);
    for (unsigned int unit = 0; unit < state.getTextureModeList().size(); ++unit)
        if (!state.getTextureModeList()[unit].empty()) text += ", mode of unit " + std::to_string(unit);
    return text;
}

/// Everything that a material can have.
PbrMaterial richMaterial()
{
    PbrMaterial material = glass(0.5f);
    material.emissiveStrength = 2.0f;
    material.clearcoat = 1.0f;
    material.sheenColor.set(1, 1, 1);
    material.specular = 0.5f;
    material.isBlended = material.isSpecularGlossiness = material.hasTangents = material.hasMoreCoordinates = true;
    for (PbrMaterial::Map* map :
         {&material.baseColorMap, &material.metallicRoughnessMap, &material.normalMap, &material.occlusionMap,
          &material.emissiveMap, &material.clearcoatMap, &material.sheenColorMap, &material.transmissionMap})
        map->texture = plainTexture({1, 1, 1, 1});
    return material;
}

TEST(PbrMaterialTest, aSecondMaterialReplacesTheFirst)
{
    PbrMaterial mapped;
    mapped.normalMap.texture = plainTexture({0.5f, 0.5f, 1, 1});
    for (const PbrMaterial& second : {PbrMaterial(), mapped, glass(1)})
    {
        const osg::ref_ptr<osg::StateSet> fresh = new osg::StateSet, used = new osg::StateSet;
        applyPbrMaterial(*fresh, second);
        applyPbrMaterial(*used, richMaterial());
        EXPECT_NE(describe(*used), describe(*fresh));
        applyPbrMaterial(*used, second);
        EXPECT_EQ(describe(*used), describe(*fresh));
    }
    // Blending that the application has set stays.
    const osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    state->setMode(GL_BLEND, osg::StateAttribute::ON);
    state->setRenderingHint(osg::StateSet::TRANSPARENT_BIN);
    for (int round = 0; round < 2; ++round)
        applyPbrMaterial(*state, mapped);
    EXPECT_EQ(state->getMode(GL_BLEND), static_cast<osg::StateAttribute::GLModeValue>(osg::StateAttribute::ON));
    EXPECT_EQ(state->getRenderingHint(), osg::StateSet::TRANSPARENT_BIN);
}

TEST(PbrMaterialTest, mapsOfExtensionsWithoutEffectTakeNoTextureUnit)
{
    PbrMaterial material = glass(1);
    for (PbrMaterial::Map* map : {&material.clearcoatMap, &material.clearcoatRoughnessMap, &material.clearcoatNormalMap,
                                  &material.sheenColorMap, &material.transmissionMap})
        map->texture = plainTexture({1, 1, 1, 1});
    const osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    applyPbrMaterial(*state, material);
    EXPECT_EQ(state->getTextureAttribute(16, osg::StateAttribute::TEXTURE), material.transmissionMap.texture);
    EXPECT_EQ(state->getTextureAttribute(17, osg::StateAttribute::TEXTURE), nullptr);
    EXPECT_EQ(state->getDefineList().count("MATERIAL_TRANSMISSION_MAP"), 1u);
    EXPECT_EQ(state->getDefineList().count("MATERIAL_CLEARCOAT_MAP"), 0u);
}

} // namespace

} // namespace osgGpuAnimation
