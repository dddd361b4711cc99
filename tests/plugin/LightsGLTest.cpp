// SPDX-License-Identifier: MIT
#include "plugin/ImportedFile.h"
#include "plugin/StoredScene.h"
#include "support/ViewerGLTest.h"

#include <osg/Math>
#include <osgUtil/Optimizer>

#include <cmath>
#include <tuple>
#include <utility>

// Pictures of a wall of 8 by 8 units, lit by the file's own lights. A light of glTF shines along its node's -Z, which
// is towards the wall.

namespace osgGpuAnimation::gltf
{

namespace
{

const double pi = osg::PI;

tinygltf::Light light(const std::string& type, double intensity)
{
    tinygltf::Light made;
    made.type = type;
    made.intensity = intensity;
    made.color = {1.0, 1.0, 1.0};
    return made;
}

/// The wall: many small squares, as the fixed pipeline lights vertices.
int wall(ModelBuilder& file)
{
    std::vector<float> positions, normals;
    const auto add = [&](int x, int y)
    {
        positions.insert(positions.end(),
                         {0.25f * static_cast<float>(x) - 4.0f, 0.25f * static_cast<float>(y) - 4.0f, 0});
        normals.insert(normals.end(), {0, 0, 1});
    };
    for (int x = 0; x < 32; ++x)
        for (int y = 0; y < 32; ++y)
        {
            for (const auto& [right, up] : {std::pair(0, 0), std::pair(1, 0), std::pair(0, 1)})
                add(x + right, y + up);
            for (const auto& [right, up] : {std::pair(1, 0), std::pair(1, 1), std::pair(0, 1)})
                add(x + right, y + up);
        }
    return file.mesh({{"POSITION", file.floats(TINYGLTF_TYPE_VEC3, positions)},
                      {"NORMAL", file.floats(TINYGLTF_TYPE_VEC3, normals)}});
}

/// Adds the light below the parent.
int addLight(ModelBuilder& file, const tinygltf::Light& light, const std::vector<double>& place, int parent = -1)
{
    const int node = file.node("lamp", parent);
    file.at(node).translation = place;
    tinygltf::Value::Object members{{"light", tinygltf::Value(static_cast<int>(file.model.lights.size()))}};
    file.at(node).extensions["KHR_lights_punctual"] = tinygltf::Value(members);
    file.model.lights.push_back(light);
    return node;
}

/// The wall, still or drawn from the palette.
ModelBuilder wallFile(bool isMoving = false)
{
    ModelBuilder file;
    const int node = file.node("wall", -1, wall(file));
    if (isMoving) file.animation("hold");
    if (isMoving) file.channel(node, "translation", {0, 1}, TINYGLTF_TYPE_VEC3, {0, 0, 0, 0, 0, 0});
    return file;
}

class LightsGLTest : public ViewerGLTest
{
protected:
    /// A group above the scene with GL's lighting, and no light but the scene's.
    osg::ref_ptr<osg::Group> lit(osg::Node* scene)
    {
        viewer().setLightingMode(osg::View::NO_LIGHT);
        viewer().getCamera()->setViewMatrixAsLookAt({0, 0, 10}, {0, 0, 0}, {0, 1, 0});
        osg::ref_ptr<osg::Group> group = new osg::Group;
        group->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::ON);
        group->addChild(scene);
        return group;
    }

    osg::ref_ptr<osg::Image> pictureOf(osg::Node* scene, const std::vector<double>& times = {0.0})
    {
        const osg::ref_ptr<osg::Image> taken = ViewerGLTest::pictureOf(lit(scene), times);
        EXPECT_NO_GL_ERROR();
        return taken;
    }

    static ImportedModel model(const ModelBuilder& file)
    {
        ImportOptions options;
        options.noRotation = true;
        return imported(file, options);
    }

    osg::ref_ptr<osg::Image> pictureOf(const ModelBuilder& file, const std::vector<double>& times = {0.0})
    {
        return pictureOf(model(file).root, times);
    }

    /// The red of the wall's point.
    static float at(const osg::Image& image, double x, double y)
    {
        const auto pixel = [&](double place) { return static_cast<unsigned int>((place + 4.0) * 8.0); };
        return image.getColor(pixel(x), pixel(y)).x();
    }

    StoredScene files;
};

} // namespace

// Candela per square metre of distance are lux: equal illuminance looks equal, and four times as far takes 16 times.
TEST_F(LightsGLTest, equalIlluminanceLooksEqualWhateverTheLight)
{
    const double lux = 0.5 * pi;
    tinygltf::Light wide = light("spot", 16.0 * lux);
    wide.spot.innerConeAngle = 0.5;
    wide.spot.outerConeAngle = 0.6;
    for (const bool isMoving : {false, true})
    {
        const std::tuple<const char*, tinygltf::Light, double> cases[] = {{"sun", light("directional", lux), 3.0},
                                                                          {"point", light("point", lux), 1.0},
                                                                          {"far", light("point", 16.0 * lux), 4.0},
                                                                          {"spot", wide, 4.0}};
        ModelBuilder dark = wallFile(isMoving);
        const float unlit = at(*pictureOf(dark), 0.0, 0.0);
        float first = -1.0f;
        for (const auto& [name, source, distance] : cases)
        {
            ModelBuilder file = wallFile(isMoving);
            addLight(file, source, {0.0625, 0.0625, distance});
            const float middle = at(*pictureOf(file), 0.0, 0.0);
            if (first < 0.0f) first = middle;
            EXPECT_GT(middle, unlit + 0.2f) << name;
            EXPECT_LT(middle, 0.99f) << name;
            // Vertices of the fixed pipeline are up to 0.18 units beside the pixel.
            EXPECT_NEAR(middle, first, 0.02f) << name << (isMoving ? ", moving" : ", still");
        }
    }
}

TEST_F(LightsGLTest, aSpotLightsItsConeAndColor)
{
    tinygltf::Light narrow = light("spot", 20.0 * pi);
    narrow.spot.outerConeAngle = 0.3; // 1.2 units of the wall from 4 units before it
    narrow.color = {1.0, 0.0, 0.0};
    for (const bool isMoving : {false, true})
    {
        ModelBuilder file = wallFile(isMoving);
        addLight(file, narrow, {1.0, -1.0, 4.0});
        const osg::ref_ptr<osg::Image> picture = pictureOf(file), dark = pictureOf(wallFile(isMoving));
        EXPECT_GT(at(*picture, 1.0, -1.0), at(*dark, 1.0, -1.0) + 0.2f);
        EXPECT_EQ(picture->getColor(40u, 24u).y(), dark->getColor(40u, 24u).y());
        EXPECT_EQ(at(*picture, 3.0, -1.0), at(*dark, 3.0, -1.0));
        EXPECT_EQ(at(*picture, -1.0, 1.0), at(*dark, -1.0, 1.0));
    }
}

// The light is below a node that is no joint, below an animated one: where the node above is, to the left or right.
TEST_F(LightsGLTest, aLightMovesWithItsNodeAndInCopiesToo)
{
    ModelBuilder file = wallFile();
    const int arm = file.node("arm");
    addLight(file, light("point", pi), {-2.0, 0.0, 1.0}, arm);
    file.animation("swing");
    file.channel(arm, "translation", {0, 1}, TINYGLTF_TYPE_VEC3, {0, 0, 0, 4, 0, 0});
    const ImportedModel made = model(file);
    ASSERT_EQ(made.lights.size(), 1u);
    const osg::ref_ptr<osg::Node> copy = osg::clone(made.root.get(), osg::CopyOp::DEEP_COPY_NODES);
    osg::ref_ptr<osg::Image> expected[2];
    for (osg::Node* scene : {static_cast<osg::Node*>(made.root.get()), copy.get()})
    {
        const osg::ref_ptr<osg::Image> before = pictureOf(scene, {0.0});
        const osg::ref_ptr<osg::Image> after = pictureOf(scene, {0.0, 0.999});
        EXPECT_GT(at(*before, -2.0, 0.0), at(*before, 2.0, 0.0) + 0.2f);
        EXPECT_GT(at(*after, 2.0, 0.0), at(*after, -2.0, 0.0) + 0.2f);
        if (!expected[0])
        {
            expected[0] = before;
            expected[1] = after;
        }
        EXPECT_EQ(Picture::pixelsDifferent(*before, *expected[0]), 0);
        EXPECT_EQ(Picture::pixelsDifferent(*after, *expected[1]), 0);
    }
}

TEST_F(LightsGLTest, onlyTheFilesModelIsLit)
{
    ModelBuilder dark = wallFile(), sunny = wallFile();
    sunny.at(0).translation = {100.0, 0.0, 0.0}; // out of sight
    addLight(sunny, light("directional", 0.5 * pi), {0.0, 0.0, 1.0});
    const osg::ref_ptr<osg::Group> both = new osg::Group;
    both->addChild(model(dark).root);
    both->addChild(model(sunny).root);
    const osg::ref_ptr<osg::Image> alone = pictureOf(dark);
    EXPECT_EQ(Picture::pixelsDifferent(*pictureOf(both.get()), *alone), 0);
}

// What applications do to a scene: the Optimizer, and files in OSG's own formats.
TEST_F(LightsGLTest, lightsStayWhereTheyAreThroughToolsAndFiles)
{
    ModelBuilder file = wallFile();
    const int tower = file.node("tower");
    file.at(tower).translation = {1.0, 1.0, 0.0};
    file.at(tower).rotation = {0.0, 0.0, std::sqrt(0.5), std::sqrt(0.5)};
    file.node("roof", tower, file.triangle());
    tinygltf::Light lamp = light("spot", 8.0 * pi);
    lamp.range = 6.0;
    lamp.spot.innerConeAngle = 0.2;
    lamp.spot.outerConeAngle = 0.4;
    // The Optimizer must not flatten its transform into the mesh.
    file.at(addLight(file, lamp, {-2.0, 0.0, 4.0}, tower)).mesh = file.triangle();
    const osg::ref_ptr<osg::Image> expected = pictureOf(file);
    EXPECT_GT(at(*expected, 1.0, -1.0), at(*expected, -2.0, -1.0) + 0.2f);

    const ImportedModel optimized = model(file);
    osgUtil::Optimizer().optimize(optimized.root);
    EXPECT_EQ(Picture::pixelsDifferent(*pictureOf(optimized.root.get()), *expected), 0) << "optimized";
    for (const char* format : {"osgb", "osgt", "osgx"})
    {
        const osg::ref_ptr<osg::Node> stored = files.throughFile(*model(file).root, format);
        ASSERT_TRUE(stored) << format;
        EXPECT_EQ(Picture::pixelsDifferent(*pictureOf(stored.get()), *expected), 0) << format;
    }
}

TEST_F(LightsGLTest, aLightOutsideTheViewStillShines)
{
    ModelBuilder file = wallFile(true);
    addLight(file, light("directional", 0.5 * pi), {500.0, 0.0, 0.0});
    EXPECT_GT(at(*pictureOf(file), 0.0, 0.0), at(*pictureOf(wallFile(true)), 0.0, 0.0) + 0.2f);
}

} // namespace osgGpuAnimation::gltf
