// SPDX-License-Identifier: MIT
#include "gltf/scene/Materials.h"
#include "plugin/EncodedPicture.h"
#include "plugin/ImportedFile.h"

#include <osg/Material>

#include <algorithm>
#include <set>

namespace osgGpuAnimation::gltf
{

namespace
{

using Value = tinygltf::Value;

/// Materials of one picture, with the state that a still mesh with those texture coordinates gets.
class MaterialLimitsTest : public ::testing::Test
{
protected:
    MaterialLimitsTest()
    {
        const std::string png = encodedPicture("png", 4, 4);
        file.model.images.resize(1);
        file.model.images[0].image.assign(png.begin(), png.end());
        file.model.textures.resize(1);
        file.model.textures[0].source = 0;
    }

    /// States of all materials, in the file's order.
    std::vector<osg::ref_ptr<osg::StateSet>> states(bool fixedLighting = false)
    {
        Report report(messages);
        Textures textures(file.model, report, !fixedLighting);
        Materials materials(file.model, fixedLighting, textures, report);
        std::vector<osg::ref_ptr<osg::StateSet>> made;
        for (int material = 0; material < static_cast<int>(file.model.materials.size()); ++material)
            for (const bool isMirrored : {false, true}) // two uses of each
            {
                MaterialUse use;
                use.material = material;
                use.coordinates = materials.wantedCoordinates(material);
                use.mirrored = isMirrored;
                if (isMirrored)
                    materials.stateSet(use);
                else
                    made.emplace_back(materials.stateSet(use));
            }
        return made;
    }

    static Value texture(int set = 0) { return Value(Value::Object{{"index", Value(0)}, {"texCoord", Value(set)}}); }

    ModelBuilder file;
    Messages messages;
};

std::string definesOf(const osg::StateSet& state)
{
    std::string text;
    for (const auto& [name, define] : state.getDefineList())
        if (name.compare(0, 9, "MATERIAL_") == 0) text += name + ' ' + define.first + '\n';
    return text;
}

} // namespace

// Each set of maps and coordinate numbers needs programs of its own.
TEST_F(MaterialLimitsTest, aFileHasALimitedNumberOfSetsOfMaps)
{
    for (int set = 0; set < 3 * 3 * 3 * 3 * 2; ++set)
    {
        tinygltf::Material material;
        int rest = set;
        const auto next = [&rest](auto& map, int number)
        {
            if (rest % number > 0) map.index = 0, map.texCoord = rest % number - 1;
            rest /= number;
        };
        material.pbrMetallicRoughness.baseColorTexture.index = 0;
        next(material.normalTexture, 3);
        next(material.occlusionTexture, 3);
        next(material.emissiveTexture, 3);
        next(material.pbrMetallicRoughness.metallicRoughnessTexture, 3);
        if (rest > 0)
            material.extensions["KHR_materials_clearcoat"] = Value(Value::Object{{"clearcoatFactor", Value(0.5)}});
        file.model.materials.push_back(material);
    }
    std::set<std::string> sets;
    for (const osg::ref_ptr<osg::StateSet>& state : states())
    {
        sets.insert(definesOf(*state));
        EXPECT_TRUE(state->getTextureAttribute(0, osg::StateAttribute::TEXTURE));
    }
    EXPECT_EQ(sets.size(), Materials::mostSets);
    ASSERT_EQ(messages.warnings.size(), 1u);
    EXPECT_EQ(messages.warnings[0], "materials: they have more than 64 different sets of maps and extensions; of the "
                                    "others, the base colour map alone is shown");
}

TEST_F(MaterialLimitsTest, eachMaterialWarnsOnceOfTheMapsThatHaveNoRoom)
{
    tinygltf::Material material;
    material.pbrMetallicRoughness.baseColorTexture.index = 0;
    material.normalTexture.index = 0;
    material.normalTexture.texCoord = 1;
    material.emissiveTexture.index = 0;
    material.emissiveTexture.texCoord = 2;
    material.occlusionTexture.index = 0;
    material.occlusionTexture.texCoord = 3;
    material.extensions["KHR_materials_clearcoat"] = Value(Value::Object{{"clearcoatFactor", Value(0.5)},
                                                                         {"clearcoatTexture", texture()},
                                                                         {"clearcoatRoughnessTexture", texture()},
                                                                         {"clearcoatNormalTexture", texture()}});
    material.extensions["KHR_materials_specular"] = Value(Value::Object{{"specularTexture", texture()}});
    file.model.materials = {tinygltf::Material(), material};
    states();
    EXPECT_EQ(messages.warnings,
              (std::vector<std::string>{
                  "materials[1].occlusionTexture: a vertex has room for 3 texture coordinates; left out",
                  "materials[1].specularTexture: a material has room for 3 maps of extensions; left out"}));
}

TEST_F(MaterialLimitsTest, specularGlossinessGivesTheBaseColorInBothLooks)
{
    tinygltf::Material material;
    Value::Array diffuse;
    for (const double channel : {1.0, 0.5, 0.0, 0.25})
        diffuse.emplace_back(channel);
    material.extensions["KHR_materials_pbrSpecularGlossiness"] =
        Value(Value::Object{{"diffuseFactor", Value(diffuse)}, {"diffuseTexture", texture()}});
    file.model.materials = {material};
    const osg::Vec4 linear(1.0f, 0.5f, 0.0f, 0.25f);
    for (const bool fixedLighting : {false, true})
    {
        const osg::ref_ptr<osg::StateSet> state = states(fixedLighting).front();
        const auto& colors = dynamic_cast<const osg::Material&>(*state->getAttribute(osg::StateAttribute::MATERIAL));
        EXPECT_EQ(colors.getDiffuse(osg::Material::FRONT), displayColor(linear)) << fixedLighting;
        EXPECT_TRUE(state->getTextureAttribute(0, osg::StateAttribute::TEXTURE)) << fixedLighting;
        Report report(messages);
        Textures textures(file.model, report, true);
        const Materials materials(file.model, fixedLighting, textures, report);
        EXPECT_EQ(materials.plainColor(osg::Vec4(1, 1, 1, 1), 0), displayColor(linear)) << fixedLighting;
    }
}

// The file's tangents serve the normal map of the clear coat, too. Tangents without a direction serve none.
TEST_F(MaterialLimitsTest, tangentsAreReadForNormalMapsOfTheClearCoat)
{
    for (const auto& [clearcoat, length] : {std::pair(1.0, 1.0f), {0.0, 1.0f}, {1.0, 0.0f}})
    {
        ModelBuilder wall;
        const int mesh = wall.triangle();
        std::map<std::string, int>& attributes = wall.primitive(mesh).attributes;
        attributes["TANGENT"] = wall.floats(TINYGLTF_TYPE_VEC4, {1, 0, 0, 1, length, 0, 0, 1, 1, 0, 0, 1});
        attributes["TEXCOORD_0"] = wall.floats(TINYGLTF_TYPE_VEC2, {0, 0, 1, 0, 0, 1});
        tinygltf::Image picture;
        picture.uri = "missing.png";
        wall.model.images = {picture};
        wall.model.textures = file.model.textures;
        tinygltf::Material material;
        material.extensions["KHR_materials_clearcoat"] =
            Value(Value::Object{{"clearcoatFactor", Value(clearcoat)}, {"clearcoatNormalTexture", texture()}});
        wall.model.materials = {material};
        wall.model.extensionsUsed = {"KHR_materials_clearcoat"};
        wall.primitive(mesh).material = 0;
        const int node = wall.node("wall", -1, mesh);
        const ImportedModel model = imported(wall);
        EXPECT_EQ(primitiveOf(model, node).geometry->getVertexAttribArray(4) != nullptr,
                  clearcoat > 0.0 && length > 0.0f);
        const auto isOfTangents = [](const std::string& text)
        { return text.find("TANGENT: expected directions") != std::string::npos; };
        const std::vector<std::string>& warnings = model.messages.warnings;
        EXPECT_EQ(std::count_if(warnings.begin(), warnings.end(), isOfTangents), length == 0.0f ? 1 : 0);
    }
}

} // namespace osgGpuAnimation::gltf
