// SPDX-License-Identifier: MIT
#include "gltf/export/ClipKeys.h"
#include "gltf/ImportedFile.h"
#include "gltf/ModelImport.h"
#include "serializers/RoundTrip.h"
#include "serializers/StoredScene.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/LightSource>
#include <osg/MatrixTransform>
#include <osg/Texture2D>

#include <functional>
#include <set>
#include <string_view>

namespace osgGpuAnimation::gltf
{

namespace
{

using Warnings = std::vector<std::string>;

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

TEST(ExportTest, charactersComeBack)
{
    const osg::ref_ptr<osg::Group> scene = imported(armFile()).root;
    const osg::ref_ptr<osg::Group> read = throughGlb(*scene);
    expectSameClips(*scene, *read);
    const AnimationSet& before = findCharacter(*scene)->getAnimationSet();
    const AnimationSet& after = findCharacter(*read)->getAnimationSet();
    EXPECT_EQ(after.skeleton().jointCount(), before.skeleton().jointCount());
    EXPECT_EQ(after.paletteSize(), before.paletteSize());
    // A second time, nothing changes: jumps, pieces of splines and clips without motion are written as they are read.
    const osg::ref_ptr<osg::Group> again = throughGlb(*read);
    EXPECT_TRUE(haveSameKeyframes(findCharacter(*again)->getAnimationSet(), after));

    const nlohmann::json json = exported(*read).json;
    EXPECT_EQ(json["extensions"]["KHR_lights_punctual"]["lights"][0]["name"], "lamp");
    ASSERT_EQ(json["cameras"].size(), 1u);
    EXPECT_EQ(json["cameras"][0]["name"], "eye");
    EXPECT_NEAR(json["cameras"][0]["perspective"]["yfov"].get<double>(), 0.7, 1e-6);
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
    const osg::ref_ptr<osg::Group> scene = imported(file).root;
    const osg::ref_ptr<osg::Group> read = throughGlb(*scene);
    expectSameClips(*scene, *read);
    EXPECT_EQ(findCharacter(*read)->getAnimationSet().paletteSize(), 6u);
}

TEST(ExportTest, severalCharactersBecomeOneThatMovesThemTogether)
{
    const osg::ref_ptr<osg::Group> one = imported(armFile()).root;
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    for (const double x : {0.0, 40.0})
    {
        osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform(osg::Matrix::translate(x, 0, 0));
        place->addChild(osg::clone(findCharacter(*one), osg::CopyOp::DEEP_COPY_NODES));
        scene->addChild(place);
    }
    const osg::ref_ptr<osg::Group> read = throughGlb(*scene);
    expectSamePose(*scene, *read, 0, 1.2);
    const std::vector<Clip>& clips = findCharacter(*read)->getAnimationSet().clips();
    ASSERT_EQ(clips.size(), 4u);
    EXPECT_EQ(clips[0].markers().size(), 1u) << "the marker of both";
}

TEST(ExportTest, aCrowdIsWrittenAsOneInstance)
{
    const osg::ref_ptr<osg::Group> one = imported(armFile()).root;
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*findCharacter(*one));
    crowd->setName("arms");
    const AnimationController controller(crowd->getSharedAnimationSet());
    for (const double x : {3.0, 40.0})
        ASSERT_TRUE(crowd->add(osg::Matrix::translate(x, 0, 0), controller));
    const Warnings warnings{"crowd \"arms\": glTF has no crowds of characters; one of its 2 instances is written"};
    const osg::ref_ptr<osg::Group> read = throughGlb(*crowd, warnings);
    findCharacter(*one)->setMatrix(osg::Matrix::translate(3, 0, 0));
    expectSamePose(*findCharacter(*one), *read, 0, 1.2);
}

/// A plain scene of OSG below a transform that no node of glTF has, and what glTF cannot hold.
TEST(ExportTest, shearedScenesOfOsgKeepTheirPlaces)
{
    const osg::ref_ptr<osg::Geometry> triangle = plainTriangle("triangle");
    triangle->setNormalArray(new osg::Vec3Array(3), osg::Array::BIND_PER_VERTEX);
    for (osg::Vec3& normal : static_cast<osg::Vec3Array&>(*triangle->getNormalArray()))
        normal.set(0, -1, 0);
    const osg::ref_ptr<osg::MatrixTransform> scene = new osg::MatrixTransform(
        osg::Matrix::scale(1, 2, 3) * osg::Matrix::rotate(0.5, osg::Vec3(0, 1, 0)) * osg::Matrix::scale(1, 1, 2));
    scene->addChild(triangle);
    const osg::ref_ptr<osg::LightSource> lamp = new osg::LightSource;
    lamp->setName("lamp");
    scene->addChild(lamp);
    const osg::ref_ptr<osg::Geometry> empty = new osg::Geometry;
    empty->setName("empty");
    scene->addChild(empty);
    const osg::ref_ptr<osg::Group> read = throughGlb(
        *scene, {"light \"lamp\": it is no PunctualLight; left out", "mesh \"empty\": it has no vertices; left out"});
    ASSERT_TRUE(read);
    expectSamePose(*scene, *read, -1, 0.0);
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
        {"equal steps, the last for the duration", step, {0, 1, 2, 4}, {0, 3, 3, 3}, "STEP", {0, 1, 4}},
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

TEST(ExportTest, aLongSplineIsWrittenInPiecesOf256Keys)
{
    const Skeleton skeleton = Skeleton::create({{"mover", -1, {}, 0}}).value();
    ClipBuilder builder(skeleton, {});
    Channel channel{Channel::Path::Translation, Channel::Interpolation::CubicSpline, 0, {}, {}};
    for (int key = 0; key <= 1024; ++key) // a straight line: one piece would do
    {
        channel.times.push_back(key / 64.0);
        channel.values.insert(channel.values.end(), {1, 0, 0, key / 64.0, 0, 0, 1, 0, 0});
    }
    ASSERT_TRUE(builder.add(channel));
    const ClipKeys keys = keysOf(builder.build("line"), {0, 0, 3, false}, {0, 0, 0});
    EXPECT_EQ(keys.times, std::vector<float>({0, 4, 8, 12, 16}));
}

/// A jump of a value between two keyframes of one time: the first of them is one float earlier.
TEST(ExportTest, jumpsAreKeysOfTwoTimes)
{
    ClipParts parts;
    parts.name = "jump";
    parts.jointCount = parts.trackCount = 1;
    parts.times = {0, 1, 1, 2};
    for (const float x : {0.0f, 1.0f, 5.0f, 6.0f})
    {
        parts.data.emplace_back();
        parts.data.back().translation.x = x;
    }
    const ClipKeys keys = keysOf(Clip::create(parts).value(), {0, 0, 3, false}, {0, 0, 0});
    EXPECT_EQ(keys.times, std::vector<float>({0, std::nextafter(1.0f, 0.0f), 1, 2}));
    ASSERT_EQ(keys.values.size(), 12u);
    for (std::size_t key = 0; key < 4; ++key)
        EXPECT_EQ(keys.values[3 * key], parts.data[key].translation.x);
}

/// All that shows in a picture but the vertices: shader defines, uniforms and textures, by mesh.
class Surfaces : public osg::NodeVisitor
{
public:
    explicit Surfaces(osg::Node& scene) : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { scene.accept(*this); }
    void apply(osg::Drawable& drawable) override
    {
        const osg::StateSet* const state = drawable.getStateSet();
        std::string text = drawable.getName();
        for (const auto& [name, define] : state->getDefineList())
            text += ' ' + name + ' ' + define.first;
        for (const auto& [name, uniform] : state->getUniformList())
            for (unsigned int i = 0; uniform.first->getFloatArray() && i < uniform.first->getFloatArray()->size(); ++i)
                text += ' ' + name + ' ' + std::to_string((*uniform.first->getFloatArray())[i]);
        for (const auto& [mode, value] : state->getModeList())
            text += " mode " + std::to_string(mode) + ' ' + std::to_string(value);
        for (unsigned int unit = 0; unit < state->getTextureAttributeList().size(); ++unit)
            if (const auto* const texture =
                    dynamic_cast<const osg::Texture2D*>(state->getTextureAttribute(unit, osg::StateAttribute::TEXTURE)))
            {
                const osg::Image& image = *texture->getImage();
                text += " unit " + std::to_string(unit) + ' ' + std::to_string(texture->getInternalFormat()) + ' ' +
                        std::to_string(texture->getFilter(osg::Texture::MIN_FILTER)) + ' ' +
                        std::to_string(texture->getWrap(osg::Texture::WRAP_S)) + ' ' +
                        std::to_string(std::hash<std::string_view>()(std::string_view(
                            reinterpret_cast<const char*>(image.data()), image.getTotalSizeInBytes())));
            }
        all.insert(text);
    }
    std::multiset<std::string> all;
};

/// See modelFile(); the tolerance of compact clips, 0: they are exact.
using ExportCase = std::pair<std::string, double>;

class ExportOfModelsTest : public ::testing::TestWithParam<ExportCase>
{
};

TEST_P(ExportOfModelsTest, comesBackWithTheSamePosesAndSurfaces)
{
    ImportOptions options;
    if (GetParam().second > 0.0) options.compact = GetParam().second;
    ImportedModel model;
    importOrSkip(GetParam().first, model, options);
    if (IsSkipped() || HasFatalFailure()) return;
    EXPECT_EQ(model.compacted.has_value(), options.compact.has_value());
    const osg::ref_ptr<osg::Group> read = throughGlb(*model.root);
    expectSameClips(*model.root, *read);
    EXPECT_EQ(Surfaces(*read).all, Surfaces(*model.root).all);
}

const ExportCase exportCases[] = {{"MaterialBalls.glb", 0.0},
                                  {"Serpent.glb", 0.0},
                                  {"Wanderer.glb", 0.0},
                                  {"Wanderer.glb", 1e-3},
                                  {"assets/AnimatedMorphCube/AnimatedMorphCube.gltf", 0.0},
                                  {"assets/CesiumMan/CesiumMan.glb", 0.0},
                                  {"assets/Fox/Fox.glb", 0.0},
                                  {"assets/Knight/Knight.glb", 0.0},
                                  {"assets/SimpleSkin/SimpleSkin.gltf", 0.0},
                                  {"assets/interpolation_test/interpolation_test.gltf", 0.0},
                                  {"assets/probe/probe.gltf", 0.0},
                                  {"assets/rigged_simple/rigged_simple.gltf", 0.0}};

INSTANTIATE_TEST_SUITE_P(Files, ExportOfModelsTest, ::testing::ValuesIn(exportCases),
                         [](const auto& info)
                         { return nameOfFile(info.param.first) + (info.param.second > 0.0 ? "_compact" : ""); });

} // namespace

} // namespace osgGpuAnimation::gltf
