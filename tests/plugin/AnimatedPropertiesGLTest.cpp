// SPDX-License-Identifier: MIT
#include "gltf/PointerFile.h"
#include "serializers/StoredScene.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/Math>
#include <osg/MatrixTransform>

#include <string>
#include <vector>

// Pictures of squares whose materials, lights and visibility clips animate. Eight pixels are a unit; the middle of the
// picture is the origin, and glTF's +X and +Y are right and up.

namespace osgGpuAnimation::gltf
{

namespace
{

const char* const baseColor = "/materials/0/pbrMetallicRoughness/baseColorFactor";
const osg::Vec3 red(1, 0, 0), blue(0, 0, 1), green(0, 1, 0);

/// A red square at the origin that turns blue within a second.
PointerFile redToBlue()
{
    PointerFile file;
    file.quad("square", 0, 0, file.material("paint", {1, 0, 0, 1}));
    file.animation("fade");
    file.animate(baseColor, TINYGLTF_TYPE_VEC4, {1, 0, 0, 1, 0, 0, 1, 1});
    return file;
}

class AnimatedPropertiesGLTest : public ViewerGLTest
{
protected:
    void SetUp() override
    {
        ViewerGLTest::SetUp();
        viewer().getCamera()->setClearColor(osg::Vec4(0, 0, 0, 1));
        viewer().setLightingMode(osg::View::NO_LIGHT);
    }

    static void seek(osg::Node& root, double time)
    {
        AnimatedCharacter* character = findCharacter(root);
        ASSERT_TRUE(character);
        character->getController().setLoopMode(LoopMode::Once); // the end is not the beginning
        character->getController().pause();
        character->getController().seek(time);
    }

    osg::ref_ptr<osg::Image> at(osg::Node& root, double time)
    {
        seek(root, time);
        const osg::ref_ptr<osg::Image> taken = pictureOf(&root, {0.0});
        EXPECT_NO_GL_ERROR();
        return taken;
    }

    static osg::Vec3 colorAt(const osg::Image& image, double x, double y)
    {
        const auto pixel = [](double place) { return static_cast<unsigned int>((place + 4.0) * 8.0); };
        const osg::Vec4 color = image.getColor(pixel(x), pixel(y));
        return osg::Vec3(color.x(), color.y(), color.z());
    }

    static bool isNear(const osg::Vec3& a, const osg::Vec3& b) { return (a - b).length() < 0.02f; }

    StoredScene files;
};

/// A copy of a scene with characters of its own, moved along X.
osg::ref_ptr<osg::Group> movedCopy(const osg::Node& root, double x)
{
    osg::ref_ptr<osg::MatrixTransform> moved = new osg::MatrixTransform(osg::Matrix::translate(x, 0, 0));
    moved->addChild(osg::clone(&root, osg::CopyOp::DEEP_COPY_NODES));
    return moved;
}

} // namespace

// Copies, a crowd and the file's own character share all arrays, but none of them sees another's time.
TEST_F(AnimatedPropertiesGLTest, copiesShowTimesOfTheirOwn)
{
    const ImportedModel model = importedFrom(redToBlue().document());
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(model.root);
    osg::ref_ptr<osg::Group> left = movedCopy(*model.root, -2.5), right = movedCopy(*model.root, 2.5);
    scene->addChild(left);
    scene->addChild(right);
    seek(*model.root, 1.0);
    seek(*left, 0.0);
    seek(*right, 0.5);
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*model.character);
    ASSERT_TRUE(crowd->add(osg::Matrix::translate(0, 0, 2.5), model.character->getController()));
    scene->addChild(crowd);
    osg::ref_ptr<osg::Image> taken = pictureOf(scene, {0.0, 0.1});
    EXPECT_NO_GL_ERROR();
    EXPECT_TRUE(isNear(colorAt(*taken, 0, 0), blue));
    EXPECT_TRUE(isNear(colorAt(*taken, -2.5, 0), red));
    EXPECT_TRUE(isNear(colorAt(*taken, 2.5, 0), osg::Vec3(0.735f, 0.0f, 0.735f)));
    EXPECT_TRUE(isNear(colorAt(*taken, 0, 2.5), red)) << "a crowd shows the file's material";
    const auto& own = dynamic_cast<const osg::Geometry&>(*model.character->getChild(0));
    const auto& copied = dynamic_cast<const osg::Geometry&>(*findCharacter(*left)->getChild(0));
    EXPECT_EQ(own.getVertexArray(), copied.getVertexArray());
    EXPECT_EQ(own.getStateSet()->getAttribute(osg::StateAttribute::PROGRAM),
              copied.getStateSet()->getAttribute(osg::StateAttribute::PROGRAM));
    // Linear light is mixed: 0.5 is displayed as 0.735. Half red, half blue: layers mix the values as they mix joints.
    AnimationController& controller = model.character->getController();
    controller.stop();
    ASSERT_TRUE(controller.play(0));
    controller.setLoopMode(LoopMode::Once);
    controller.pause();
    controller.seek(1.0);
    controller.layer(0).setWeight(0.5f);
    taken = pictureOf(scene, {0.2});
    EXPECT_TRUE(isNear(colorAt(*taken, 0, 0), osg::Vec3(0.735f, 0.0f, 0.735f)));
}

// The picture is red above and blue below; half its height further, it is the other way round.
TEST_F(AnimatedPropertiesGLTest, aTextureSlides)
{
    PointerFile file;
    file.quad("square", 0, 0, file.material("paint", {1, 1, 1, 1}));
    file.model.materials[0].pbrMetallicRoughness.baseColorTexture.index = file.texture();
    file.model.textures[0].source = 0;
    file.animation("slide");
    const std::string transform =
        "/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/";
    file.animate(transform + "offset", TINYGLTF_TYPE_VEC2, {0, 0, 0, 0.5f});
    nlohmann::json document = file.document();
    document["images"] = {{{"uri", uriOf(encodedPicture("png", 16, 16))}}};
    const ImportedModel model = importedFrom(document);
    for (const auto& [time, above, below] : {std::tuple(0.0, red, blue), std::tuple(1.0, blue, red)})
    {
        const osg::ref_ptr<osg::Image> taken = at(*model.root, time);
        EXPECT_TRUE(isNear(colorAt(*taken, 0, 0.5), above)) << time;
        EXPECT_TRUE(isNear(colorAt(*taken, 0, -0.5), below)) << time;
    }
    // What the vertices get from a transform that stands still.
    document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"] = {
        {"rotation", 0.4}, {"scale", {0.7, 1.3}}, {"offset", {0.1, 0.2}}};
    nlohmann::json still = document;
    still.erase("animations");
    const ImportedModel turned = importedFrom(document), plain = importedFrom(still);
    findCharacter(*turned.root)->getController().stop();
    const osg::ref_ptr<osg::Image> animated = pictureOf(turned.root, {0.0});
    EXPECT_LE(Picture::pixelsDifferent(*animated, *pictureOf(plain.root, {0.0})), 8); // at the border of the colours
}

// A node hides what is below it, whatever that says of itself.
TEST_F(AnimatedPropertiesGLTest, hiddenNodesHideWhatIsBelow)
{
    PointerFile file;
    const int paint = file.material("paint", {0, 1, 0, 1});
    const int above = file.quad("above", -2.5f, 2, paint), below = file.quad("below", 0, 2, paint, above);
    file.quad("lowest", 2.5f, 2, paint, below);
    const int skinned = file.quad("skinned", -2.5f, -2, paint);
    file.primitive(file.at(skinned).mesh).attributes["JOINTS_0"] =
        file.integers(TINYGLTF_TYPE_VEC4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, std::vector<unsigned int>(16, 0));
    file.primitive(file.at(skinned).mesh).attributes["WEIGHTS_0"] =
        file.floats(TINYGLTF_TYPE_VEC4, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    file.at(skinned).skin = file.skin({file.node("joint")});
    const int still = file.quad("still", 0, -2, paint);
    file.quad("below still", 2.5f, -2, paint, still);
    file.animation("blink");
    file.show(above, {1, 0, 1, 1});
    file.show(below, {1, 1, 0, 1});
    file.show(skinned, {0, 1, 0, 1});
    nlohmann::json document = file.document();
    const nlohmann::json hidden = {{"KHR_node_visibility", {{"visible", false}}}};
    document["nodes"][static_cast<std::size_t>(still)]["extensions"] = hidden;
    document["nodes"][static_cast<std::size_t>(skinned)]["extensions"] = hidden; // at rest
    const ImportedModel model = importedFrom(document);
    const struct
    {
        double time;
        bool above, below, lowest, skinned;
    } cases[] = {{0.5, true, true, true, false},
                 {1.5, false, false, false, true},
                 {2.5, true, false, false, false},
                 {3.0, true, true, true, true}};
    for (const auto& each : cases)
    {
        SCOPED_TRACE(each.time);
        const osg::ref_ptr<osg::Image> taken = at(*model.root, each.time);
        const auto isGreen = [&](double x, double y) { return isNear(colorAt(*taken, x, y), green); };
        EXPECT_EQ(isGreen(-2.5, 2), each.above);
        EXPECT_EQ(isGreen(0, 2), each.below);
        EXPECT_EQ(isGreen(2.5, 2), each.lowest);
        EXPECT_EQ(isGreen(-2.5, -2), each.skinned);
        EXPECT_FALSE(isGreen(0, -2)) << "hidden in all clips";
        EXPECT_FALSE(isGreen(2.5, -2));
    }
    model.character->getController().stop();
    EXPECT_FALSE(isNear(colorAt(*pictureOf(model.root, {0.0}), -2.5, -2), green)) << "hidden at rest";
    EXPECT_GT(model.character->getCurrentBounds().xMax(), 3.4f) << "what is hidden now counts for the bounds";
}

TEST_F(AnimatedPropertiesGLTest, storedScenesKeepItAndShowAgainWhatIsHiddenNow)
{
    tinygltf::Light light; // along -Z
    light.type = "directional";
    light.intensity = osg::PI;
    light.color = {1, 1, 1};
    PointerFile file = redToBlue();
    file.show(file.quad("blinking", 2.5f, 0, 0), {1, 0, 1});
    const int white = file.material("white", {1, 1, 1, 1}, true), wall = file.quad("wall", 0, 2.5f, white);
    file.quad("still", 2.5f, 2.5f, white, wall);
    file.show(wall, {1, 1, 1});
    file.show(file.lamp(light), {1, 0, 1});
    const ImportedModel model = importedFrom(file.document());
    model.root->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::ON);
    at(*model.root, 1.0);
    ASSERT_TRUE(model.character->getMeshes().setVisible("still", false));
    for (const char* format : {"osgb", "osgt", "osgx"})
    {
        SCOPED_TRACE(format);
        at(*model.root, 1.0); // the lamp and the blinking square are hidden as the file is written
        const osg::ref_ptr<osg::Node> stored = files.throughFile(*model.root, format);
        ASSERT_TRUE(stored);
        EXPECT_TRUE(isNear(colorAt(*at(*stored, 0.5), 0, 0), osg::Vec3(0.735f, 0.0f, 0.735f)));
        const osg::ref_ptr<osg::Image> dark = at(*stored, 1.0), lit = at(*stored, 2.0);
        EXPECT_TRUE(isNear(colorAt(*dark, 2.5, 0), osg::Vec3())) << "hidden";
        EXPECT_LT(colorAt(*dark, 0, 2.5).x(), 0.4f) << "ambient light";
        EXPECT_GT(colorAt(*lit, 0, 2.5).x(), 0.8f);
        EXPECT_TRUE(isNear(colorAt(*lit, 2.5, 2.5), osg::Vec3())) << "hidden by the application";
        for (const double time : {0.5, 1.0, 2.0})
        {
            const osg::ref_ptr<osg::Image> expected = at(*model.root, time);
            EXPECT_EQ(Picture::pixelsDifferent(*at(*stored, time), *expected), 0) << time;
        }
    }
}

} // namespace osgGpuAnimation::gltf
