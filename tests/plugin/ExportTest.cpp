// SPDX-License-Identifier: MIT
#include "gltf/data/Picture.h"
#include "gltf/write/ClipKeys.h"
#include "gltf/write/PictureWriter.h"
#include "plugin/ModelBuilder.h"
#include "plugin/RoundTrip.h"
#include "plugin/StoredScene.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>
#include <osgGpuAnimation/looks/shading/PunctualLight.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/CameraView>
#include <osg/Geode>
#include <osg/LightSource>
#include <osg/Material>
#include <osg/MatrixTransform>

#include <cstring>

namespace osgGpuAnimation::gltf
{

namespace
{

using Warnings = std::vector<std::string>;

osg::ref_ptr<osg::Group> sceneOf(const ModelBuilder& file)
{
    const Result<ImportedModel> model = importModel(file.text(), "", {});
    EXPECT_TRUE(model) << model.error().message;
    return model ? model.value().root : nullptr;
}

/// An arm with a rigid sword, a triangle skinned by arm and hand, a morphing flag, a still stone, and a light and a
/// camera on the hand and on the stone; clips of all interpolations, with a jump, and one that moves nothing.
ModelBuilder armFile()
{
    ModelBuilder file;
    const int arm = file.node("arm");
    file.at(arm).rotation = {0.0, 0.0, 0.6, 0.8};
    const int sword = file.node("sword", arm, file.triangle());
    file.at(sword).scale = {1.0, 2.0, -1.0};
    const int hand = file.node("hand", arm);
    file.at(hand).translation = {0, 2, 0};
    const int finger = file.node("finger", hand);
    const int skinned = file.node("skinned", -1, file.skinnedTriangle());
    file.at(skinned).skin = file.skin({arm, hand});
    const int flag = file.triangle();
    for (const float height : {1.0f, 3.0f})
        file.primitive(flag).targets.push_back(
            {{"POSITION", file.floats(TINYGLTF_TYPE_VEC3, {0, 0, height, 0, 0, 0, 0, height, 0})}});
    const int flagNode = file.node("flag", finger, flag);
    file.at(flagNode).weights = {0.25, 0.0};
    const int stone = file.node("stone", -1, file.triangle());
    file.at(stone).translation = {5, 0, 0};
    tinygltf::Light lamp;
    lamp.type = "spot";
    lamp.name = "lamp";
    lamp.color = {1.0, 0.5, 0.25};
    lamp.intensity = 3.0;
    lamp.range = 20.0;
    lamp.spot.outerConeAngle = 0.5;
    file.model.lights.push_back(lamp);
    file.at(hand).extensions["KHR_lights_punctual"] =
        tinygltf::Value(tinygltf::Value::Object{{"light", tinygltf::Value(0)}});
    file.model.cameras.resize(1);
    file.model.cameras[0].type = "perspective";
    file.model.cameras[0].name = "eye";
    file.model.cameras[0].perspective.yfov = 0.7;
    file.model.cameras[0].perspective.znear = 0.1;
    file.at(stone).camera = 0;

    file.animation("wave");
    file.channel(arm, "translation", {0, 1, 2}, TINYGLTF_TYPE_VEC3, {0, 0, 0, 5, 0, 0, 5, 1, 0});
    file.channel(hand, "rotation", {0.25f, 1.75f}, TINYGLTF_TYPE_VEC4, {0, 0, 0, 1, 0.6f, 0, 0, 0.8f});
    file.channel(finger, "translation", {0, 0.5f, 1.5f}, TINYGLTF_TYPE_VEC3, {0, 0, 0, 0, 3, 0, 1, 0, 0}, "STEP");
    file.model.animations.back().extras = tinygltf::Value(tinygltf::Value::Object{
        {"markers", tinygltf::Value(tinygltf::Value::Array{tinygltf::Value(tinygltf::Value::Object{
                        {"time", tinygltf::Value(0.7)}, {"name", tinygltf::Value(std::string("hit"))}})})}});
    file.animation("bend");
    file.channel(hand, "rotation", {0, 1, 3}, TINYGLTF_TYPE_VEC4,
                 {0, 0,    0, 0, 0, 0, 0, 1, 0.5f, 0, 0, 0, 0, 0.3f, 0, 0, 0.6f, 0,
                  0, 0.8f, 0, 0, 1, 0, 0, 0, 0,    0, 0, 0, 0, 1,    0, 0, 0,    0},
                 "CUBICSPLINE");
    file.channel(arm, "scale", {0, 0.4f, 1.1f, 2}, TINYGLTF_TYPE_VEC3, {1, 1, 1, 2, 1, 1, 1, 1, 1, 3, 1, 1});
    file.channel(flagNode, "weights", {0.5f, 2.5f}, TINYGLTF_TYPE_SCALAR, {0, 0, 0, 1, 1, 0, 1, 0, 0.5f, 0.5f, 0, 0},
                 "CUBICSPLINE");
    file.animation("bend");
    file.channel(finger, "scale", {0, 0.5f, 1}, TINYGLTF_TYPE_VEC3, {1, 1, 1, 2, 2, 2, 1, 1, 1}, "STEP");
    file.animation("still");
    file.channel(arm, "translation", {0, 4}, TINYGLTF_TYPE_VEC3, {0, 0, 0, 0, 0, 0});
    return file;
}

/// The first node of the type below a node.
template <typename Node>
const Node* firstBelow(osg::Node& scene)
{
    class Finder : public osg::NodeVisitor
    {
    public:
        Finder() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
        void apply(osg::Node& node) override
        {
            if (!found) found = dynamic_cast<const Node*>(&node);
            traverse(node);
        }
        const Node* found = nullptr;
    };
    Finder finder;
    scene.accept(finder);
    return finder.found;
}

TEST(ExportTest, charactersComeBack)
{
    const osg::ref_ptr<osg::Group> scene = sceneOf(armFile());
    ASSERT_TRUE(scene);
    const osg::ref_ptr<osg::Group> read = throughGlb(*scene);
    ASSERT_TRUE(read);
    expectSameClips(*scene, *read);
    const AnimationSet& before = findCharacter(*scene)->getAnimationSet();
    const AnimationSet& after = findCharacter(*read)->getAnimationSet();
    EXPECT_EQ(after.skeleton().jointCount(), before.skeleton().jointCount());
    EXPECT_EQ(after.paletteSize(), before.paletteSize());
    // A second time, nothing changes: jumps, pieces of splines and clips without motion are written as they are read.
    const osg::ref_ptr<osg::Group> again = throughGlb(*read);
    ASSERT_TRUE(again);
    EXPECT_TRUE(haveSameKeyframes(findCharacter(*again)->getAnimationSet(), after));

    const auto* const lamp = dynamic_cast<const PunctualLight*>(firstBelow<osg::LightSource>(*read)->getLight());
    ASSERT_TRUE(lamp);
    EXPECT_EQ(lamp->getName(), "lamp");
    EXPECT_NEAR(lamp->getDiffuse().g(), 1.5 / osg::PI, 1e-6);
    EXPECT_NEAR(lamp->getSpotCutoff(), osg::RadiansToDegrees(0.5), 1e-4);
    EXPECT_EQ(lamp->getRange(), 20.0f);
    const auto* const eye = firstBelow<osg::CameraView>(*read);
    ASSERT_TRUE(eye);
    EXPECT_EQ(eye->getName(), "eye");
    EXPECT_NEAR(eye->getFieldOfView(), osg::RadiansToDegrees(0.7), 1e-6);
    EXPECT_EQ(osg::computeLocalToWorld(eye->getParentalNodePaths().front()).getTrans(), osg::Vec3d(5, 0, 0));
}

TEST(ExportTest, moreInfluencesAndSkinsWithSharedEntriesComeBack)
{
    ModelBuilder file;
    std::vector<int> joints;
    for (int joint = 0; joint < 6; ++joint)
    {
        joints.push_back(file.node("joint" + std::to_string(joint), joint > 0 ? joints.back() : -1));
        file.at(joints.back()).translation = {0.5, 1.0, 0.0};
    }
    const int mesh = file.skinnedTriangle();
    file.primitive(mesh).attributes["JOINTS_1"] =
        file.integers(TINYGLTF_TYPE_VEC4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, {2, 3, 4, 5, 2, 3, 4, 5, 2, 3, 4, 5});
    file.primitive(mesh).attributes["WEIGHTS_0"] =
        file.floats(TINYGLTF_TYPE_VEC4, {0.25f, 0.25f, 0, 0, 0.5f, 0.5f, 0, 0, 0.5f, 0, 0, 0});
    file.primitive(mesh).attributes["WEIGHTS_1"] =
        file.floats(TINYGLTF_TYPE_VEC4, {0.125f, 0.125f, 0.125f, 0.125f, 0, 0, 0, 0, 0, 0, 0.25f, 0.25f});
    file.at(file.node("skinned", -1, mesh)).skin = file.skin(joints);
    std::reverse(joints.begin(), joints.end());
    file.at(file.node("reversed", -1, mesh)).skin = file.skin(joints);
    file.animation("bend");
    file.channel(2, "rotation", {0, 1}, TINYGLTF_TYPE_VEC4, {0, 0, 0, 1, 0.6f, 0, 0, 0.8f});
    const osg::ref_ptr<osg::Group> scene = sceneOf(file);
    ASSERT_TRUE(scene);
    const osg::ref_ptr<osg::Group> read = throughGlb(*scene);
    ASSERT_TRUE(read);
    expectSameClips(*scene, *read);
    EXPECT_EQ(findCharacter(*read)->getAnimationSet().paletteSize(), 6u);
}

TEST(ExportTest, severalCharactersBecomeOneThatMovesThemTogether)
{
    const osg::ref_ptr<osg::Group> one = sceneOf(armFile());
    ASSERT_TRUE(one);
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    for (const double x : {0.0, 40.0})
    {
        osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform(osg::Matrix::translate(x, 0, 0));
        place->addChild(osg::clone(findCharacter(*one), osg::CopyOp::DEEP_COPY_NODES));
        scene->addChild(place);
    }
    const osg::ref_ptr<osg::Group> read = throughGlb(*scene);
    ASSERT_TRUE(read);
    const PosedScene before(*scene, 0, 1.2), after(*read, 0, 1.2);
    for (const auto& [key, vertices] : before.meshes)
        EXPECT_LE(distanceBetween(vertices, after.meshes.at(key)), 1e-5 * before.size()) << key.first;
    const std::vector<Clip>& clips = findCharacter(*read)->getAnimationSet().clips();
    ASSERT_EQ(clips.size(), 4u);
    EXPECT_EQ(clips[0].markers().size(), 1u) << "the marker of both";
}

TEST(ExportTest, aCrowdIsWrittenAsOneInstance)
{
    const osg::ref_ptr<osg::Group> one = sceneOf(armFile());
    ASSERT_TRUE(one);
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*findCharacter(*one));
    crowd->setName("arms");
    const AnimationController controller(crowd->getSharedAnimationSet());
    for (const double x : {3.0, 40.0})
        ASSERT_TRUE(crowd->add(osg::Matrix::translate(x, 0, 0), controller));
    const Warnings warnings{"crowd \"arms\": glTF has no crowds of characters; one of its 2 instances is written"};
    const osg::ref_ptr<osg::Group> read = throughGlb(*crowd, warnings);
    ASSERT_TRUE(read);
    findCharacter(*one)->setMatrix(osg::Matrix::translate(3, 0, 0));
    expectSamePose(*findCharacter(*one), *read, 0, 1.2);
}

/// A scene of OSG: quads below a transform, with a fixed material on the node above, and what glTF cannot hold.
TEST(ExportTest, scenesOfOsgBecomeTrianglesWithTheMaterialsAbove)
{
    const osg::ref_ptr<osg::Geometry> quad = new osg::Geometry;
    quad->setName("quad");
    const osg::Vec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}};
    quad->setVertexArray(new osg::Vec3Array(4, corners));
    quad->setNormalArray(new osg::Vec3Array(osg::Array::BIND_OVERALL, 1), osg::Array::BIND_OVERALL);
    quad->addPrimitiveSet(new osg::DrawArrays(GL_QUADS, 0, 4));
    const osg::ref_ptr<osg::Material> red = new osg::Material;
    red->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(1, 0, 0, 1));
    const osg::ref_ptr<osg::MatrixTransform> scene = new osg::MatrixTransform(
        osg::Matrix::scale(1, 2, 3) * osg::Matrix::rotate(0.5, osg::Vec3(0, 1, 0)) * osg::Matrix::scale(1, 1, 2));
    scene->setName("sheared");
    scene->getOrCreateStateSet()->setAttribute(red);
    const osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->addDrawable(quad);
    scene->addChild(geode);
    const osg::ref_ptr<osg::LightSource> lamp = new osg::LightSource;
    lamp->setName("lamp");
    scene->addChild(lamp);
    const osg::ref_ptr<osg::Geometry> empty = new osg::Geometry;
    empty->setName("empty");
    geode->addDrawable(empty);
    const osg::ref_ptr<osg::Group> read = throughGlb(
        *scene, {"light \"lamp\": it is no PunctualLight; left out", "mesh \"empty\": it has no vertices; left out"});
    ASSERT_TRUE(read);
    // Without normals, the import makes those of the triangles: vertices of their own.
    const PosedScene found(*read, -1, 0.0);
    ASSERT_EQ(found.meshes.count({"quad", 6}), 1u);
    for (const osg::Vec3d& vertex : found.meshes.at({"quad", 6}).front())
    {
        const osg::Vec3d local = osg::Matrixd::inverse(scene->getMatrix()).preMult(vertex);
        EXPECT_NEAR(std::abs(local.x() - 0.5), 0.5, 1e-5);
        EXPECT_NEAR(local.y(), 0.0, 1e-5);
        EXPECT_NEAR(std::abs(local.z() - 0.5), 0.5, 1e-5);
    }
}

TEST(ExportTest, anEmptySceneIsAnError)
{
    Messages messages;
    Report report(messages);
    const Result<std::string> glb = exportModel(*osg::ref_ptr<osg::Group>(new osg::Group), report);
    ASSERT_FALSE(glb);
    EXPECT_NE(glb.error().message.find("nothing"), std::string::npos);
}

TEST(ExportTest, picturesOfAllFormatsArePng)
{
    struct Format
    {
        GLenum format, type;
        GLenum read; ///< the format of the PNG
    };
    const Format formats[] = {{GL_LUMINANCE, GL_UNSIGNED_BYTE, GL_LUMINANCE},
                              {GL_LUMINANCE_ALPHA, GL_UNSIGNED_SHORT, GL_LUMINANCE_ALPHA},
                              {GL_RGB, GL_UNSIGNED_BYTE, GL_RGB},
                              {GL_RGBA, GL_UNSIGNED_SHORT, GL_RGBA},
                              {GL_BGRA, GL_UNSIGNED_BYTE, GL_RGBA},
                              {GL_RGB, GL_FLOAT, GL_RGBA}};
    for (const Format& each : formats)
    {
        const osg::ref_ptr<osg::Image> image = new osg::Image;
        image->allocateImage(3, 2, 1, each.format, each.type);
        for (unsigned int y = 0; y < 2; ++y)
            for (unsigned int x = 0; x < 3; ++x)
                image->setColor(osg::Vec4(0.2f * float(x), 0.4f * float(y), 0.6f, 0.8f), x, y);
        const Result<std::string> png = encodePng(*image);
        ASSERT_TRUE(png) << png.error().message;
        const auto read = decodePicture({png.value().begin(), png.value().end()});
        ASSERT_TRUE(read) << read.error().message;
        EXPECT_EQ(read.value()->getPixelFormat(), each.read);
        for (unsigned int y = 0; y < 2; ++y)
            for (unsigned int x = 0; x < 3; ++x)
                EXPECT_LT((read.value()->getColor(x, y) - image->getColor(x, y)).length(), 0.01f) << x << ' ' << y;
    }
    const osg::ref_ptr<osg::Image> compressed = new osg::Image;
    compressed->allocateImage(4, 4, 1, GL_COMPRESSED_RGBA_S3TC_DXT5_EXT, GL_UNSIGNED_BYTE);
    EXPECT_FALSE(encodePng(*compressed));
    EXPECT_FALSE(encodePng(*osg::ref_ptr<osg::Image>(new osg::Image)));
}

struct KeysCase
{
    const char* name;
    Channel::Interpolation interpolation;
    std::vector<double> times, values; ///< x of a translation
    const char* written;
    std::vector<float> keys;
};

TEST(ExportTest, clipsAreWrittenWithTheKeysThatTheyNeed)
{
    constexpr auto step = Channel::Interpolation::Step, linear = Channel::Interpolation::Linear,
                   cubic = Channel::Interpolation::CubicSpline;
    const KeysCase cases[] = {
        {"the rest pose", linear, {0, 1}, {0, 0}, "LINEAR", {}},
        {"a constant", linear, {0, 1, 2}, {3, 3, 3}, "LINEAR", {0, 2}},
        {"a pause", linear, {0, 1, 2, 3, 4}, {0, 1, 1, 1, 2}, "LINEAR", {0, 1, 3, 4}},
        {"steps", step, {0, 1, 2}, {0, 1, 5}, "STEP", {0, 1, 2}},
        {"a spline", cubic, {0, 2, 3}, {0, 0, 1, 0, 4, 2, 0, 1, 0}, "CUBICSPLINE", {0, 2, 3}},
    };
    const Skeleton skeleton = Skeleton::create({{"mover", -1, {}, 0}, {"other", -1, {}, 1}}).value();
    for (const KeysCase& each : cases)
    {
        SCOPED_TRACE(each.name);
        ClipBuilder builder(skeleton, {});
        Channel channel{Channel::Path::Translation, each.interpolation, 0, each.times, {}};
        for (const double x : each.values)
            channel.values.insert(channel.values.end(), {x, 0.0, 0.0});
        ASSERT_TRUE(builder.add(channel));
        // Another channel cuts the first one at its own times.
        const Channel cutting{Channel::Path::Translation,
                              Channel::Interpolation::Linear,
                              1,
                              {0.5, 1.1, 2.3},
                              {0, 0, 0, 1, 0, 0, 0, 0, 0}};
        ASSERT_TRUE(each.interpolation != cubic || builder.add(cutting));
        const ClipKeys keys = keysOf(builder.build("clip"), {0, 0, 3, false}, {0, 0, 0});
        EXPECT_STREQ(keys.interpolation, each.written);
        EXPECT_EQ(keys.times, each.keys);
        const std::size_t perKey = each.interpolation == cubic ? 9 : 3;
        ASSERT_EQ(keys.values.size(), perKey * keys.times.size());
        for (std::size_t i = 0; each.interpolation != linear && i < keys.values.size(); i += 3)
            EXPECT_NEAR(keys.values[i], each.values[i / 3], 1e-5) << i;
    }
}

} // namespace

} // namespace osgGpuAnimation::gltf
