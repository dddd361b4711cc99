// SPDX-License-Identifier: MIT
#include "gltf/scene/Materials.h"
#include "plugin/EncodedPicture.h"
#include "plugin/ModelBuilder.h"

#include <osgGpuAnimation/looks/CharacterProgram.h>

#include <gtest/gtest.h>
#include <osg/AlphaFunc>
#include <osg/CullFace>
#include <osg/Depth>
#include <osg/FrontFace>
#include <osg/LightModel>
#include <osg/Material>

namespace osgGpuAnimation::gltf
{

namespace
{

class MaterialsTest : public ::testing::Test
{
protected:
    MaterialsTest()
        : file(withPictures()), report(messages), textures(file.model, report, false),
          materials(file.model, true, textures, report)
    {
    }

    /// Tests may change material 0. Textures 0 and 1 have a valid picture, texture 2 a damaged one; materials use them.
    static ModelBuilder withPictures()
    {
        ModelBuilder file;
        file.model.materials.resize(3);
        file.model.materials[1].pbrMetallicRoughness.baseColorTexture.index = 0;
        file.model.materials[2].pbrMetallicRoughness.baseColorTexture.index = 2;
        const std::string png = encodedPicture("png", 4, 4);
        file.model.images.resize(2);
        file.model.images[0].image.assign(png.begin(), png.end());
        file.model.images[1].image.assign(png.begin(), png.end() - 20);
        file.model.samplers.resize(1);
        file.model.textures.resize(3);
        file.model.textures[0].source = 0;
        file.model.textures[1].source = 0;
        file.model.textures[1].sampler = 0;
        file.model.textures[2].source = 1;
        return file;
    }

    tinygltf::Material& material() { return file.model.materials[0]; }

    const osg::StateSet& state(
        bool palette, void (*change)(MaterialUse&) = [](MaterialUse&) {})
    {
        MaterialUse use;
        use.material = 0;
        use.palette = palette;
        change(use);
        return *materials.stateSet(use);
    }

    template <typename Attribute>
    static const Attribute* get(const osg::StateSet& state, osg::StateAttribute::Type type)
    {
        return dynamic_cast<const Attribute*>(state.getAttribute(type));
    }

    ModelBuilder file;
    Messages messages;
    Report report;
    Textures textures;
    Materials materials;
};

float uniform(const osg::StateSet& state, const char* name)
{
    float value = -1.0f;
    if (const osg::Uniform* found = state.getUniform(name)) found->get(value);
    return value;
}

bool flag(const osg::StateSet& state, const char* name)
{
    bool value = false;
    if (const osg::Uniform* found = state.getUniform(name)) found->get(value);
    return value;
}

} // namespace

TEST_F(MaterialsTest, theBaseColorIsBroughtToDisplaySpace)
{
    material().pbrMetallicRoughness.baseColorFactor = {1.0, 0.2140411, 0.0, 0.5};
    for (const bool palette : {false, true})
    {
        const auto* surface = get<osg::Material>(state(palette), osg::StateAttribute::MATERIAL);
        ASSERT_TRUE(surface);
        const osg::Vec4 color = surface->getDiffuse(osg::Material::FRONT);
        EXPECT_EQ(color.r(), 1.0f);
        EXPECT_NEAR(color.g(), 0.5f, 1e-5f);
        EXPECT_EQ(color.b(), 0.0f);
        EXPECT_EQ(color.a(), 0.5f);
        EXPECT_EQ(surface->getAmbient(osg::Material::FRONT), color);
    }
}

TEST_F(MaterialsTest, emissionHasAStrength)
{
    material().emissiveFactor = {0.1070205, 0.0, 1.0};
    tinygltf::Value::Object strength;
    strength["emissiveStrength"] = tinygltf::Value(2.0);
    material().extensions["KHR_materials_emissive_strength"] = tinygltf::Value(strength);
    const osg::Vec4 emission =
        get<osg::Material>(state(true), osg::StateAttribute::MATERIAL)->getEmission(osg::Material::FRONT);
    EXPECT_NEAR(emission.r(), 0.5f, 1e-4f);
    EXPECT_EQ(emission.g(), 0.0f);
    EXPECT_EQ(emission.b(), 1.0f);
}

TEST_F(MaterialsTest, alphaModes)
{
    EXPECT_EQ(state(false).getRenderingHint(), osg::StateSet::DEFAULT_BIN);
    EXPECT_EQ(uniform(state(true), "alphaCutoff"), 0.0f);
    material().alphaMode = "MASK";
    material().alphaCutoff = 0.25;
    const auto mirrored = [](MaterialUse& use) { use.mirrored = true; }; // different uses, so that new states are made
    const auto* function = get<osg::AlphaFunc>(state(false, mirrored), osg::StateAttribute::ALPHAFUNC);
    ASSERT_TRUE(function);
    EXPECT_EQ(function->getFunction(), osg::AlphaFunc::GEQUAL);
    EXPECT_EQ(function->getReferenceValue(), 0.25f);
    EXPECT_EQ(uniform(state(true, mirrored), "alphaCutoff"), 0.25f);
    material().alphaMode = "BLEND";
    const osg::StateSet& blend = state(true, [](MaterialUse& use) { use.lit = false; });
    EXPECT_EQ(blend.getRenderingHint(), osg::StateSet::TRANSPARENT_BIN);
    EXPECT_FALSE(get<osg::Depth>(blend, osg::StateAttribute::DEPTH)->getWriteMask());
    EXPECT_EQ(uniform(blend, "alphaCutoff"), 0.0f);
}

TEST_F(MaterialsTest, sidesAndWinding)
{
    EXPECT_EQ(state(false).getMode(GL_CULL_FACE), osg::StateAttribute::ON);
    EXPECT_FALSE(state(false).getAttribute(osg::StateAttribute::FRONTFACE));
    const osg::StateSet& mirrored = state(true, [](MaterialUse& use) { use.mirrored = true; });
    EXPECT_EQ(get<osg::FrontFace>(mirrored, osg::StateAttribute::FRONTFACE)->getMode(), osg::FrontFace::CLOCKWISE);
    material().doubleSided = true;
    const osg::StateSet& both = state(false, [](MaterialUse& use) { use.lit = false; });
    EXPECT_EQ(both.getMode(GL_CULL_FACE), osg::StateAttribute::OFF);
    EXPECT_TRUE(get<osg::LightModel>(both, osg::StateAttribute::LIGHTMODEL)->getTwoSided());
}

TEST_F(MaterialsTest, unlitByExtensionOrForWantOfNormals)
{
    EXPECT_FALSE(flag(state(true), "unlit"));
    EXPECT_EQ(state(false).getMode(GL_LIGHTING), osg::StateAttribute::INHERIT);
    const auto unlit = [](MaterialUse& use) { use.lit = false; };
    EXPECT_TRUE(flag(state(true, unlit), "unlit"));
    EXPECT_EQ(state(false, unlit).getMode(GL_LIGHTING), osg::StateAttribute::OFF);
    material().extensions["KHR_materials_unlit"] = tinygltf::Value(tinygltf::Value::Object());
    EXPECT_TRUE(flag(state(true, [](MaterialUse& use) { use.mirrored = true; }), "unlit"));
}

TEST_F(MaterialsTest, stateIsSharedAndBelongsToItsPipeline)
{
    EXPECT_EQ(&state(true), &state(true));
    EXPECT_NE(&state(true), &state(false));
    EXPECT_EQ(state(true).getAttribute(osg::StateAttribute::PROGRAM), characterProgram());
    EXPECT_FALSE(state(false).getAttribute(osg::StateAttribute::PROGRAM));
    EXPECT_TRUE(materials.stateSet(MaterialUse{})); // the default material
}

TEST_F(MaterialsTest, texturesAreSharedAndSampledAsTheFileSays)
{
    osg::Texture2D* first = textures.texture(0);
    ASSERT_TRUE(first);
    EXPECT_EQ(first->getWrap(osg::Texture::WRAP_S), osg::Texture::REPEAT);
    EXPECT_EQ(first->getFilter(osg::Texture::MIN_FILTER), osg::Texture::LINEAR_MIPMAP_LINEAR);
    EXPECT_EQ(textures.texture(0), first);
    file.model.samplers[0].wrapS = TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    file.model.samplers[0].wrapT = TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT;
    file.model.samplers[0].minFilter = TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR;
    file.model.samplers[0].magFilter = TINYGLTF_TEXTURE_FILTER_NEAREST;
    osg::Texture2D* second = textures.texture(1);
    ASSERT_TRUE(second);
    EXPECT_EQ(second->getImage(), first->getImage());
    EXPECT_EQ(second->getWrap(osg::Texture::WRAP_S), osg::Texture::CLAMP_TO_EDGE);
    EXPECT_EQ(second->getWrap(osg::Texture::WRAP_T), osg::Texture::MIRROR);
    EXPECT_EQ(second->getFilter(osg::Texture::MIN_FILTER), osg::Texture::NEAREST_MIPMAP_LINEAR);
    EXPECT_EQ(second->getFilter(osg::Texture::MAG_FILTER), osg::Texture::NEAREST);
    material().pbrMetallicRoughness.baseColorTexture.index = 1;
    const osg::StateSet& textured = state(true, [](MaterialUse& use) { use.coordinates = 1; });
    EXPECT_EQ(textured.getTextureAttribute(0, osg::StateAttribute::TEXTURE), second);
}

TEST_F(MaterialsTest, aDamagedPictureIsWhiteAndWarnedAboutOnce)
{
    EXPECT_FALSE(textures.texture(2));
    EXPECT_FALSE(textures.texture(2));
    EXPECT_FALSE(textures.texture(-1));
    ASSERT_EQ(messages.warnings.size(), 1u);
    EXPECT_NE(messages.warnings[0].find("images[1]: the picture is damaged"), std::string::npos);
}

} // namespace osgGpuAnimation::gltf
