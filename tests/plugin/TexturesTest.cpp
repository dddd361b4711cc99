// SPDX-License-Identifier: MIT
#include "gltf/scene/Textures.h"
#include "plugin/EncodedPicture.h"
#include "plugin/PackedDocument.h"

#include <gtest/gtest.h>

namespace osgGpuAnimation::gltf
{

namespace
{

/// A texture of an extension, as the document has it.
tinygltf::Value textureInfo(int index)
{
    tinygltf::Value::Object info;
    info["index"] = tinygltf::Value(index);
    return tinygltf::Value(info);
}

/// Textures 0 to 6, of a picture each; two materials use all but the last.
tinygltf::Model manyMaps()
{
    const std::string png = encodedPicture("png", 2, 2);
    tinygltf::Model model;
    model.images.resize(7);
    model.textures.resize(7);
    for (std::size_t i = 0; i < 7; ++i)
    {
        model.images[i].image.assign(png.begin(), png.end());
        model.textures[i].source = static_cast<int>(i);
    }
    model.materials.resize(2);
    model.materials[0].normalTexture.index = 0;
    model.materials[0].occlusionTexture.index = 1;
    model.materials[0].emissiveTexture.index = 2;
    model.materials[1].pbrMetallicRoughness.baseColorTexture.index = 3;
    model.materials[1].pbrMetallicRoughness.metallicRoughnessTexture.index = 4;
    tinygltf::Value::Object coat;
    coat["clearcoatTexture"] = textureInfo(5);
    coat["clearcoatFactor"] = tinygltf::Value(0.5);
    model.materials[1].extensions["KHR_materials_clearcoat"] = tinygltf::Value(coat);
    return model;
}

} // namespace

TEST(TexturesTest, decodesTheMapsThatAreWanted)
{
    const tinygltf::Model model = manyMaps();
    for (const bool allMaps : {true, false})
    {
        Messages messages;
        Report report(messages);
        Textures textures(model, report, allMaps);
        for (int i = 0; i < 7; ++i)
            EXPECT_EQ(textures.texture(i) != nullptr, allMaps ? i < 6 : i == 3) << i << ", all maps: " << allMaps;
        EXPECT_TRUE(messages.warnings.empty());
    }
}

TEST(TexturesTest, oneForEachPictureSamplerAndColorSpace)
{
    tinygltf::Model model = manyMaps();
    model.samplers.resize(1);
    model.textures.resize(100, model.textures[3]); // of one picture
    model.textures[99].sampler = 0;
    Messages messages;
    Report report(messages);
    Textures textures(model, report, true);
    osg::Texture2D* const first = textures.texture(3, ColorSpace::Srgb);
    ASSERT_TRUE(first);
    for (int i = 7; i < 99; ++i)
        EXPECT_EQ(textures.texture(i, ColorSpace::Srgb), first) << i;
    EXPECT_NE(textures.texture(99, ColorSpace::Srgb), first);
    EXPECT_NE(textures.texture(3, ColorSpace::Linear), first);
    EXPECT_EQ(textures.texture(99, ColorSpace::Srgb)->getImage(), first->getImage());
}

TEST(TexturesTest, theSourceOfAnExtensionIsPreferredIfItIsWebp)
{
    struct Case
    {
        const char* extension;
        std::string picture;
        int width; ///< of the picture that is shown
    };
    const Case cases[] = {{"EXT_texture_webp", encodedPicture("webp", 2, 2), 2},
                          {"KHR_texture_basisu", "\xabKTX 20\xbb\r\n\x1a\n", 4}};
    for (const Case& source : cases)
    {
        SCOPED_TRACE(source.extension);
        PackedDocument document;
        for (const std::string& picture : {encodedPicture("png", 4, 4), source.picture})
            document.json["images"].push_back({{"bufferView", document.addView(picture)}});
        document.json["textures"] = {{{"source", 0}, {"extensions", {{source.extension, {{"source", 1}}}}}}};
        document.json["materials"] = {{{"emissiveTexture", {{"index", 0}}}}};
        Messages messages;
        const Result<tinygltf::Model> model = document.load(messages);
        ASSERT_TRUE(model) << model.error().message;
        Report report(messages);
        Textures textures(model.value(), report, true);
        ASSERT_TRUE(textures.texture(0));
        EXPECT_EQ(textures.texture(0)->getImage()->s(), source.width);
        EXPECT_TRUE(messages.warnings.empty());
    }
}

} // namespace osgGpuAnimation::gltf
