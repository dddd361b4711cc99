// SPDX-License-Identifier: MIT
#include "plugin/ImportedFile.h"
#include "plugin/ModelBuilder.h"
#include "support/ScratchFolder.h"

#include <osgGpuAnimation/looks/shading/PunctualLight.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <osg/CameraView>
#include <osg/LightSource>

namespace osgGpuAnimation::gltf
{

namespace
{

void addLamp(ModelBuilder& file, const std::string& name, const std::vector<double>& place)
{
    tinygltf::Light lamp;
    lamp.type = "point";
    lamp.name = name;
    lamp.color = {1, 1, 1};
    file.model.lights.push_back(lamp);
    const int node = file.node(name);
    file.at(node).translation = place;
    file.at(node).extensions["KHR_lights_punctual"] = tinygltf::Value(
        tinygltf::Value::Object{{"light", tinygltf::Value(static_cast<int>(file.model.lights.size()) - 1)}});
}

/// The nearest seven to the middle in the file's axes, numbered in the file's order.
TEST(ImportedPlacesTest, ofManyLightsTheNearestKeepTheFilesOrder)
{
    ModelBuilder file;
    file.at(file.node("stone", -1, file.triangle())).translation = {0, 100, 0};
    addLamp(file, "left out", {0, 0, 100}); // near the middle of the turned scene
    for (int i = 7; i > 0; --i)
        addLamp(file, std::to_string(i), {0, 100.0 + i, 0});
    const ImportedModel model = imported(file);
    ASSERT_EQ(model.lights.size(), 8u);
    EXPECT_FALSE(model.lights[0].source);
    for (int i = 1; i < 8; ++i)
    {
        const ImportedLight& light = model.lights[static_cast<std::size_t>(i)];
        ASSERT_TRUE(light.source) << i;
        EXPECT_EQ(light.source->getName(), std::to_string(8 - i));
        EXPECT_EQ(light.source->getLight()->getLightNum(), 8 - i);
    }
}

/// A camera's name counts more than its number, which is that of the file, not of the scene.
TEST(ImportedPlacesTest, camerasAreChosenByNameThenByTheFilesNumber)
{
    ModelBuilder file;
    file.node("stone", -1, file.triangle());
    file.model.cameras.resize(4);
    const char* const names[] = {"unused", "3", "film", "plan"};
    for (std::size_t i = 0; i < 4; ++i)
    {
        file.model.cameras[i].name = names[i];
        file.model.cameras[i].type = "perspective";
        file.model.cameras[i].perspective.yfov = 0.5;
        file.model.cameras[i].perspective.znear = 0.1;
    }
    for (const int camera : {2, 3, 1})
        file.at(file.node("tripod")).camera = camera;
    const std::pair<const char*, const char*> cases[] = {{"film", "film"}, {"3", "3"}, {"2", "film"}, {"1", "3"}};
    for (const auto& [wish, expected] : cases)
    {
        ImportOptions options;
        options.camera = wish;
        const ImportedModel model = imported(file, options);
        ASSERT_TRUE(model.startCamera) << wish;
        EXPECT_EQ(model.startCamera->getName(), expected) << wish;
    }
}

/// Numbers of clips are those of the file's animations, those of other files follow; backwards stays backwards.
TEST(ImportedPlacesTest, clipsAreChosenByTheFilesNumber)
{
    ModelBuilder file;
    const int arm = file.node("arm");
    file.animation("faulty");
    file.channel(arm, "translation", {-1, 1}, TINYGLTF_TYPE_VEC3, {0, 0, 0, 1, 0, 0});
    for (const char* name : {"one", "two"})
    {
        file.animation(name);
        file.slide(arm);
    }
    ModelBuilder more;
    const int joint = more.node("arm");
    for (const char* name : {"three", "four"})
    {
        more.animation(name);
        more.slide(joint);
    }
    const ScratchFolder folder;
    folder.write("more.gltf", more.text());
    const std::string path = folder.write("arm.gltf", file.text());
    const std::pair<const char*, const char*> cases[] = {{"1", "one"}, {"2", "two"}, {"3", "three"}, {"4", "four"}};
    for (const auto& [wish, expected] : cases)
    {
        ImportOptions options;
        options.clip = wish;
        options.speed = -2.0;
        options.clipsFiles = {"more.gltf"};
        const Result<ImportedModel> model = importModel(file.text(), path, options);
        ASSERT_TRUE(model) << model.error().message;
        EXPECT_EQ(model.value().animationOfClip, std::vector<int>({1, 2, 3, 4}));
        const AnimationController& controller = model.value().character->getController();
        EXPECT_EQ(controller.set().clips()[static_cast<std::size_t>(controller.clip())].name(), expected) << wish;
        EXPECT_EQ(controller.speed(), -2.0);
    }
}

TEST(ImportedPlacesTest, mapsOfThreeCoordinatesHaveTheirOwn)
{
    ModelBuilder file;
    const int mesh = file.triangle();
    const std::vector<float> sets[] = {
        {0, 0.25f, 1, 0, 0, 1}, {0.5f, 0, 0.125f, 0, 0, 0.75f}, {1, 1, 0, 0.5f, 0.25f, 0}};
    for (std::size_t set = 0; set < 3; ++set)
        file.primitive(mesh).attributes["TEXCOORD_" + std::to_string(set)] = file.floats(TINYGLTF_TYPE_VEC2, sets[set]);
    file.model.textures.resize(1);
    file.model.textures[0].name = "no picture";
    file.model.materials.resize(1);
    tinygltf::Material& material = file.model.materials[0];
    material.emissiveFactor = {0, 0, 0};
    material.pbrMetallicRoughness.baseColorTexture.index = 0;
    material.normalTexture.index = material.occlusionTexture.index = 0;
    material.normalTexture.texCoord = 1;
    material.occlusionTexture.texCoord = 2;
    file.primitive(mesh).material = 0;
    const int node = file.node("stone", -1, mesh);
    const ImportedModel model = imported(file);
    const osg::Geometry& geometry = *primitiveOf(model, node).geometry;
    const auto* const first = dynamic_cast<const osg::Vec2Array*>(geometry.getTexCoordArray(0));
    const auto* const more = dynamic_cast<const osg::Vec4Array*>(geometry.getVertexAttribArray(9));
    ASSERT_TRUE(first && more);
    for (unsigned int vertex = 0; vertex < 3; ++vertex)
        for (unsigned int set = 0; set < 3; ++set)
            for (unsigned int i = 0; i < 2; ++i) // glTF counts v from the top
            {
                const float wanted = i == 0 ? sets[set][2 * vertex] : 1.0f - sets[set][2 * vertex + 1];
                const float found = set == 0 ? (*first)[vertex][static_cast<int>(i)]
                                             : (*more)[vertex][static_cast<int>(2 * (set - 1) + i)];
                EXPECT_EQ(found, wanted) << vertex << ' ' << set << ' ' << i;
            }
}

TEST(ImportedPlacesTest, morphsOfNamelessNodesHaveTheMeshesName)
{
    for (const char* name : {"", "face"})
    {
        ModelBuilder file;
        const int mesh = file.triangle();
        file.model.meshes[0].name = "head";
        file.primitive(mesh).targets = {{{"POSITION", file.floats(TINYGLTF_TYPE_VEC3, std::vector<float>(9))}}};
        file.node(name, -1, mesh);
        const ImportedModel model = imported(file);
        ASSERT_TRUE(model.set);
        EXPECT_EQ(model.set->morphs().at(0).name, *name ? "face" : "head");
    }
}

TEST(ImportedPlacesTest, instancesOfDifferentNumbersAreDrawnOnce)
{
    ModelBuilder file;
    const int stones = file.node("stones", -1, file.triangle());
    const auto attribute = [](int accessor) { return tinygltf::Value(accessor); };
    tinygltf::Value::Object attributes;
    attributes["TRANSLATION"] = attribute(file.floats(TINYGLTF_TYPE_VEC3, {0, 0, 0, 1, 0, 0, 2, 0, 0}));
    attributes["SCALE"] = attribute(file.floats(TINYGLTF_TYPE_VEC3, {1, 1, 1, 2, 2, 2}));
    file.at(stones).extensions["EXT_mesh_gpu_instancing"] =
        tinygltf::Value(tinygltf::Value::Object{{"attributes", tinygltf::Value(attributes)}});
    const ImportedModel model = imported(file);
    ASSERT_EQ(model.messages.warnings.size(), 1u);
    EXPECT_NE(model.messages.warnings[0].find("its attributes differ in count; the mesh is drawn once"),
              std::string::npos)
        << model.messages.warnings[0];
    EXPECT_EQ(primitiveOf(model, stones).geometry->getNumParents(), 1u);
}

} // namespace

} // namespace osgGpuAnimation::gltf
