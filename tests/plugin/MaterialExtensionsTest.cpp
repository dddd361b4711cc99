// SPDX-License-Identifier: MIT
#include "gltf/data/MaterialMaps.h"

#include <gtest/gtest.h>

namespace osgGpuAnimation::gltf
{

namespace
{

using Value = tinygltf::Value;

Value numbers(const std::vector<double>& values)
{
    Value::Array array;
    for (const double value : values)
        array.emplace_back(value);
    return Value(std::move(array));
}

Value texture(int index, int set = 0)
{
    return Value(Value::Object{{"index", Value(index)}, {"texCoord", Value(set)}});
}

} // namespace

TEST(MaterialExtensionsTest, factorsAndMapsOfTheExtensions)
{
    tinygltf::Material material;
    material.extensions["KHR_materials_ior"] = Value(Value::Object{{"ior", Value(2.0)}});
    material.extensions["KHR_materials_specular"] =
        Value(Value::Object{{"specularFactor", Value(0.5)}, {"specularColorFactor", numbers({0.9, 0.6, 0.3})}});
    material.extensions["KHR_materials_clearcoat"] = Value(Value::Object{
        {"clearcoatFactor", Value(0.7)}, {"clearcoatRoughnessFactor", Value(0.2)}, {"clearcoatTexture", texture(3)}});
    material.extensions["KHR_materials_sheen"] =
        Value(Value::Object{{"sheenColorFactor", numbers({0.1, 0.2, 0.3})}, {"sheenRoughnessFactor", Value(0.4)}});
    material.extensions["KHR_materials_transmission"] = Value(Value::Object{{"transmissionFactor", Value(0.8)}});
    PbrMaterial result;
    readMaterialExtensions(material, result);
    EXPECT_NEAR((result.specularColor - osg::Vec3(0.1f, 0.6f / 9, 0.3f / 9)).length(), 0.0f,
                1e-6f); // ((2 - 1) / (2 + 1))^2
    EXPECT_FLOAT_EQ(result.specular, 0.5f);
    EXPECT_FLOAT_EQ(result.clearcoat, 0.7f);
    EXPECT_FLOAT_EQ(result.clearcoatRoughness, 0.2f);
    EXPECT_EQ(result.sheenColor, osg::Vec3(0.1f, 0.2f, 0.3f));
    EXPECT_FLOAT_EQ(result.sheenRoughness, 0.4f);
    EXPECT_FLOAT_EQ(result.transmission, 0.8f);
    const MaterialMaps maps = mapsOf(material, true);
    ASSERT_TRUE(maps.find(&PbrMaterial::clearcoatMap));
    EXPECT_EQ(maps.find(&PbrMaterial::clearcoatMap)->texture, 3);
    EXPECT_FALSE(maps.find(&PbrMaterial::sheenColorMap));
}

TEST(MaterialExtensionsTest, defaultsAreTheSpecifications)
{
    PbrMaterial result;
    readMaterialExtensions(tinygltf::Material(), result);
    EXPECT_EQ(result.specularColor, osg::Vec3(0.04f, 0.04f, 0.04f));
    EXPECT_EQ(result.specular, 1.0f);
    EXPECT_EQ(result.emissiveStrength, 1.0f);
    EXPECT_EQ(result.clearcoat + result.transmission + result.sheenColor.length(), 0.0f);
}

TEST(MaterialExtensionsTest, specularGlossinessIsWhiteAndSmoothByDefault)
{
    tinygltf::Material material;
    material.extensions["KHR_materials_pbrSpecularGlossiness"] = Value(Value::Object{});
    PbrMaterial result;
    readMaterialExtensions(material, result);
    EXPECT_EQ(baseColorOf(material), osg::Vec4(1, 1, 1, 1));
    EXPECT_EQ(result.specularColor, osg::Vec3(1, 1, 1));
    EXPECT_EQ(result.roughness, 0.0f);
    EXPECT_EQ(result.metallic, 0.0f);
}

TEST(MaterialExtensionsTest, specularGlossinessReplacesMetalAndRoughness)
{
    tinygltf::Material material;
    material.pbrMetallicRoughness.baseColorTexture.index = 0;
    material.pbrMetallicRoughness.metallicRoughnessTexture.index = 1;
    material.extensions["KHR_materials_pbrSpecularGlossiness"] =
        Value(Value::Object{{"diffuseFactor", numbers({0.1, 0.2, 0.3, 0.5})},
                            {"specularFactor", numbers({0.4, 0.5, 0.6})},
                            {"glossinessFactor", Value(0.75)},
                            {"diffuseTexture", texture(2)},
                            {"specularGlossinessTexture", texture(3)}});
    PbrMaterial result;
    readMaterialExtensions(material, result);
    EXPECT_EQ(baseColorOf(material), osg::Vec4(0.1f, 0.2f, 0.3f, 0.5f));
    EXPECT_EQ(result.metallic, 0.0f);
    EXPECT_FLOAT_EQ(result.roughness, 0.25f);
    EXPECT_EQ(result.specularColor, osg::Vec3(0.4f, 0.5f, 0.6f));
    EXPECT_TRUE(result.isSpecularGlossiness);
    const MaterialMaps maps = mapsOf(material, true);
    EXPECT_EQ(maps.find(&PbrMaterial::baseColorMap)->texture, 2);
    EXPECT_EQ(maps.find(&PbrMaterial::specularColorMap)->texture, 3);
    EXPECT_FALSE(maps.find(&PbrMaterial::metallicRoughnessMap));
    EXPECT_EQ(mapsOf(material, false).find(&PbrMaterial::baseColorMap)->texture, 2) << "lighting=fixed";
}

// The maps of the clear coat come before those of sheen and transmission.
TEST(MaterialExtensionsTest, mapsOfExtensionsHaveThreeTextureUnitsIfTheyHaveAnEffect)
{
    const struct
    {
        double clearcoat, transmission;
        bool isUnlit;
        MapUse coat, sheen, transmitted;
        bool hasNormalMap;
    } cases[] = {
        {1.0, 1.0, false, MapUse::Shown, MapUse::NoTextureUnit, MapUse::NoTextureUnit, true},
        {0.0, 1.0, false, MapUse::WithoutEffect, MapUse::Shown, MapUse::Shown, false},
        {0.0, 0.0, false, MapUse::WithoutEffect, MapUse::Shown, MapUse::WithoutEffect, false},
        {0.0, 1.0, true, MapUse::WithoutEffect, MapUse::Shown, MapUse::WithoutEffect, false},
    };
    for (const auto& one : cases)
    {
        tinygltf::Material material;
        material.extensions["KHR_materials_clearcoat"] = Value(Value::Object{{"clearcoatFactor", Value(one.clearcoat)},
                                                                             {"clearcoatTexture", texture(0)},
                                                                             {"clearcoatRoughnessTexture", texture(1)},
                                                                             {"clearcoatNormalTexture", texture(2)}});
        material.extensions["KHR_materials_sheen"] =
            Value(Value::Object{{"sheenColorFactor", numbers({0.1, 0.2, 0.3})}, {"sheenColorTexture", texture(3)}});
        material.extensions["KHR_materials_transmission"] =
            Value(Value::Object{{"transmissionFactor", Value(one.transmission)}, {"transmissionTexture", texture(4)}});
        if (one.isUnlit) material.extensions["KHR_materials_unlit"] = Value(Value::Object());
        const MaterialMaps maps = mapsOf(material, true);
        EXPECT_EQ(maps.find(&PbrMaterial::clearcoatNormalMap)->use, one.coat);
        EXPECT_EQ(maps.find(&PbrMaterial::sheenColorMap)->use, one.sheen);
        EXPECT_EQ(maps.find(&PbrMaterial::transmissionMap)->use, one.transmitted);
        EXPECT_EQ(maps.hasNormalMap(), one.hasNormalMap);
    }
}

TEST(MaterialExtensionsTest, theClearCoatsNormalMapHasAScale)
{
    tinygltf::Material material;
    Value::Object map{{"index", Value(0)}, {"scale", Value(0.25)}};
    material.extensions["KHR_materials_clearcoat"] =
        Value(Value::Object{{"clearcoatFactor", Value(1.0)}, {"clearcoatNormalTexture", Value(map)}});
    PbrMaterial result;
    readMaterialExtensions(material, result);
    EXPECT_EQ(result.clearcoatNormalScale, 0.25f);
}

// A vertex has three texture coordinates; the maps of the base colour and the normal come first.
TEST(MaterialExtensionsTest, mapsShareCoordinatesAndTheFourthHasNone)
{
    tinygltf::Material material;
    material.emissiveTexture.index = 5;
    material.emissiveTexture.texCoord = 1;
    material.normalTexture.index = 4;
    material.occlusionTexture.index = 6;
    material.occlusionTexture.texCoord = 3;
    material.pbrMetallicRoughness.metallicRoughnessTexture.index = 7;
    material.pbrMetallicRoughness.metallicRoughnessTexture.texCoord = 2;
    material.extensions["KHR_materials_clearcoat"] =
        Value(Value::Object{{"clearcoatFactor", Value(1.0)}, {"clearcoatTexture", texture(3, 1)}});
    const MaterialMaps maps = mapsOf(material, true);
    EXPECT_EQ(maps.coordinates.size(), MaterialMaps::mostCoordinates);
    EXPECT_EQ(maps.find(&PbrMaterial::normalMap)->number, 0);
    EXPECT_EQ(maps.find(&PbrMaterial::metallicRoughnessMap)->number, 1);
    EXPECT_EQ(maps.find(&PbrMaterial::emissiveMap)->number, 2);
    EXPECT_EQ(maps.find(&PbrMaterial::occlusionMap)->number, -1);
    EXPECT_EQ(maps.find(&PbrMaterial::occlusionMap)->use, MapUse::NoCoordinates);
    EXPECT_EQ(maps.find(&PbrMaterial::clearcoatMap)->number, 2);
}

} // namespace osgGpuAnimation::gltf
