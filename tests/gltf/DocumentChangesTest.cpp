// SPDX-License-Identifier: MIT
#include "gltf/Import.h"
#include "gltf/LoadedDocument.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

using Json = nlohmann::json;

/// The base document with one value replaced, and the loader's answer: what the files of
/// PluginTest.faultyFilesAnswerAsExpected leave open.
struct Change
{
    const char* path;
    const char* value;
    Expect expect;
    const char* message;
};

/// value: JSON; empty: the member is removed.
Json changed(Json document, const std::string& path, const char* value)
{
    const Json::json_pointer at(path);
    if (*value)
        document[at] = Json::parse(value);
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
    {"/nodes/2/mesh", "0.0", Expect::Valid, ""},
    {"/nodes/0/name", "7", Expect::Warn, "nodes[0].name: expected a text, found 7"},
    {"/nodes/0/unheardOf", "{\"x\":[1]}", Expect::Valid, ""},
    {"/nodes/0/extras", "[[[null]],1e300]", Expect::Valid, ""},
    {"/nodes/0/children", "[]", Expect::Warn, "nodes[0].children"},
    {"/asset", "", Expect::Refuse, "asset: expected an object, found nothing"},
    {"/asset/version", "\"2.7\"", Expect::Valid, ""},
    {"/asset/generator", "[]", Expect::Warn, "asset.generator"},
    {"/extensionsRequired", "[\"EXT_no\"]", Expect::Refuse, "extensionsRequired[0]"},
    {"/extensionsRequired", "[\"EXT_texture_webp\"]", Expect::Valid, ""},
    {"/extensionsRequired", "[\"KHR_materials_mirror\",\"EXT_no\"]", Expect::Refuse, "extensionsRequired[1]"},
    {"/extensionsRequired", "[\"KHR_texture_basisu\"]", Expect::Warn,
     "extensionsRequired[0]: \"KHR_texture_basisu\" is not supported and changes looks alone; left out"},
    {"/extensionsUsed", "[\"EXT_no\"]", Expect::Valid, ""},
    // buffers and views
    {"/bufferViews/0/target", "1", Expect::Warn, "bufferViews[0].target"},
    // The last of three positions, 16 bytes apart, ends with the view: no padding follows it.
    {"/bufferViews/0", R"({"buffer":0,"byteLength":44,"byteStride":16})", Expect::Valid, ""},
    {"/bufferViews/0", R"({"buffer":0,"byteLength":43,"byteStride":16})", Expect::Refuse,
     "accessors[0]: expected data within the 43 bytes of bufferViews[0]"},
    // accessors
    {"/accessors/0/normalized", "1", Expect::Refuse, "accessors[0].normalized"},
    {"/accessors/0/min", "[0]", Expect::Valid, ""}, // not read
    {"/accessors/0/min", "[\"x\"]", Expect::Warn, "accessors[0].min[0]"},
    {"/accessors/0/bufferView", "", Expect::Valid, ""}, // zeros
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
    {"/meshes/0/primitives/0/attributes", "{}", Expect::Warn, "meshes[0].primitives[0].attributes: expected POSITION"},
    {"/meshes/0/primitives/0/attributes/NORMAL", "4", Expect::Refuse, "attributes.NORMAL: expected VEC3 of float"},
    {"/meshes/0/primitives/0/attributes/TEXCOORD_01", "0", Expect::Warn, "attributes.TEXCOORD_01"},
    {"/meshes/0/primitives/0/attributes/COLOR_1", "3", Expect::Warn, "attributes.COLOR_1: the sets before it"},
    {"/meshes/0/primitives/0/attributes/COLOR_0", "3", Expect::Valid, ""},
    {"/meshes/0/primitives/0/attributes/_OWN", "4", Expect::Refuse, "attributes._OWN: expected 3 elements"},
    {"/meshes/0/primitives/0/attributes/_OWN", "3", Expect::Valid, ""},
    {"/meshes/0/primitives/0/attributes/WEIGHTS_0", "", Expect::Refuse, "expected WEIGHTS_0 beside JOINTS_0"},
    {"/meshes/0/primitives/0/indices", "0", Expect::Refuse, "meshes[0].primitives[0].indices: expected SCALAR"},
    {"/meshes/0/primitives/0/targets", "[{\"POSITION\":4}]", Expect::Refuse, "targets[0].POSITION"},
    {"/meshes/0/primitives/0/targets", "[{\"POSITION\":0}]", Expect::Valid, ""},
    {"/meshes/0/primitives/0/targets", "[{\"JOINTS_0\":2}]", Expect::Warn, "targets[0].JOINTS_0"},
    {"/meshes/0/weights", "[1]", Expect::Refuse, "meshes[0].weights: expected 0"},
    {"/nodes/2/weights", "[1]", Expect::Refuse, "nodes[2].weights: expected 0"},
    {"/nodes/0/weights", "[1]", Expect::Warn, "nodes[0].weights"},
    // nodes and scenes
    {"/nodes/1/children", "[0]", Expect::Refuse, "cycle"},
    {"/nodes/2/children", "[1]", Expect::Refuse, "nodes[2].children[0]: expected a node without another parent"},
    {"/nodes/0/matrix", "[1,2]", Expect::Refuse, "nodes[0].matrix: expected 16 numbers, found an array of 2"},
    {"/nodes/0/matrix", "[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,2]", Expect::Warn, "nodes[0].matrix"},
    {"/nodes/2/matrix", "[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]", Expect::Valid, ""},
    {"/nodes/0/translation", "[1,2,1e300]", Expect::Warn, "nodes[0].translation[2]"},
    {"/nodes/0/translation", "[1,2,null]", Expect::Refuse, "nodes[0].translation[2]"},
    {"/nodes/0/rotation", "[0,0,0,1.001]", Expect::Valid, ""},
    {"/nodes/0/extensions", R"({"EXT_mesh_gpu_instancing":{"attributes":{"ROTATION":99}}})", Expect::Refuse,
     "nodes[0].extensions.EXT_mesh_gpu_instancing.attributes.ROTATION"},
    {"/nodes/0/skin", "0", Expect::Warn, "nodes[0].skin: the node has no mesh"},
    {"/scene", "1", Expect::Refuse, "scene: expected an index below 1 of scenes"},
    {"/scenes/0/nodes", "[1]", Expect::Refuse, "scenes[0].nodes[0]: expected a root node"},
    {"/scenes/0/nodes", "[0,0]", Expect::Refuse, "scenes[0].nodes[1]: expected each node once"},
    {"/scenes/0/nodes", "[2]", Expect::Warn, "nodes[2].skin: expected joints in the scene"},
    // skins
    {"/skins/0/joints", "[0]", Expect::Refuse, "attributes.JOINTS_0: expected joints below 1 of skins[0], found 1"},
    {"/skins/0/joints", "[0,2]", Expect::Warn, "skins[0].joints: expected joints of one tree"},
    {"/skins/0/joints", "[0,1,2]", Expect::Refuse, "skins[0].inverseBindMatrices: expected 3"},
    {"/skins/0/inverseBindMatrices", "0", Expect::Refuse, "skins[0].inverseBindMatrices: expected matrices"},
    // animations
    {"/animations/0/channels/0/target/path", "\"rotation\"", Expect::Refuse, "animations[0].samplers[0].output"},
    {"/animations/0/channels/0/target/path", "\"weights\"", Expect::Refuse, "animations[0].samplers[0].output"},
    {"/animations/0/channels/1/target", R"({"node":0,"path":"translation"})", Expect::Warn, "another channel"},
    {"/animations/0/samplers/0/input", "0", Expect::Refuse, "animations[0].samplers[0].input: expected SCALAR"},
    {"/animations/0/samplers/0/output", "0", Expect::Refuse, "1 values for each of 2 times"},
    {"/animations/0/samplers/0/interpolation", "\"CUBICSPLINE\"", Expect::Refuse, "3 values for each of 2 times"},
    // pictures and materials
    {"/images/0/bufferView", "0", Expect::Refuse, "images[0]: expected either uri or bufferView, found both"},
    {"/images/0", "{}", Expect::Refuse, "images[0]: expected either uri or bufferView, found neither"},
    {"/images/0", "{\"bufferView\":0}", Expect::Warn, "images[0].bufferView: expected a PNG, JPEG or WebP"},
    {"/textures/0/extensions", R"({"EXT_texture_webp":{"source":0}})", Expect::Valid, ""},
    {"/textures/0/extensions", R"({"EXT_texture_webp":{"source":1}})", Expect::Warn,
     "textures[0].extensions.EXT_texture_webp.source: expected an index below 1 of images, found 1"},
    {"/textures/0/extensions", R"({"EXT_texture_webp":7,"KHR_texture_basisu":{}})", Expect::Warn, "EXT_texture_webp"},
    {"/textures/0/extensions", R"({"KHR_texture_basisu":{"source":0}})", Expect::Valid, ""}, // has another source
    {"/textures/0", R"({"extensions":{"KHR_texture_basisu":{"source":0}}})", Expect::Warn,
     "textures[0]: its picture is KTX2 (KHR_texture_basisu), which is not supported; white is shown in its place"},
    {"/textures/0", R"({"extensions":{"MSFT_texture_dds":{"source":0}}})", Expect::Warn, "is DDS (MSFT_texture_dds)"},
    {"/textures/0", R"({"extensions":{"EXT_texture_avif":{"source":0}}})", Expect::Warn, "is AVIF (EXT_texture_avif)"},
    {"/materials/0/pbrMetallicRoughness/baseColorTexture", "{\"index\":1}", Expect::Warn, "baseColorTexture.index"},
    {"/materials/0/pbrMetallicRoughness/baseColorTexture", "{\"index\":0}", Expect::Warn, "expected TEXCOORD_0"},
    {"/materials/0/pbrMetallicRoughness/baseColorTexture", R"({"index":0,"texCoord":2000000000})", Expect::Warn,
     "baseColorTexture.texCoord"},
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

const std::string lights = "/extensions/KHR_lights_punctual/lights", node = "/nodes/0/extensions/KHR_lights_punctual",
                  variants = "/extensions/KHR_materials_variants/variants",
                  primitive = "/meshes/0/primitives/0/extensions/KHR_materials_variants";

struct OptionalPart
{
    std::string path;
    const char* value;   ///< see changed()
    const char* message; ///< part of a warning; empty: none
};

/// Changes of richDocument().
const OptionalPart optionalParts[] = {
    {lights + "/0", "null", "lights[0]: expected an object, found null; the element"},
    {lights + "/0/type", "", "lights[0].type: expected a value, found nothing; the element"},
    {lights + "/0/type", "\"sun\"", "lights[0].type"},
    {lights + "/0/color", "[1,1]", "lights[0].color: expected 3 numbers"},
    {lights + "/0/color", "[1,1,-1]", "lights[0].color"},
    {lights + "/0/color", "[1,1,1e300]", "lights[0].color"},
    {lights + "/0/color", "[1,1,\"x\"]", "lights[0].color"},
    {lights + "/0/color", "[2,1,1]", ""},
    {lights + "/0/intensity", "null", "lights[0].intensity: expected a number, found null"},
    {lights + "/0/intensity", "-1", "lights[0].intensity: expected a number from 0"},
    {lights + "/0/intensity", "1e300", "lights[0].intensity"},
    {lights + "/0/intensity", "0", ""},
    {lights + "/0/name", "7", "lights[0].name: expected a text, found 7; left out"},
    {lights + "/1/range", "0", "lights[1].range: expected a number above 0 and up to 3.4"},
    {lights + "/1/spot", "7", "lights[1].spot: expected an object, found 7; left out"}, // of no spot
    {lights + "/2/spot", "", "lights[2].spot: expected an object, found nothing"},
    {lights + "/2/spot/outerConeAngle", "2", "lights[2].spot.outerConeAngle"},
    {lights + "/2/spot/outerConeAngle", "\"x\"", "lights[2].spot.outerConeAngle"},
    {lights + "/2/spot/outerConeAngle", "1.5707963267948966", ""},
    {lights + "/2/spot/innerConeAngle", "0.5", "innerConeAngle: expected an angle below"},
    {lights + "/2/spot/innerConeAngle", "-1", "lights[2].spot.innerConeAngle"},
    {node + "/light", "3", "nodes[0].extensions.KHR_lights_punctual.light: expected"},
    {node + "/light", "-1", "found -1; left out"},
    {node + "/light", "0.5", "an index below 3 of lights, found 0.5"},
    {node, "[]", "nodes[0].extensions.KHR_lights_punctual: expected an object"},
    {node + "/more", "[1,2]", ""},
    {"/cameras/0", "{}", "cameras[0].type: expected a value, found nothing; the element"},
    {"/cameras/0/type", "\"fisheye\"", "cameras[0].type"},
    {"/cameras/0/type", "\"orthographic\"",
     "cameras[0].orthographic: expected the size of the view, found nothing; the element"},
    {"/cameras/0/perspective/yfov", "0",
     "cameras[0].perspective.yfov: expected a number above 0 and up to 3.14159265358979, found 0"},
    {"/cameras/0/perspective/yfov", "4", "cameras[0].perspective.yfov"},
    {"/cameras/0/perspective/yfov", "1e300", "cameras[0].perspective.yfov"},
    {"/cameras/0/perspective/yfov", "null", "cameras[0].perspective.yfov"},
    {"/cameras/0/perspective/znear", "", ""}, // not read
    {"/cameras/1/orthographic/ymag", "0", "cameras[1].orthographic: expected the size of the view, found 0"},
    {"/cameras/1/orthographic/ymag", "-2", ""},
    {variants + "/1", "null", "variants[1]: expected an object, found null; the element"},
    {variants + "/1/name", "7", "variants[1].name: expected a text, found 7"},
    {variants + "/1/extras", "[]", ""},
    {primitive + "/mappings/0", "[]", "mappings[0]: expected an object, found an array of 0; the element"},
    {primitive + "/mappings/0/material", "3", "mappings[0].material: expected an index below 3 of materials"},
    {primitive + "/mappings/0/material", "-1", "mappings[0].material"},
    {primitive + "/mappings/0/material", "0.5", "found 0.5"},
    {primitive + "/mappings/0/variants", "1", "mappings[0].variants: expected an array of at least 0 indices, found 1"},
    {primitive + "/mappings/0/variants", "[4]",
     "mappings[0].variants[0]: expected an index below 4 of variants, found 4"},
    {primitive + "/mappings/0/variants", "[1,\"x\"]", "mappings[0].variants"},
    {primitive + "/mappings/1/variants", "[2,1]", "mappings[1].variants: expected each variant once, found 1 again"},
    {primitive + "/mappings/1/variants", "[2,2]", "found 2 again"},
    {primitive + "/mappings/1/variants", "[]", ""},
    {primitive + "/mappings/1/name", "\"x\"", ""},
};

/// Faults of whole lists, and the remaining lights, cameras and mappings.
const std::pair<OptionalPart, std::size_t> faultyLists[] = {
    {{"/extensions", "7", "extensions: expected an object"}, 2},
    {{"/extensions/KHR_lights_punctual", "7", "KHR_lights_punctual: expected an object, found 7"}, 6},
    {{lights, "{}", "lights: expected an array of at least 1 objects, found an object"}, 6},
    {{"/extensions/KHR_materials_variants", "7", "KHR_materials_variants: expected an object, found 7"}, 5},
    {{variants, "{}", "variants: expected an array of at least 1 objects, found an object"}, 5},
    {{primitive, "7", "meshes[0].primitives[0].extensions.KHR_materials_variants: expected an object"}, 7},
    // One mapping of three; the last one has a variant of the lost one.
    {{primitive + "/mappings",
      R"([{"material":0,"variants":[0,1]},{"material":1,"variants":[2,1]},{"material":2,"variants":[2]}])",
      "mappings[1].variants: expected each variant once, found 1 again"},
     9},
};

std::size_t usableParts(const tinygltf::Model& model)
{
    std::size_t usable = 0;
    for (const tinygltf::Light& light : model.lights)
        usable += light.type.empty() ? 0 : 1;
    for (const tinygltf::Camera& camera : model.cameras)
        usable += camera.type.empty() ? 0 : 1;
    for (const tinygltf::Mesh& mesh : model.meshes)
    {
        const auto found = mesh.primitives[0].extensions.find("KHR_materials_variants");
        if (found == mesh.primitives[0].extensions.end()) continue;
        const tinygltf::Value& mappings = found->second.Get("mappings");
        for (std::size_t i = 0; i < mappings.ArrayLen(); ++i)
            usable += mappings.Get(static_cast<int>(i)).Has("material") ? 1 : 0;
    }
    return usable;
}

/// left: lights, cameras and mappings; 9, or one less where the warning says so.
void expectPart(const OptionalPart& part, std::optional<std::size_t> left = {})
{
    SCOPED_TRACE(part.path + " = " + part.value);
    const Json json = changed(richDocument(), part.path, part.value);
    const LoadedDocument answer = load(json.dump());
    expectAnswer(answer, *part.message == '\0' ? Expect::Valid : Expect::Warn, part.message);
    ASSERT_TRUE(answer.model);
    const bool isOneLost =
        part.path.find(variants) != 0 && answer.text().find("the element is left out") != std::string::npos;
    EXPECT_EQ(usableParts(answer.model.value()), left.value_or(isOneLost ? 8 : 9));
    EXPECT_TRUE(importModel(json.dump(), "", {}));
}

} // namespace

TEST(DocumentChangesTest, answersEachChange)
{
    for (const Change& change : changes)
    {
        SCOPED_TRACE(std::string(change.path) + " = " + change.value);
        expectAnswer(load(changed(baseDocument(), change.path, change.value).dump()), change.expect, change.message);
    }
}

TEST(DocumentChangesTest, aFaultCostsNoMoreThanItsLightCameraOrMapping)
{
    for (const OptionalPart& part : optionalParts)
        expectPart(part);
    for (const auto& [part, left] : faultyLists)
        expectPart(part, left);
}

TEST(DocumentChangesTest, unknownExtensionsAreOneNoteEach)
{
    Json document = baseDocument();
    document["extensionsUsed"] = {"EXT_no", "EXT_neither"};
    const LoadedDocument answer = load(document.dump());
    expectAnswer(answer, Expect::Valid, "");
    ASSERT_EQ(answer.messages.notes.size(), 2u);
    EXPECT_NE(answer.messages.notes[0].find("EXT_no"), std::string::npos) << answer.messages.notes[0];
    EXPECT_NE(answer.messages.notes[1].find("EXT_neither"), std::string::npos) << answer.messages.notes[1];
}

TEST(DocumentChangesTest, extensionsThatChangeLooksAloneAreOneWarningEach)
{
    Json document = baseDocument();
    document["extensionsRequired"] = {"EXT_materials_mirror", "EXT_texture_avif", "EXT_lights_ies"};
    document["extensionsUsed"] = {"EXT_lights_ies", "EXT_texture_avif", "EXT_materials_mirror", "KHR_xmp_json_ld"};
    const LoadedDocument answer = load(document.dump());
    expectAnswer(answer, Expect::Warn, "extensionsRequired[2]: \"EXT_lights_ies\"");
    EXPECT_EQ(answer.messages.warnings.size(), 4u) << answer.text();
    EXPECT_TRUE(answer.messages.notes.empty());
}

} // namespace osgGpuAnimation::gltf
