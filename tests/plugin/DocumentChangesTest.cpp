// SPDX-License-Identifier: MIT
#include "plugin/LoadedDocument.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

using Json = nlohmann::json;

/// The base document with one value replaced (removed if empty), and the loader's answer.
struct Change
{
    const char* path;
    const char* value;
    Expect expect;
    const char* message;
};

Json changed(Json document, const Change& change)
{
    const Json::json_pointer at(change.path);
    if (*change.value)
        document[at] = Json::parse(change.value);
    else if (document[at.parent_pointer()].is_array())
        document[at.parent_pointer()].erase(std::stoul(at.back()));
    else
        document[at.parent_pointer()].erase(at.back());
    return document;
}

const Change changes[] = {
    // types and required members
    {"/accessors", "{}", Expect::Refuse, "accessors: expected an array"},
    {"/nodes/0", "null", Expect::Refuse, "nodes[0]: expected an object, found null"},
    {"/nodes/2/mesh", "\"0\"", Expect::Refuse, "nodes[2].mesh: expected an index below 1 of meshes, found \"0\""},
    {"/nodes/2/mesh", "0.5", Expect::Refuse, "nodes[2].mesh"},
    {"/nodes/2/mesh", "-1", Expect::Refuse, "nodes[2].mesh"},
    {"/nodes/2/mesh", "4294967296", Expect::Refuse, "nodes[2].mesh"},
    {"/nodes/2/mesh", "0.0", Expect::Valid, ""},
    {"/nodes/0/name", "7", Expect::Warn, "nodes[0].name: expected a text, found 7"},
    {"/nodes/0/unheardOf", "{\"x\":[1]}", Expect::Valid, ""},
    {"/nodes/0/extras", "[[[null]],1e300]", Expect::Valid, ""},
    {"/nodes/0/children", "[]", Expect::Warn, "nodes[0].children"},
    {"/asset", "", Expect::Refuse, "asset: expected an object, found nothing"},
    {"/asset/version", "\"2\"", Expect::Refuse, "asset.version"},
    {"/asset/version", "\"2.7\"", Expect::Valid, ""},
    {"/asset/minVersion", "\"2.1\"", Expect::Refuse, "asset.minVersion"},
    {"/asset/generator", "[]", Expect::Warn, "asset.generator"},
    {"/extensionsRequired", "[\"EXT_no\"]", Expect::Refuse, "extensionsRequired[0]"},
    {"/extensionsRequired", "[\"EXT_texture_webp\"]", Expect::Valid, ""},
    {"/extensionsRequired", "[\"KHR_materials_mirror\",\"EXT_no\"]", Expect::Refuse, "extensionsRequired[1]"},
    {"/extensionsRequired", "[\"KHR_texture_basisu\"]", Expect::Warn,
     "extensionsRequired[0]: \"KHR_texture_basisu\" is not supported and changes looks alone; left out"},
    {"/extensionsUsed", "[\"EXT_no\"]", Expect::Valid, ""},
    {"/extensionsUsed", "[7]", Expect::Refuse, "extensionsUsed[0]"},
    // buffers and views
    {"/buffers/0/uri", "", Expect::Refuse, "buffers[0]"},
    {"/buffers/0/uri", "7", Expect::Refuse, "buffers[0].uri"},
    {"/buffers/0/uri", "\"x.bin\"", Expect::Refuse, "buffers[0].uri"},
    {"/buffers/0/byteLength", "0", Expect::Refuse, "buffers[0].byteLength"},
    {"/buffers/0/byteLength", "9007199254740991", Expect::Refuse, "buffers[0].byteLength"},
    {"/buffers/0/byteLength", "1e300", Expect::Refuse, "buffers[0].byteLength"},
    {"/buffers/0/byteLength", "20", Expect::Refuse, "bufferViews[0].byteLength"},
    {"/bufferViews/0/buffer", "1", Expect::Refuse, "bufferViews[0].buffer"},
    {"/bufferViews/0/byteOffset", "18446744073709551608", Expect::Refuse, "bufferViews[0].byteOffset"},
    {"/bufferViews/0/byteOffset", "100000", Expect::Refuse, "bufferViews[0].byteOffset"},
    {"/bufferViews/0/byteLength", "100000", Expect::Refuse, "bufferViews[0].byteLength"},
    {"/bufferViews/0/byteStride", "13", Expect::Refuse, "bufferViews[0].byteStride"},
    {"/bufferViews/0/byteStride", "8", Expect::Refuse, "accessors[0]"},
    {"/bufferViews/0/target", "1", Expect::Warn, "bufferViews[0].target"},
    // The last of three positions, 16 bytes apart, ends with the view: no padding follows it.
    {"/bufferViews/0", R"({"buffer":0,"byteLength":44,"byteStride":16})", Expect::Valid, ""},
    {"/bufferViews/0", R"({"buffer":0,"byteLength":43,"byteStride":16})", Expect::Refuse,
     "accessors[0]: expected data within the 43 bytes of bufferViews[0]"},
    // accessors
    {"/accessors/0/count", "1e15", Expect::Refuse, "accessors[0]"},
    {"/accessors/0/count", "0", Expect::Refuse, "accessors[0].count"},
    {"/accessors/0/count", "9007199254740992", Expect::Refuse, "accessors[0].count"},
    {"/accessors/0/componentType", "5130", Expect::Refuse, "accessors[0].componentType"},
    {"/accessors/0/type", "\"VEC5\"", Expect::Refuse, "accessors[0].type"},
    {"/accessors/0/byteOffset", "2", Expect::Refuse, "accessors[0].byteOffset"},
    {"/accessors/0/byteOffset", "4", Expect::Refuse, "accessors[0]"},
    {"/accessors/0/normalized", "1", Expect::Refuse, "accessors[0].normalized"},
    {"/accessors/0/min", "[0]", Expect::Valid, ""}, // not read
    {"/accessors/0/min", "[\"x\"]", Expect::Warn, "accessors[0].min[0]"},
    {"/accessors/0/bufferView", "", Expect::Valid, ""}, // zeros
    {"/accessors/0/sparse", "{}", Expect::Refuse, "accessors[0].sparse.count"},
    {"/accessors/0/sparse", R"({"count":4,"indices":{"bufferView":2,"componentType":5121},"values":{"bufferView":0}})",
     Expect::Refuse, "accessors[0].sparse.count"},
    {"/accessors/0/sparse", R"({"count":2,"indices":{"bufferView":2,"componentType":5126},"values":{"bufferView":0}})",
     Expect::Refuse, "accessors[0].sparse.indices.componentType"},
    {"/accessors/0/sparse", R"({"count":2,"indices":{"bufferView":2,"componentType":5121},"values":{"bufferView":0}})",
     Expect::Valid, ""},
    {"/accessors/0/sparse", R"({"count":3,"indices":{"bufferView":2,"componentType":5121},"values":{"bufferView":0}})",
     Expect::Refuse, "accessors[0].sparse.indices: expected indices that increase"},
    {"/accessors/0/sparse",
     R"({"count":2,"indices":{"bufferView":2,"byteOffset":2,"componentType":5121},"values":{"bufferView":0}})",
     Expect::Refuse, "accessors[0].sparse.indices: expected indices that increase, found 0 after 0"},
    {"/accessors/0/sparse",
     R"({"count":1,"indices":{"bufferView":0,"byteOffset":15,"componentType":5121},"values":{"bufferView":0}})",
     Expect::Refuse, "accessors[0].sparse.indices: expected indices below 3"},
    {"/accessors/0/sparse",
     R"({"count":2,"indices":{"bufferView":2,"componentType":5121},"values":{"bufferView":0,"byteOffset":16}})",
     Expect::Refuse, "accessors[0].sparse.values"},
    // meshes
    {"/meshes/0/primitives", "[]", Expect::Refuse, "meshes[0].primitives"},
    {"/meshes/0/primitives/0/attributes", "", Expect::Refuse, "meshes[0].primitives[0].attributes"},
    {"/meshes/0/primitives/0/attributes", "{}", Expect::Warn, "meshes[0].primitives[0].attributes: expected POSITION"},
    {"/meshes/0/primitives/0/attributes/NORMAL", "4", Expect::Refuse, "attributes.NORMAL: expected VEC3 of float"},
    {"/meshes/0/primitives/0/attributes/TEXCOORD_x", "0", Expect::Warn, "attributes.TEXCOORD_x"},
    {"/meshes/0/primitives/0/attributes/TEXCOORD_2000000000", "0", Expect::Warn, "attributes.TEXCOORD_2000000000"},
    {"/meshes/0/primitives/0/attributes/TEXCOORD_01", "0", Expect::Warn, "attributes.TEXCOORD_01"},
    {"/meshes/0/primitives/0/attributes/COLOR_1", "3", Expect::Warn, "attributes.COLOR_1: the sets before it"},
    {"/meshes/0/primitives/0/attributes/COLOR_0", "3", Expect::Valid, ""},
    {"/meshes/0/primitives/0/attributes/_OWN", "4", Expect::Refuse, "attributes._OWN: expected 3 elements"},
    {"/meshes/0/primitives/0/attributes/_OWN", "3", Expect::Valid, ""},
    {"/meshes/0/primitives/0/attributes/WEIGHTS_0", "", Expect::Refuse, "expected WEIGHTS_0 beside JOINTS_0"},
    {"/meshes/0/primitives/0/attributes/JOINTS_0", "3", Expect::Refuse, "attributes.JOINTS_0"},
    {"/meshes/0/primitives/0/mode", "7", Expect::Refuse, "meshes[0].primitives[0].mode"},
    {"/meshes/0/primitives/0/indices", "0", Expect::Refuse, "meshes[0].primitives[0].indices: expected SCALAR"},
    {"/meshes/0/primitives/0/targets", "[{\"POSITION\":4}]", Expect::Refuse, "targets[0].POSITION"},
    {"/meshes/0/primitives/0/targets", "[{\"POSITION\":0}]", Expect::Valid, ""},
    {"/meshes/0/primitives/0/targets", "[{\"JOINTS_0\":2}]", Expect::Warn, "targets[0].JOINTS_0"},
    {"/meshes/0/weights", "[1]", Expect::Refuse, "meshes[0].weights: expected 0"},
    {"/nodes/2/weights", "[1]", Expect::Refuse, "nodes[2].weights: expected 0"},
    {"/nodes/0/weights", "[1]", Expect::Warn, "nodes[0].weights"},
    // nodes and scenes
    {"/nodes/1/children", "[1]", Expect::Refuse, "nodes[1].children[0]"},
    {"/nodes/1/children", "[0]", Expect::Refuse, "cycle"},
    {"/nodes/2/children", "[1]", Expect::Refuse, "nodes[2].children[0]: expected a node without another parent"},
    {"/nodes/0/matrix", "[1,2]", Expect::Refuse, "nodes[0].matrix: expected 16 numbers, found an array of 2"},
    {"/nodes/0/matrix", "[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,2]", Expect::Warn, "nodes[0].matrix"},
    {"/nodes/2/matrix", "[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]", Expect::Valid, ""},
    {"/nodes/0/translation", "[1,2,1e300]", Expect::Warn, "nodes[0].translation[2]"},
    {"/nodes/0/translation", "[1,2,null]", Expect::Refuse, "nodes[0].translation[2]"},
    {"/nodes/0/rotation", "[0,0,0,0]", Expect::Warn, "nodes[0].rotation"},
    {"/nodes/0/rotation", "[0,0,0,2]", Expect::Warn, "nodes[0].rotation"},
    {"/nodes/0/rotation", "[0,0,0,1.001]", Expect::Valid, ""},
    {"/nodes/0/scale", "[0,0,0]", Expect::Valid, ""},
    {"/nodes/0/camera", "0", Expect::Refuse, "nodes[0].camera"},
    {"/nodes/0/skin", "0", Expect::Warn, "nodes[0].skin: the node has no mesh"},
    {"/scene", "1", Expect::Refuse, "scene: expected an index below 1 of scenes"},
    {"/scenes/0/nodes", "[1]", Expect::Refuse, "scenes[0].nodes[0]: expected a root node"},
    {"/scenes/0/nodes", "[0,0]", Expect::Refuse, "scenes[0].nodes[1]: expected each node once"},
    {"/scenes/0/nodes", "[2]", Expect::Warn, "nodes[2].skin: expected joints in the scene"},
    // skins
    {"/skins/0/joints", "[]", Expect::Refuse, "skins[0].joints"},
    {"/skins/0/joints", "", Expect::Refuse, "skins[0].joints"},
    {"/skins/0/joints", "[0,0]", Expect::Refuse, "skins[0].joints[1]"},
    {"/skins/0/joints", "[0]", Expect::Refuse, "attributes.JOINTS_0: expected joints below 1 of skins[0], found 1"},
    {"/skins/0/joints", "[0,2]", Expect::Warn, "skins[0].joints: expected joints of one tree"},
    {"/skins/0/joints", "[0,1,2]", Expect::Refuse, "skins[0].inverseBindMatrices: expected 3"},
    {"/skins/0/inverseBindMatrices", "0", Expect::Refuse, "skins[0].inverseBindMatrices: expected matrices"},
    {"/skins/0/inverseBindMatrices", "", Expect::Valid, ""},
    // animations
    {"/animations/0/samplers", "", Expect::Refuse, "animations[0].samplers"},
    {"/animations/0/channels", "", Expect::Warn, "animations[0].channels"},
    {"/animations/0/channels/0/sampler", "2", Expect::Refuse, "animations[0].channels[0].sampler"},
    {"/animations/0/channels/0/target", "", Expect::Warn, "animations[0].channels[0].target"},
    {"/animations/0/channels/0/target/path", "\"colour\"", Expect::Warn, "animations[0].channels[0].target.path"},
    {"/animations/0/channels/0/target/node", "", Expect::Valid, ""},
    {"/animations/0/channels/0/target/node", "9", Expect::Refuse, "animations[0].channels[0].target.node"},
    {"/animations/0/channels/0/target/path", "\"rotation\"", Expect::Refuse, "animations[0].samplers[0].output"},
    {"/animations/0/channels/0/target/path", "\"weights\"", Expect::Refuse, "animations[0].samplers[0].output"},
    {"/animations/0/channels/1/target", R"({"node":0,"path":"translation"})", Expect::Warn, "another channel"},
    {"/animations/0/samplers/0/input", "0", Expect::Refuse, "animations[0].samplers[0].input: expected SCALAR"},
    {"/animations/0/samplers/0/output", "0", Expect::Refuse, "1 values for each of 2 times"},
    {"/animations/0/samplers/0/interpolation", "\"CUBICSPLINE\"", Expect::Refuse, "3 values for each of 2 times"},
    {"/animations/0/samplers/0/interpolation", "\"linear\"", Expect::Warn, "animations[0].samplers[0].interpolation"},
    // pictures and materials
    {"/images/0/uri", "\"none.png\"", Expect::Warn, "images[0].uri"},
    {"/images/0/uri", "\"data:image/png;base64,####\"", Expect::Warn, "images[0].uri"},
    {"/images/0/bufferView", "0", Expect::Refuse, "images[0]: expected either uri or bufferView, found both"},
    {"/images/0", "{}", Expect::Refuse, "images[0]: expected either uri or bufferView, found neither"},
    {"/images/0", "{\"bufferView\":0}", Expect::Warn, "images[0].bufferView: expected a PNG, JPEG or WebP"},
    {"/textures/0/source", "1", Expect::Refuse, "textures[0].source"},
    {"/textures/0/source", "", Expect::Valid, ""},
    {"/textures/0/extensions", R"({"EXT_texture_webp":{"source":0}})", Expect::Valid, ""},
    {"/textures/0/extensions", R"({"EXT_texture_webp":{"source":1}})", Expect::Warn,
     "textures[0].extensions.EXT_texture_webp.source: expected an index below 1 of images, found 1"},
    {"/textures/0/extensions", R"({"EXT_texture_webp":7,"KHR_texture_basisu":{}})", Expect::Warn, "EXT_texture_webp"},
    {"/textures/0/extensions", R"({"KHR_texture_basisu":{"source":0}})", Expect::Valid, ""}, // has another source
    {"/textures/0", R"({"extensions":{"KHR_texture_basisu":{"source":0}}})", Expect::Warn,
     "textures[0]: its picture is KTX2 (KHR_texture_basisu), which is not supported; white is shown in its place"},
    {"/textures/0", R"({"extensions":{"MSFT_texture_dds":{"source":0}}})", Expect::Warn, "is DDS (MSFT_texture_dds)"},
    {"/textures/0", R"({"extensions":{"EXT_texture_avif":{"source":0}}})", Expect::Warn, "is AVIF (EXT_texture_avif)"},
    {"/samplers/0/magFilter", "1", Expect::Warn, "samplers[0].magFilter"},
    {"/materials/0/pbrMetallicRoughness/baseColorTexture", "{\"index\":1}", Expect::Warn, "baseColorTexture.index"},
    {"/materials/0/pbrMetallicRoughness/baseColorTexture", "{\"index\":0}", Expect::Warn, "expected TEXCOORD_0"},
    {"/materials/0/pbrMetallicRoughness/baseColorTexture", R"({"index":0,"texCoord":2000000000})", Expect::Warn,
     "baseColorTexture.texCoord"},
    {"/materials/0/pbrMetallicRoughness/baseColorFactor", "[1,1,1]", Expect::Warn, "baseColorFactor"},
    {"/materials/0/pbrMetallicRoughness/baseColorFactor", "[1,1,1,2]", Expect::Warn, "baseColorFactor[3]"},
    {"/materials/0/pbrMetallicRoughness/baseColorFactor", "[1,1,1,1.0000001]", Expect::Valid, ""},
    {"/materials/0/extensions", R"({"KHR_materials_clearcoat":{"clearcoatTexture":{"index":99}}})", Expect::Warn,
     "clearcoatTexture.index: expected an index below 1 of textures, found 99"},
    {"/materials/0/extensions", R"({"KHR_materials_clearcoat":{"clearcoatNormalTexture":{"scale":"x","index":-1}}})",
     Expect::Warn, "clearcoatNormalTexture.index"},
    {"/materials/0/extensions", R"({"KHR_materials_sheen":{"sheenColorTexture":{}}})", Expect::Warn,
     "sheenColorTexture.index"},
    {"/materials/0/alphaMode", "\"GLOW\"", Expect::Warn, "materials[0].alphaMode"},
};

} // namespace

TEST(DocumentChangesTest, AnswersEachChange)
{
    for (const Change& change : changes)
    {
        SCOPED_TRACE(std::string(change.path) + " = " + change.value);
        expectAnswer(load(changed(baseDocument(), change).dump()), change.expect, change.message);
    }
}

TEST(DocumentChangesTest, UnknownExtensionsAreOneNoteEach)
{
    Json document = baseDocument();
    document["extensionsUsed"] = {"EXT_no", "EXT_neither"};
    const LoadedDocument answer = load(document.dump());
    expectAnswer(answer, Expect::Valid, "");
    ASSERT_EQ(answer.messages.notes.size(), 2u);
    EXPECT_NE(answer.messages.notes[0].find("EXT_no"), std::string::npos) << answer.messages.notes[0];
    EXPECT_NE(answer.messages.notes[1].find("EXT_neither"), std::string::npos) << answer.messages.notes[1];
}

TEST(DocumentChangesTest, ExtensionsThatChangeLooksAloneAreOneWarningEach)
{
    Json document = baseDocument();
    document["extensionsRequired"] = {"EXT_materials_mirror", "EXT_texture_avif", "EXT_lights_ies"};
    document["extensionsUsed"] = {"EXT_lights_ies", "EXT_texture_avif", "EXT_materials_mirror", "KHR_xmp_json_ld"};
    const LoadedDocument answer = load(document.dump());
    expectAnswer(answer, Expect::Warn, "extensionsRequired[2]: \"EXT_lights_ies\"");
    EXPECT_EQ(answer.messages.warnings.size(), 4u) << answer.text();
    EXPECT_TRUE(answer.messages.notes.empty());
}

// glTF 2.0, section 3.7.2.1: the largest number of an index type would restart the primitive.
TEST(DocumentChangesTest, theLargestNumberOfAnIndexTypeIsRefused)
{
    const std::pair<int, unsigned int> types[] = {{TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, 255},
                                                  {TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, 65535}};
    for (const auto& [type, largest] : types)
        for (const unsigned int index : {largest - 1, largest})
        {
            ModelBuilder file;
            const int positions = file.floats(TINYGLTF_TYPE_VEC3, std::vector<float>(3 * (largest + 1)));
            const int indices = file.integers(TINYGLTF_TYPE_SCALAR, type, {0, 1, index});
            file.node("leaf", -1, file.mesh({{"POSITION", positions}}, TINYGLTF_MODE_TRIANGLES, indices));
            expectAnswer(load(file.text()), index == largest ? Expect::Refuse : Expect::Valid,
                         index == largest ? "indices below " + std::to_string(largest) : "");
        }
}

} // namespace osgGpuAnimation::gltf
