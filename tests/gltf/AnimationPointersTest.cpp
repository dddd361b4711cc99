// SPDX-License-Identifier: MIT
#include "gltf/ImportedFile.h"
#include "gltf/LoadedDocument.h"
#include "gltf/PointerFile.h"
#include "serializers/StoredScene.h"
#include "support/RandomSet.h"

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/looks/shading/PunctualLight.h>

#include <gtest/gtest.h>
#include <osg/Math>
#include <osg/ValueObject>

#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

using Json = nlohmann::json;

/// Two joints, a mesh with two morph targets under three nodes, one of them with weights of its own, and a clip by
/// path. The first channels animate a transform.
ModelBuilder movingFile(bool isSpline)
{
    ModelBuilder file;
    const int mesh = file.triangle();
    file.primitive(mesh).targets = {file.primitive(mesh).attributes, file.primitive(mesh).attributes};
    file.node("a", -1, mesh);
    file.node("b", 0, mesh);
    file.node("c", 1, mesh);
    file.at(2).weights = {0.25, 0.5};
    file.animation("move");
    const std::vector<float> times = {0, 0.3f, 1};
    const std::string interpolation = isSpline ? "CUBICSPLINE" : "LINEAR";
    const auto numbers = [&](std::size_t components)
    {
        std::vector<float> values;
        for (std::size_t i = 0; i < times.size() * components * (isSpline ? 3 : 1); ++i)
            values.push_back(0.1f + 0.37f * static_cast<float>(i % 7));
        return values;
    };
    file.channel(0, "translation", times, TINYGLTF_TYPE_VEC3, numbers(3), interpolation);
    file.channel(1, "rotation", times, TINYGLTF_TYPE_VEC4, numbers(4), interpolation);
    file.channel(1, "scale", {0, 0.5f}, TINYGLTF_TYPE_VEC3, {1, 2, 3, 4, 5, 6}, "STEP");
    file.channel(2, "weights", times, TINYGLTF_TYPE_SCALAR, numbers(2), interpolation);
    return file;
}

Json target(const std::string& pointer)
{
    return {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}};
}

/// The same with pointers as targets.
Json byPointer(const ModelBuilder& file)
{
    Json made = Json::parse(file.text());
    for (Json& channel : made["animations"][0]["channels"])
        channel["target"] = target("/nodes/" + std::to_string(channel["target"]["node"].get<int>()) + '/' +
                                   channel["target"]["path"].get<std::string>());
    return made;
}

struct Fault
{
    const char* pointer;
    const char* why; ///< part of the only warning
    int type = TINYGLTF_TYPE_VEC3;
    const char* interpolation = "LINEAR";
    std::size_t values = 2; ///< for two times
};

const char* const nothing = "it points to nothing that is drawn";
const char* const visible = "/nodes/0/extensions/KHR_node_visibility/visible";

const Fault faults[] = {
    {"", nothing},
    {"nodes/0/translation", nothing},
    {"/nodes/0", nothing},
    {"/nodes/0/translation/0", nothing},
    {"/nodes/0/translation/", nothing},
    {"/nodes/00/translation", nothing},
    {"/nodes/-1/translation", nothing},
    {"/nodes/99999999999999999999/translation", nothing},
    {"/nodes/0/matrix", nothing},
    {"/nodes/3/translation", "expected an index below 3 of the file's nodes, found 3"},
    {"/nodes/0/translation", "another channel animates it"},
    {"/nodes/2/weights/0", "another channel animates it"},
    {"/nodes/0/weights/2", "expected a weight below 2, found 2"},
    {"/meshes/1/weights", "expected an index below 1 of the file's meshes, found 1"},
    {"/meshes/0/translation", nothing},
    {"/materials/0/name", nothing},
    {"/materials/0/pbrMetallicRoughness/baseColorFactor/0", nothing},
    {"/materials/0/extensions/KHR_materials_iridescence/iridescenceFactor", nothing},
    {"/materials/1/alphaCutoff", "expected an index below 1 of materials, found 1"},
    {"/materials/0/alphaCutoff", "the material's alphaMode is not MASK"},
    {"/materials/0/normalTexture/extensions/KHR_texture_transform/offset", "the material has no such texture"},
    {"/extensions/KHR_lights_punctual/lights/0/color", "expected an index below 0 of extensions.KHR_lights_punctual"},
    {"/cameras/0/perspective/znear", nothing},
    {"/cameras/0/perspective/yfov", "expected an index below 0 of cameras, found 0"},
    {"/nodes/3/extensions/KHR_node_visibility/visible", "expected an index below 3 of nodes, found 3"},
    {"/nodes/1/translation", "expected VEC3 for translation, found VEC4 of float", TINYGLTF_TYPE_VEC4},
    {"/nodes/0/scale", "1 values for each of 2 times, found 3 values", TINYGLTF_TYPE_VEC3, "LINEAR", 3},
    {"/materials/0/emissiveFactor", "expected VEC3 for /materials/0/emissiveFactor", TINYGLTF_TYPE_VEC4},
    {"/materials/0/emissiveFactor", "3 values for each of 2 times", TINYGLTF_TYPE_VEC3, "CUBICSPLINE"},
    {visible, "expected SCALAR of unsigned byte", TINYGLTF_TYPE_SCALAR, "STEP"},
};

/// movingFile() with a material and one more channel of two times.
Json withChannel(const Fault& fault)
{
    ModelBuilder file = movingFile(false);
    file.model.materials.resize(1);
    const auto components = static_cast<std::size_t>(tinygltf::GetNumComponentsInType(std::uint32_t(fault.type)));
    const std::vector<float> values(fault.values * components, 0.5f);
    file.channel(0, "scale", {0, 1}, fault.type, values, fault.interpolation);
    Json made = Json::parse(file.text());
    made["animations"][0]["channels"].back()["target"] = target(fault.pointer);
    return made;
}

/// A factor that goes to these values within a second, and the numbers of the uniform that shows it then.
struct Factor
{
    const char* name;
    std::vector<float> values;
    const char* uniform;
    std::size_t component;
    std::vector<float> expected{}; ///< empty: the values
};

const Factor factors[] = {
    {"pbrMetallicRoughness/baseColorFactor", {0.1f, 0.2f, 0.3f, 0.4f}, "baseColorFactor", 0},
    {"pbrMetallicRoughness/metallicFactor", {0.3f}, "materialFactors", 0},
    {"pbrMetallicRoughness/roughnessFactor", {1.5f}, "materialFactors", 1, {1.0f}},
    {"emissiveFactor", {0.1f, 0.2f, 0.3f}, "emissiveFactor", 0},
    {"alphaCutoff", {0.7f}, "alphaCutoff", 0},
    {"KHR_materials_emissive_strength/emissiveStrength", {7.0f}, "emissiveStrength", 0},
    {"KHR_materials_ior/ior", {3.0f}, "materialSpecular", 0, {0.25f, 0.25f, 0.25f}},
    {"KHR_materials_specular/specularColorFactor", {1, 0.5f, 0.25f}, "materialSpecular", 0, {0.04f, 0.02f, 0.01f}},
    {"KHR_materials_specular/specularFactor", {0.5f}, "materialSpecular", 3},
    {"KHR_materials_clearcoat/clearcoatFactor", {0.5f}, "materialClearcoat", 0},
    {"KHR_materials_sheen/sheenColorFactor", {0.5f, 0.25f, 1.0f}, "materialSheen", 0},
    {"KHR_materials_transmission/transmissionFactor", {0.5f}, "materialTransmission", 0},
};

/// The numbers of a uniform of the character's first mesh from a component on; empty: there is no such uniform.
std::vector<float> uniformOf(AnimatedCharacter& character, const char* name, std::size_t first, std::size_t count)
{
    osg::Uniform* uniform = character.getChild(0)->getStateSet()->getUniform(name);
    const osg::FloatArray* numbers = uniform ? uniform->getFloatArray() : nullptr;
    if (!numbers || numbers->size() < first + count) return {};
    const auto begin = numbers->begin() + static_cast<std::ptrdiff_t>(first);
    return {begin, begin + static_cast<std::ptrdiff_t>(count)};
}

/// Shows the end of the first clip.
void showEnd(AnimatedCharacter& character)
{
    character.getController().setLoopMode(LoopMode::Once);
    ASSERT_TRUE(character.getController().play(0));
    character.getController().seek(character.getController().duration());
    character.update(0.0);
}

/// The numbers of a set's property in a clip at a time, or at rest (-1); empty: there is none.
std::vector<float> valueAt(const AnimationSet& set, const std::string& pointer, double time, int clip = 0)
{
    std::vector<float> all;
    Pose::properties(set, instructionAt(set, clip, time), all);
    std::size_t first = 0;
    for (const MorphWeights& morph : set.morphs())
    {
        if (!morph.isProperty()) continue;
        const auto begin = all.begin() + static_cast<std::ptrdiff_t>(first);
        const auto count = static_cast<std::ptrdiff_t>(morph.defaults.size());
        if (morph.name == pointer) return {begin, begin + count};
        first += morph.defaults.size();
    }
    return {};
}

} // namespace

// The materials of the two files have other orders.
TEST(AnimationPointersTest, clipsOfOtherFilesAnimateObjectsOfTheSameName)
{
    const auto fileOf = [](const std::vector<std::string>& materials, const std::string& clip)
    {
        PointerFile file;
        file.animation(clip);
        for (std::size_t i = 0; i < materials.size(); ++i)
        {
            file.quad("quad " + std::to_string(i), 3.0f * static_cast<float>(i), 0,
                      file.material(materials[i], {1, 1, 1, 1}));
            const float end = materials[i] == "red" ? 0.25f : 0.75f;
            file.animate("/materials/" + std::to_string(i) + "/pbrMetallicRoughness/baseColorFactor",
                         TINYGLTF_TYPE_VEC4, {1, 1, 1, 1, end, 0, 0, 1});
        }
        return file.document().dump();
    };
    const ScratchFolder folder;
    folder.write("clips.gltf", fileOf({"blue", "red", "", "green"}, "other"));
    ImportOptions options;
    options.clipsFiles = {"clips.gltf"};
    const std::string text = fileOf({"red", "blue", "black", "white"}, "own");
    const ImportedModel model = imported(text, options, folder.file("model.gltf"));
    const AnimationSet& set = *model.set;
    ASSERT_EQ(set.clips().size(), 2u);
    for (const auto& [material, red] :
         {std::pair(0, 0.25f), std::pair(1, 0.75f), std::pair(2, 1.0f), std::pair(3, 1.0f)})
    {
        const std::string pointer = "/materials/" + std::to_string(material) + "/pbrMetallicRoughness/baseColorFactor";
        EXPECT_EQ(valueAt(set, pointer, 1.0, 1).at(0), red) << pointer;
    }
    const std::string factor = "/pbrMetallicRoughness/baseColorFactor";
    expectWarnings(model, {"kept at rest", "no counterpart for \"/materials/2" + factor +
                                               " without a name\", \"/materials/3" + factor + " of green\""});
}

TEST(AnimationPointersTest, nodesMoveAsByPathBitByBit)
{
    for (const bool isSpline : {false, true})
    {
        const ModelBuilder file = movingFile(isSpline);
        const ImportedModel path = importedFrom(Json::parse(file.text())), pointer = importedFrom(byPointer(file));
        ASSERT_TRUE(path.set && pointer.set);
        EXPECT_TRUE(haveSameKeyframes(*path.set, *pointer.set));
    }
}

// A mesh's weights drive the nodes without weights of their own; weights one by one, with times of their own, drive the
// same numbers as all together.
TEST(AnimationPointersTest, weightsOfAMeshAndOneByOne)
{
    ModelBuilder file = movingFile(false);
    file.model.animations[0].channels.resize(3);
    file.channel(0, "weights", {0, 1}, TINYGLTF_TYPE_SCALAR, {1, 0, 3, 0});
    file.channel(1, "weights", {0, 1}, TINYGLTF_TYPE_SCALAR, {1, 0, 3, 0});
    Json mesh = Json::parse(file.text());
    mesh["animations"][0]["channels"].erase(4);
    mesh["animations"][0]["channels"][3]["target"] = target("/meshes/0/weights");
    EXPECT_TRUE(haveSameKeyframes(*importedFrom(Json::parse(file.text())).set, *importedFrom(mesh).set));

    file.model.animations[0].channels.resize(3);
    file.channel(2, "weights", {0, 0.5f, 1}, TINYGLTF_TYPE_SCALAR, {1, 7, 2, 6, 3, 5});
    const Json together = Json::parse(file.text());
    file.model.animations[0].channels.resize(3);
    file.channel(2, "translation", {0, 1}, TINYGLTF_TYPE_SCALAR, {1, 3});
    file.channel(2, "scale", {0, 0.5f, 1}, TINYGLTF_TYPE_SCALAR, {7, 6, 5});
    Json single = Json::parse(file.text());
    single["animations"][0]["channels"][3]["target"] = target("/nodes/2/weights/0");
    single["animations"][0]["channels"][4]["target"] = target("/nodes/2/weights/1");
    EXPECT_TRUE(haveSameKeyframes(*importedFrom(together).set, *importedFrom(single).set));
}

TEST(AnimationPointersTest, aFaultCostsItsChannelAloneAndNamesThePointer)
{
    const std::size_t keyframes = importedFrom(Json::parse(movingFile(false).text())).set->clips()[0].keyframeCount();
    for (const Fault& fault : faults)
    {
        SCOPED_TRACE(std::string(fault.pointer) + ": " + fault.why);
        const ImportedModel model = imported(withChannel(fault).dump());
        const bool isOfTarget = fault.type == TINYGLTF_TYPE_VEC3 && fault.values == 2 && *fault.interpolation == 'L';
        expectWarnings(model, {isOfTarget ? "channels[4].target: pointer \"" + std::string(fault.pointer) + "\": "
                                          : "animations[0].samplers[4].output: "});
        expectWarnings(model, {fault.why});
        expectWarnings(model, {"channel ignored"});
        ASSERT_EQ(model.set->clips().size(), 1u);
        EXPECT_EQ(model.set->clips()[0].keyframeCount(), keyframes);
    }
    PointerFile linear;
    linear.quad("quad", 0, 0, -1);
    linear.animation("blink");
    linear.show(0, {1, 0});
    linear.model.animations[0].samplers[0].interpolation = "LINEAR";
    expectAnswer(load(linear.document().dump()), Expect::Warn,
                 "samplers[0].interpolation: expected STEP for /nodes/0/extensions");
}

// One mesh of many nodes, pointed at by many channels.
TEST(AnimationPointersTest, manyPointersToOneMeshEndAtALimit)
{
    Json document = Json::parse(movingFile(false).text());
    for (int i = 0; i < 40000; ++i)
    {
        document["scenes"][0]["nodes"].push_back(document["nodes"].size());
        document["nodes"].push_back({{"mesh", 0}});
    }
    Json& channels = document["animations"][0]["channels"];
    for (const char* pointer : {"/meshes/0/weights/0", "/meshes/0/weights/1", "/meshes/0/weights/0"})
        channels.push_back({{"sampler", channels[3]["sampler"]}, {"target", target(pointer)}});
    const std::string text = load(document.dump()).text();
    for (const char* part : {"the file's pointers move more than 65536 nodes", "another channel animates it"})
    {
        EXPECT_NE(text.find(part), std::string::npos) << part;
        EXPECT_EQ(text.find(part), text.rfind(part)) << "once";
    }
}

// Curves are those of any channel. A group of properties is complete, with the file's values or the defaults.
TEST(AnimationPointersTest, propertiesHaveTheirCurvesAndValuesAtRest)
{
    PointerFile file;
    file.quad("quad", 0, 0, file.material("paint", {0.2, 0.4, 0.6, 1.0}, true));
    file.model.materials[0].emissiveFactor = {0.5, 0.25, 0.0};
    file.animation("all");
    const std::string factors = "/materials/0/pbrMetallicRoughness/";
    file.animate(factors + "metallicFactor", TINYGLTF_TYPE_SCALAR, {0, 1});
    file.animate(factors + "roughnessFactor", TINYGLTF_TYPE_SCALAR, {0.25f, 0.75f}, "STEP");
    file.animate(factors + "baseColorFactor", TINYGLTF_TYPE_VEC4,
                 {0, 0, 0, 0, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "CUBICSPLINE");
    const std::string strength = "/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength";
    file.animate(strength, TINYGLTF_TYPE_SCALAR, {1, 5});
    const ImportedModel model = importedFrom(file.document());
    ASSERT_TRUE(model.set);
    EXPECT_EQ(valueAt(*model.set, factors + "metallicFactor", 0.25), std::vector<float>{0.25f});
    EXPECT_EQ(valueAt(*model.set, factors + "roughnessFactor", 0.75), std::vector<float>{0.25f});
    EXPECT_EQ(valueAt(*model.set, factors + "baseColorFactor", 0.5), (std::vector<float>{0.5f, 0.5f, 0.5f, 0.5f}));
    EXPECT_EQ(valueAt(*model.set, strength, 0.5), std::vector<float>{3.0f});
    EXPECT_EQ(valueAt(*model.set, "/materials/0/emissiveFactor", 0.5), (std::vector<float>{0.5f, 0.25f, 0.0f}));
    EXPECT_EQ(valueAt(*model.set, factors + "baseColorFactor", 0.5, -1), (std::vector<float>{0.2f, 0.4f, 0.6f, 1.0f}));
    EXPECT_EQ(model.set->paletteSize(), 1u) << "no palette entry depends on a property";
}

// Also factors that have no effect at rest, and in copies and variants.
TEST(AnimationPointersTest, everyFactorReachesItsUniform)
{
    for (const Factor& factor : factors)
    {
        SCOPED_TRACE(factor.name);
        PointerFile file;
        file.quad("quad", 0, 0, file.material("paint", {1, 1, 1, 1}, true));
        file.model.materials[0].alphaMode = "MASK";
        file.animation("change");
        std::vector<float> values(factor.values.size(), 0.0f);
        values.insert(values.end(), factor.values.begin(), factor.values.end());
        constexpr int types[] = {TINYGLTF_TYPE_SCALAR, TINYGLTF_TYPE_VEC2, TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC4};
        const std::string name(factor.name), place = name.rfind("KHR_", 0) == 0 ? "extensions/" : "";
        file.animate("/materials/0/" + place + name, types[factor.values.size() - 1], values);
        const ImportedModel model = importedFrom(file.document());
        ASSERT_TRUE(model.character);
        const std::vector<float>& expected = factor.expected.empty() ? factor.values : factor.expected;
        const auto shown = [&](AnimatedCharacter& character)
        { return uniformOf(character, factor.uniform, factor.component, expected.size()); };
        const std::vector<float> atRest = shown(*model.character);
        const osg::ref_ptr<AnimatedCharacter> copy = osg::clone(model.character.get(), osg::CopyOp::SHALLOW_COPY);
        showEnd(*copy);
        ASSERT_EQ(shown(*copy).size(), expected.size());
        for (std::size_t i = 0; i < expected.size(); ++i)
            EXPECT_NEAR(shown(*copy)[i], expected[i], 1e-6f);
        EXPECT_EQ(shown(*model.character), atRest);
        ASSERT_TRUE(copy->getMeshes().setVariant(""));
        copy->update(1.0);
        EXPECT_NEAR(shown(*copy)[0], expected[0], 1e-6f);
    }
}

TEST(AnimationPointersTest, camerasAndLightsFollow)
{
    PointerFile file;
    for (const char* type : {"perspective", "orthographic"})
    {
        tinygltf::Camera camera;
        camera.type = camera.name = type;
        camera.perspective.yfov = camera.perspective.znear = camera.perspective.zfar = 1.0;
        camera.orthographic.xmag = camera.orthographic.ymag = camera.orthographic.zfar = 1.0;
        file.model.cameras.push_back(camera);
        file.at(file.node(type)).camera = static_cast<int>(file.model.cameras.size()) - 1;
    }
    tinygltf::Light light;
    light.type = "spot";
    light.color = {1, 1, 1};
    light.intensity = 1.0;
    file.lamp(light);
    file.animation("change");
    const std::string lamp = "/extensions/KHR_lights_punctual/lights/0/";
    file.animate("/cameras/0/perspective/yfov", TINYGLTF_TYPE_SCALAR, {1, 0.5f});
    file.animate("/cameras/1/orthographic/ymag", TINYGLTF_TYPE_SCALAR, {1, 3});
    file.animate(lamp + "range", TINYGLTF_TYPE_SCALAR, {1, 8});
    file.animate(lamp + "intensity", TINYGLTF_TYPE_SCALAR, {1, 3});
    file.animate(lamp + "color", TINYGLTF_TYPE_VEC3, {1, 1, 1, 0.5f, 0, 1});
    file.animate(lamp + "spot/outerConeAngle", TINYGLTF_TYPE_SCALAR, {0.7f, 0.3f});
    file.animate(lamp + "spot/innerConeAngle", TINYGLTF_TYPE_SCALAR, {0.1f, 0.2f});
    const ImportedModel model = importedFrom(file.document());
    ASSERT_TRUE(model.character);
    const osg::ref_ptr<osg::Light> before = model.lights.at(0).source->getLight();
    showEnd(*model.character);
    EXPECT_NEAR(model.cameras.at(0).view->getFieldOfView(), osg::RadiansToDegrees(0.5), 1e-5);
    double height = 0.0;
    EXPECT_TRUE(model.cameras.at(1).view->getUserValue("orthographicHeight", height));
    EXPECT_NEAR(height, 6.0, 1e-6);
    const auto& shown = dynamic_cast<const PunctualLight&>(*model.lights.at(0).source->getLight());
    EXPECT_EQ(shown.getRange(), 8.0f);
    EXPECT_NEAR(shown.getSpotCutoff(), osg::RadiansToDegrees(0.3f), 1e-4f);
    EXPECT_NEAR(shown.getInnerConeAngle(), osg::RadiansToDegrees(0.2f), 1e-4f);
    EXPECT_NEAR(shown.getDiffuse().x() * static_cast<float>(osg::PI), 1.5f, 1e-6f);
    EXPECT_EQ(shown.getDiffuse().y(), 0.0f);
    EXPECT_EQ(dynamic_cast<const PunctualLight&>(*before).getRange(), 0.0f) << "drawn frames keep their light";
}

namespace
{

using Json = nlohmann::json;

/// The first weight of a morph at the end of a clip.
float weightAtEnd(const ImportedModel& model, std::size_t clip, std::size_t morph)
{
    const Clip& played = model.set->clips().at(clip);
    return played.at(played.keyframeCount() - 1, model.set->firstTrackOfMorph(morph))->number(0);
}

/// Each animation may animate what another one animates, and has its own channels alone.
TEST(SecondVisitsTest, pointersOfOneAnimationAreForgottenInTheNext)
{
    PointerFile file;
    const int mesh = file.triangle();
    file.primitive(mesh).targets = {{{"POSITION", file.floats(TINYGLTF_TYPE_VEC3, std::vector<float>(9, 1.0f))}}};
    file.node("left", -1, mesh);
    file.node("right", -1, mesh);
    file.animation("both");
    file.animate("/meshes/0/weights", TINYGLTF_TYPE_SCALAR, {0, 1});
    file.animation("left");
    file.animate("/nodes/0/weights/0", TINYGLTF_TYPE_SCALAR, {0, 0.5f});
    file.animation("left again");
    file.animate("/nodes/0/weights/0", TINYGLTF_TYPE_SCALAR, {0, 0.25f});
    file.animate("/nodes/0/translation", TINYGLTF_TYPE_VEC3, {0, 0, 0, 3, 0, 0});
    file.animation("both again");
    file.animate("/meshes/0/weights", TINYGLTF_TYPE_SCALAR, {0, 0.75f});
    file.animate("/nodes/0/translation", TINYGLTF_TYPE_VEC3, {0, 0, 0, 5, 0, 0});
    const ImportedModel model = importedFrom(file.document()); // without a warning
    ASSERT_TRUE(model.set);
    ASSERT_EQ(model.set->clips().size(), 4u);
    const float expected[][2] = {{1, 1}, {0.5f, 0}, {0.25f, 0}, {0.75f, 0.75f}};
    for (std::size_t clip = 0; clip < 4; ++clip)
        for (std::size_t morph = 0; morph < 2; ++morph)
            EXPECT_EQ(weightAtEnd(model, clip, morph), expected[clip][morph]) << clip << ' ' << morph;
    const Clip& last = model.set->clips()[3];
    EXPECT_EQ(last.at(last.keyframeCount() - 1, 0)->translation.x, 5.0f);
}

} // namespace

} // namespace osgGpuAnimation::gltf
