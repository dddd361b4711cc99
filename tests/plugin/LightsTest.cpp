// SPDX-License-Identifier: MIT
#include "plugin/ImportedFile.h"
#include "plugin/StoredScene.h"

#include <osg/Math>

#include <gtest/gtest.h>

namespace osgGpuAnimation::gltf
{

namespace
{

int addLight(ModelBuilder& file, const tinygltf::Light& light, const std::string& node, double x)
{
    const int made = file.node(node);
    file.at(made).translation = {x, 0.0, 0.0};
    tinygltf::Value::Object members{{"light", tinygltf::Value(static_cast<int>(file.model.lights.size()))}};
    file.at(made).extensions["KHR_lights_punctual"] = tinygltf::Value(members);
    file.model.lights.push_back(light);
    return made;
}

tinygltf::Light light(const std::string& type, const std::string& name = "")
{
    tinygltf::Light made;
    made.type = type;
    made.name = name;
    made.color = {1.0, 0.5, 0.25};
    made.intensity = 3.0;
    return made;
}

const PunctualLight& lightOf(const ImportedLight& imported)
{
    return dynamic_cast<const PunctualLight&>(*imported.source->getLight());
}

/// A triangle and three lights.
ModelBuilder threeLights()
{
    ModelBuilder file;
    file.node("leaf", -1, file.triangle());
    addLight(file, light("directional"), "sun node", 0.0);
    tinygltf::Light bulb = light("point", "bulb");
    bulb.range = 7.0;
    addLight(file, bulb, "", 1.0);
    tinygltf::Light torch = light("spot", "torch");
    torch.spot.innerConeAngle = osg::PI / 12.0;
    torch.spot.outerConeAngle = osg::PI / 6.0;
    addLight(file, torch, "", 2.0);
    return file;
}

} // namespace

TEST(LightsTest, lightsAreOpenGLsFromSevenDown)
{
    const ImportedModel model = imported(threeLights());
    ASSERT_EQ(model.lights.size(), 3u);
    const PunctualLight::Kind kinds[] = {PunctualLight::Kind::Directional, PunctualLight::Kind::Point,
                                         PunctualLight::Kind::Spot};
    const char* const names[] = {"sun node", "bulb", "torch"};
    for (int i = 0; i < 3; ++i)
    {
        const PunctualLight& made = lightOf(model.lights[static_cast<std::size_t>(i)]);
        EXPECT_EQ(made.getLightNum(), 7 - i); // applications begin at 0
        EXPECT_EQ(made.getKind(), kinds[i]);
        EXPECT_EQ(made.getName(), names[i]);
        EXPECT_NEAR(made.getDiffuse().y(), 1.5 / osg::PI, 1e-6);
        EXPECT_EQ(model.root->getStateSet()->getMode(GL_LIGHT7 - static_cast<unsigned int>(i)),
                  osg::StateAttribute::GLModeValue(osg::StateAttribute::ON));
    }
    EXPECT_EQ(lightOf(model.lights[1]).getRange(), 7.0f);
    EXPECT_NEAR(lightOf(model.lights[2]).getInnerConeAngle(), 15.0f, 1e-4f);
    EXPECT_NEAR(lightOf(model.lights[2]).getSpotCutoff(), 30.0f, 1e-4f);
    EXPECT_TRUE(model.messages.warnings.empty());
    EXPECT_TRUE(model.messages.notes.empty());
}

TEST(LightsTest, lightsDoNotCountForTheScenesBounds)
{
    ModelBuilder file = threeLights();
    addLight(file, light("point"), "far", 1e6);
    ImportOptions without;
    without.noLights = true;
    const ImportedModel model = imported(file), dark = imported(file, without);
    EXPECT_EQ(model.root->getBound().radius(), dark.root->getBound().radius());
    EXPECT_TRUE(dark.lights.empty());
    EXPECT_FALSE(dark.root->getStateSet());
}

TEST(LightsTest, ofManyTheNearestSevenAndTheSunRemain)
{
    ModelBuilder file;
    file.at(file.node("leaf", -1, file.triangle())).translation = {50.0, 0.0, 0.0};
    addLight(file, light("directional", "sun"), "", -1e5);
    for (int x = 0; x < 100; x += 10)
        addLight(file, light("point", std::to_string(x)), "", x);
    const ImportedModel model = imported(file);
    std::string kept;
    for (const ImportedLight& made : model.lights)
        if (made.source) kept += made.source->getName() + ' ';
    EXPECT_EQ(kept, "sun 30 40 50 60 70 80 ");
    ASSERT_EQ(model.messages.warnings.size(), 1u);
    EXPECT_NE(model.messages.warnings[0].find("11 lights, OpenGL has 7"), std::string::npos)
        << model.messages.warnings[0];
}

TEST(LightsTest, oneLightAtSeveralNodesIsSeveralLights)
{
    ModelBuilder file = threeLights();
    tinygltf::Value::Object members{{"light", tinygltf::Value(0)}};
    file.at(file.node("second sun")).extensions["KHR_lights_punctual"] = tinygltf::Value(members);
    const ImportedModel model = imported(file);
    ASSERT_EQ(model.lights.size(), 4u);
    EXPECT_EQ(model.lights[3].light, 0);
    EXPECT_EQ(lightOf(model.lights[3]).getLightNum(), 4); // the fourth from 7 down
}

TEST(LightsTest, aLightBeyondFloatNumbersIsLeftOut)
{
    ModelBuilder file = threeLights();
    file.model.lights[0].color = {1e30, 1.0, 1.0};
    file.model.lights[0].intensity = 1e30;
    const ImportedModel model = imported(file);
    ASSERT_EQ(model.messages.warnings.size(), 1u);
    EXPECT_NE(model.messages.warnings[0].find("lights[0]: a light's color or intensity"), std::string::npos)
        << model.messages.warnings[0];
    EXPECT_FALSE(model.lights[0].source);
    EXPECT_EQ(lightOf(model.lights[1]).getLightNum(), 7);
}

// An application may give a light what glTF has no name for: the scene stays readable.
TEST(LightsTest, aStoredLightOfAWiderConeCostsNoScene)
{
    const StoredScene files;
    const ImportedModel model = imported(threeLights());
    osg::LightSource& torch = *model.lights[2].source;
    torch.getLight()->setSpotCutoff(120.0f);
    for (const char* format : {"osgb", "osgt", "osgx"})
    {
        const osg::ref_ptr<osg::Node> stored = files.throughFile(torch, format);
        const auto* source = dynamic_cast<const osg::LightSource*>(stored.get());
        ASSERT_TRUE(source && source->getLight()) << format;
        EXPECT_EQ(source->getLight()->getSpotCutoff(), 120.0f) << format;
        EXPECT_EQ(source->getLight()->getDiffuse(), torch.getLight()->getDiffuse()) << format;
    }
}

// Places are nested like the nodes: as many transforms as nodes, not nodes times their depth.
TEST(LightsTest, lightsBelowOneJointShareTheTransformsAboveThem)
{
    ModelBuilder file = threeLights();
    const int cart = file.node("cart"), mast = file.node("mast", cart), yard = file.node("yard", mast);
    file.at(mast).translation = {0.0, 2.0, 0.0};
    file.at(yard).scale = {0.5, 0.5, 0.5};
    file.animation("go");
    file.slide(cart);
    for (std::size_t lamp = 0; lamp < 2; ++lamp)
    {
        tinygltf::Value::Object members{{"light", tinygltf::Value(1)}};
        const int node = file.node("lamp", yard);
        file.at(node).translation = {0.0, 0.0, 1.0 + static_cast<double>(lamp)};
        file.at(node).extensions["KHR_lights_punctual"] = tinygltf::Value(members);
    }
    ImportOptions options;
    options.noRotation = true;
    const ImportedModel model = imported(file, options);
    ASSERT_EQ(model.lights.size(), 5u);
    const auto yardOf = [&](std::size_t light) { return model.lights[light].source->getParent(0)->getParent(0); };
    EXPECT_EQ(yardOf(3), yardOf(4));
    EXPECT_EQ(yardOf(3)->getName(), "yard");
    EXPECT_EQ(yardOf(3)->getParent(0)->getName(), "mast");
    EXPECT_EQ(model.lights[4].source->getWorldMatrices().front().getTrans(), osg::Vec3d(0.0, 2.0, 1.0));
}

TEST(LightsTest, storedLightsHaveAllTheirValues)
{
    const StoredScene files;
    const ImportedModel model = imported(threeLights());
    for (const ImportedLight& made : model.lights)
    {
        made.source->getLight()->setSpotExponent(7.0f); // the application's own
        for (const char* format : {"osgb", "osgt", "osgx"})
        {
            const osg::ref_ptr<osg::Node> stored = files.throughFile(*made.source, format);
            const auto* source = dynamic_cast<const osg::LightSource*>(stored.get());
            ASSERT_TRUE(source && source->getLight()) << format;
            EXPECT_EQ(source->getLight()->compare(*made.source->getLight()), 0) << format;
            EXPECT_FALSE(source->getBound().valid()) << format;
        }
    }
}

} // namespace osgGpuAnimation::gltf
