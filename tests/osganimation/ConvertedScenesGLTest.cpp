// SPDX-License-Identifier: MIT
#include "osganimation/SkeletonConversion.h"
#include "osganimation/SmallRig.h"
#include "plugin/PluginFolder.h"
#include "plugin/SharedAssets.h"
#include "serializers/RoundTrip.h"
#include "support/ScratchFolder.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/mesh/SkinnedGeometry.h>
#include <osgGpuAnimation/nodes/JointAttachment.h>

#include <osg/LightSource>
#include <osgAnimation/BasicAnimationManager>
#include <osgAnimation/Bone>
#include <osgAnimation/MorphGeometry>
#include <osgAnimation/RigGeometry>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>
#include <osgUtil/UpdateVisitor>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <set>

namespace osgGpuAnimation
{

namespace
{

/// A scene of osgAnimation, posed by osgAnimation.
class OriginalScene : public osg::NodeVisitor
{
public:
    explicit OriginalScene(osg::Node* scene) : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), _scene(scene)
    {
        scene->accept(*this);
    }

    void apply(osg::Node& node) override
    {
        if (auto* const found = dynamic_cast<osgAnimation::BasicAnimationManager*>(node.getUpdateCallback()))
        {
            manager = found;
            manager->link(&node);
        }
        if (auto* const bone = dynamic_cast<osgAnimation::Bone*>(&node)) bones[bone->getName()] = bone;
        traverse(node);
    }

    /// Shows the animation at that time and deforms the meshes.
    void pose(osgAnimation::Animation& animation, double seconds)
    {
        for (const osg::ref_ptr<osgAnimation::Channel>& channel : animation.getChannels())
        {
            channel->getTarget()->reset();
            channel->update(seconds, 1.0f, 0);
        }
        osgUtil::UpdateVisitor visitor;
        osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
        visitor.setFrameStamp(stamp);
        visitor.setTraversalNumber(++_updates);
        _scene->accept(visitor);
        _scene->accept(visitor);
    }

    osg::Node* scene() const { return _scene; }

    osgAnimation::BasicAnimationManager* manager = nullptr;
    std::map<std::string, osg::ref_ptr<osgAnimation::Bone>> bones;

private:
    osg::Node* _scene;
    unsigned int _updates = 0;
};

class ConvertedScenesGLTest : public ViewerGLTest
{
protected:
    int pictureSide() const override { return 256; }

    /// The bones at 20 times of each animation, and pictures at one. make: the same scene each time; osgAnimation keeps
    /// what an earlier animation has set.
    void expectSamePoses(const std::function<osg::ref_ptr<osg::Node>()>& make, std::size_t clipCount)
    {
        const osg::ref_ptr<osg::Node> node = make();
        ASSERT_TRUE(node);
        const osganimation::Conversion converted = osganimation::convertOsgAnimation(*node);
        ASSERT_EQ(converted.characters.size(), 1u);
        AnimatedCharacter& character = *converted.characters.front();
        const double size = character.getBound().radius();
        ASSERT_GT(size, 0.0);
        const std::vector<Clip>& clips = character.getAnimationSet().clips();
        EXPECT_EQ(clips.size(), clipCount);
        for (std::size_t clip = 0; clip < clips.size(); ++clip)
        {
            SCOPED_TRACE(clips[clip].name());
            const osg::ref_ptr<osg::Node> source = make();
            // osgAnimation does not normalize the normals that it turns and scales.
            source->getOrCreateStateSet()->setMode(GL_NORMALIZE, osg::StateAttribute::ON);
            OriginalScene original(source);
            ASSERT_TRUE(original.manager);
            const osgAnimation::AnimationList& animations = original.manager->getAnimationList();
            const auto animation =
                std::find_if(animations.begin(), animations.end(),
                             [&](const auto& each) { return each->getName() == clips[clip].name(); });
            ASSERT_NE(animation, animations.end());
            ASSERT_TRUE(character.getController().play(clip));
            character.getController().pause();
            const double duration = character.getController().duration();
            double worst = 0.0;
            for (int i = 0; i < 20; ++i)
            {
                const double time = duration * (i + 0.37) / 20.0;
                original.pose(**animation, time);
                character.getController().seek(time);
                for (const auto& [name, bone] : original.bones)
                {
                    const Result<osg::Matrixd> found = character.jointToModel(name);
                    ASSERT_TRUE(found) << name;
                    for (int e = 0; e < 12; ++e)
                        worst = std::max(worst,
                                         std::abs(found.value().ptr()[e] - bone->getMatrixInSkeletonSpace().ptr()[e]));
                    worst = std::max(worst,
                                     (found.value().getTrans() - bone->getMatrixInSkeletonSpace().getTrans()).length() /
                                         size);
                }
            }
            EXPECT_LE(worst, 1e-4);
            // The last pose, drawn by both.
            expectSamePicture(original.scene(), converted.node);
        }
    }

    void expectSamePicture(osg::Node* original, osg::Node* converted)
    {
        osg::ref_ptr<osg::Image> pictures[2];
        osg::Node* const scenes[] = {original, converted};
        for (int i = 0; i < 2; ++i)
        {
            viewer().setSceneData(scenes[i]);
            const osg::BoundingSphere bound = scenes[0]->getBound();
            viewer().getCamera()->setProjectionMatrixAsOrtho(-bound.radius(), bound.radius(), -bound.radius(),
                                                             bound.radius(), -10.0, 10.0);
            viewer().getCamera()->setViewMatrixAsLookAt(bound.center() + osg::Vec3d(0, -2, 0), bound.center(),
                                                        osg::Vec3d(0, 0, 1));
            drawAt(0.0);
            EXPECT_NO_GL_ERROR();
            pictures[i] = picture().copy();
        }
        const int before = Picture::pixelsDrawn(*pictures[0]), after = Picture::pixelsDrawn(*pictures[1]);
        EXPECT_GT(before, 500);
        EXPECT_NEAR(before, after, before / 200);
        // The program lights fragments in place of vertices, and takes the diffuse colour for ambient light, too.
        EXPECT_LE(Picture::meanDifference(*pictures[0], *pictures[1]), 0.05);
    }
};

TEST_F(ConvertedScenesGLTest, nathanTakesThePosesOfOsgAnimation)
{
    SKIP_WITHOUT_SHARED_FILE("assets/nathan/nathan.osg");
    const std::string file = sharedFile("assets/nathan/nathan.osg");
    expectSamePoses([&] { return osgDB::readRefNodeFile(file); }, 5); // the sixth animation moves a material
}

TEST_F(ConvertedScenesGLTest, allKindsOfChannelsAndMeshesTakeThePosesOfOsgAnimation)
{
    expectSamePoses([] { return osg::ref_ptr<osg::Node>(SmallRig().root); }, 2);
    const SmallRig scene;
    static_cast<void>(osganimation::convertOsgAnimation(*scene.root));
    EXPECT_FALSE(scene.root->getUpdateCallback()) << "all its channels are in clips";
    const AnimatedCharacter* const character = findCharacter(*scene.root);
    ASSERT_TRUE(character);
    EXPECT_EQ(character->getName(), "arm");
    std::set<std::string> meshes;
    for (unsigned int i = 0; i < character->getNumChildren(); ++i)
        if (dynamic_cast<const SkinnedGeometry*>(character->getChild(i)))
            meshes.insert(character->getChild(i)->getName());
    EXPECT_EQ(meshes, (std::set<std::string>{"flag", "sleeve"}));
}

/// A strip whose first target is a wider one, its second a longer one; RELATIVE targets are differences.
osg::ref_ptr<osgAnimation::MorphGeometry> morphingStrip(osgAnimation::MorphGeometry::Method method)
{
    osg::ref_ptr<osg::Geometry> shapes[3];
    for (int shape = 0; shape < 3; ++shape)
    {
        const bool isDifference = shape > 0 && method == osgAnimation::MorphGeometry::RELATIVE;
        osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array, normals = new osg::Vec3Array;
        for (int i = 0; i < 4; ++i)
        {
            const osg::Vec3 base(i % 2 == 0 ? -0.3f : 0.3f, 0.0f, i / 2 == 0 ? 0.0f : 0.6f);
            const osg::Vec3 moved(shape == 1 ? base.x() : 0.0f, 0.0f, shape == 2 ? base.z() : 0.0f);
            vertices->push_back(isDifference ? moved : base + moved);
            normals->push_back(isDifference ? osg::Vec3() : osg::Vec3(0, -1, 0));
        }
        shapes[shape] = new osg::Geometry;
        shapes[shape]->setVertexArray(vertices);
        shapes[shape]->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
        shapes[shape]->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLE_STRIP, 0, 4));
    }
    osg::ref_ptr<osgAnimation::MorphGeometry> made = new osgAnimation::MorphGeometry(*shapes[0]);
    made->setMethod(method);
    made->addMorphTarget(shapes[1], 0.0f);
    made->addMorphTarget(shapes[2], 0.25f);
    return made;
}

/// The small rig with a morphing strip at a bone and a RigGeometry of another one, and an animation of their weights.
osg::ref_ptr<osg::Node> morphingScene()
{
    const SmallRig scene;
    const osg::ref_ptr<osg::Geode> mouth = new osg::Geode,
                                   cuff = SmallRig::rigged("cuff", morphingStrip(osgAnimation::MorphGeometry::RELATIVE),
                                                           "upper");
    osg::ref_ptr<osg::Material> even = new osg::Material; // the program takes the diffuse colour for ambient light
    even->setAmbient(osg::Material::FRONT_AND_BACK, even->getDiffuse(osg::Material::FRONT));
    for (osg::Geode* const geode : {mouth.get(), cuff.get()})
        geode->getOrCreateStateSet()->setAttribute(even);
    const osg::ref_ptr<osgAnimation::MorphGeometry> strip = morphingStrip(osgAnimation::MorphGeometry::NORMALIZED);
    strip->setName("mouth");
    mouth->addDrawable(strip);
    const osg::ref_ptr<osgAnimation::UpdateMorph> mouthUpdate = new osgAnimation::UpdateMorph;
    mouthUpdate->addTarget("mouth");
    mouth->setUpdateCallback(mouthUpdate);
    scene.lower->addChild(mouth);
    const osg::ref_ptr<osgAnimation::UpdateMorph> cuffUpdate = new osgAnimation::UpdateMorph;
    cuffUpdate->addTarget("cuff");
    cuff->setUpdateCallback(cuffUpdate);
    scene.skeleton->addChild(cuff);

    osg::ref_ptr<osgAnimation::Animation> puff = new osgAnimation::Animation;
    puff->setName("Puff");
    for (const char* const target : {"mouth", "cuff"})
        for (const char* const weight : {"0", "1"})
        {
            osg::ref_ptr<osgAnimation::FloatLinearChannel> channel = new osgAnimation::FloatLinearChannel;
            channel->setTargetName(target);
            channel->setName(weight);
            osgAnimation::FloatKeyframeContainer& keys = *channel->getOrCreateSampler()->getOrCreateKeyframeContainer();
            keys.push_back(osgAnimation::FloatKeyframe(0.0, -0.5f)); // below 0 it does nothing
            keys.push_back(osgAnimation::FloatKeyframe(1.0, *weight == '0' ? 1.5f : 0.7f));
            puff->addChannel(channel);
        }
    scene.manager->registerAnimation(puff);
    return scene.root;
}

TEST_F(ConvertedScenesGLTest, morphTargetsTakeTheShapesOfOsgAnimation)
{
    expectSamePoses(morphingScene, 3);
    const osg::ref_ptr<osg::Node> node = morphingScene();
    const osganimation::Conversion converted = osganimation::convertOsgAnimation(*node);
    EXPECT_TRUE(converted.warnings.empty()) << converted.warnings.front();
    const AnimationSet& set = converted.characters.front()->getAnimationSet();
    ASSERT_EQ(set.morphs().size(), 2u);
    EXPECT_EQ(set.morphs()[0].defaults, (std::vector<float>{0.0f, 0.0f})); // "Puff" drives both
    const Clip& puff = set.clips().back();
    for (std::size_t keyframe = 0; keyframe < puff.keyframeCount(); ++keyframe)
        for (std::size_t morph = 0; morph < 2; ++morph)
            for (std::size_t weight = 0; weight < 2; ++weight)
                EXPECT_GE(puff.at(keyframe, set.firstTrackOfMorph(morph))->number(weight), 0.0f) << keyframe;
}

TEST_F(ConvertedScenesGLTest, morphTargetsThatDoNotFitAreLeftOut)
{
    const SmallRig scene;
    osg::ref_ptr<osg::Geode> mouth = new osg::Geode, loose = new osg::Geode;
    const osg::ref_ptr<osgAnimation::MorphGeometry> strip = morphingStrip(osgAnimation::MorphGeometry::NORMALIZED);
    strip->setName("mouth");
    osg::ref_ptr<osg::Geometry> other = new osg::Geometry;
    other->setVertexArray(new osg::Vec3Array(3));
    strip->addMorphTarget(other);
    mouth->addDrawable(strip);
    scene.lower->addChild(mouth);
    loose->addDrawable(morphingStrip(osgAnimation::MorphGeometry::NORMALIZED));
    scene.root->addChild(loose);
    osg::ref_ptr<osg::Geode> coat = new osg::Geode;
    osg::ref_ptr<osgAnimation::RigGeometry> rig = new osgAnimation::RigGeometry; // without an influence map
    rig->setName("coat");
    rig->setSourceGeometry(other);
    coat->addDrawable(rig);
    scene.skeleton->addChild(coat);
    EXPECT_EQ(
        osganimation::convertOsgAnimation(*scene.root).warnings,
        (std::vector<std::string>{"mesh \"mouth\": its morph targets have other numbers of vertices; they are left out",
                                  "mesh \"coat\": it has no influence map; it is left out",
                                  "MorphGeometry that no bone carries stays as it is"}));
}

TEST_F(ConvertedScenesGLTest, whatCannotBeTurnedStaysOrIsAttached)
{
    SmallRig scene;
    osg::ref_ptr<osg::LightSource> lamp = new osg::LightSource;
    lamp->setName("lamp");
    scene.lower->addChild(lamp);
    osg::ref_ptr<osgAnimation::Vec3LinearChannel> other = new osgAnimation::Vec3LinearChannel;
    other->setTargetName("door");
    other->getOrCreateSampler()->getOrCreateKeyframeContainer()->push_back(osgAnimation::Vec3Keyframe(0.0, {}));
    scene.manager->getAnimationList().front()->addChannel(other);
    osg::ref_ptr<osgAnimation::Vec4LinearChannel> color = new osgAnimation::Vec4LinearChannel; // of a bone's namesake
    color->setTargetName("lower");
    color->setName("diffuse");
    color->getOrCreateSampler()->getOrCreateKeyframeContainer()->push_back(osgAnimation::Vec4Keyframe(0.0, {}));
    scene.manager->getAnimationList().front()->addChannel(color);
    osg::ref_ptr<osgAnimation::Skeleton> empty = new osgAnimation::Skeleton;
    empty->setName("empty");
    scene.root->addChild(empty);
    const osganimation::Conversion converted = osganimation::convertOsgAnimation(*scene.root);
    ASSERT_EQ(converted.characters.size(), 1u);
    EXPECT_EQ(converted.warnings,
              (std::vector<std::string>{"skeleton \"empty\": it has no bones; it stays as it is",
                                        "the animation manager stays, for channels that move no bone: \"door\", "
                                        "\"lower.diffuse\""}));
    ASSERT_EQ(lamp->getNumParents(), 2u); // of the bone, and the attachment
    const auto* const attachment = dynamic_cast<const JointAttachment*>(lamp->getParent(1));
    ASSERT_TRUE(attachment);
    EXPECT_EQ(attachment->getJointName(), "lower");
    EXPECT_EQ(empty->getNumParents(), 1u);

    SmallRig sheared;
    auto* const update = dynamic_cast<osgAnimation::UpdateBone*>(sheared.lower->getUpdateCallback());
    update->getStackedTransforms().push_back(
        new osgAnimation::StackedMatrixElement("shear", osg::Matrix(1, 0.5, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1)));
    const osganimation::Conversion left = osganimation::convertOsgAnimation(*sheared.root);
    EXPECT_TRUE(left.characters.empty());
    EXPECT_EQ(left.warnings.front(), "skeleton \"arm\": bone \"lower\" is sheared; it stays as it is");
    EXPECT_EQ(sheared.skeleton->getParent(0), sheared.root);
}

TEST_F(ConvertedScenesGLTest, thePseudoLoaderConvertsScenesOfAnyReader)
{
    usePluginsOfTheBuild();
    const ScratchFolder folder;
    const std::string file = folder.file("arm.osgt");
    ASSERT_TRUE(osgDB::writeNodeFile(*SmallRig().root, file));
    const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(file + ".gpuanim");
    ASSERT_TRUE(node);
    AnimatedCharacter* const character = findCharacter(*node);
    ASSERT_TRUE(character);
    EXPECT_TRUE(character->getController().isPlaying());
    EXPECT_EQ(character->getAnimationSet().clips().size(), 2u);
    // The character is a scene of the kit: it is stored and read again.
    const std::string stored = folder.file("arm.osgb");
    ASSERT_TRUE(osgDB::writeNodeFile(*node, stored));
    const osg::ref_ptr<osg::Node> again = osgDB::readRefNodeFile(stored);
    ASSERT_TRUE(again);
    EXPECT_TRUE(findCharacter(*again));
}

/// Counts the textures of each unit.
class TextureUnits : public osg::NodeVisitor
{
public:
    TextureUnits() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
    void apply(osg::Node& node) override
    {
        for (unsigned int unit = 0; node.getStateSet() && unit < units.size(); ++unit)
            if (node.getStateSet()->getTextureAttribute(unit, osg::StateAttribute::TEXTURE)) ++units[unit];
        traverse(node);
    }

    std::array<int, 2> units = {0, 0};
};

std::array<int, 2> textureUnits(const std::string& file, const std::string& options)
{
    const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(file, new osgDB::Options(options));
    TextureUnits visitor;
    if (node) node->accept(visitor);
    return visitor.units;
}

/// A triangle with the texture paint.png. (OSG's writer of COLLADA in Debian writes no file.)
const char* const texturedTriangle = R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset/>
  <library_images><image id="paint"><init_from>paint.png</init_from></image></library_images>
  <library_effects><effect id="effect"><profile_COMMON>
    <newparam sid="surface"><surface type="2D"><init_from>paint</init_from></surface></newparam>
    <newparam sid="sampler"><sampler2D><source>surface</source></sampler2D></newparam>
    <technique sid="common"><lambert>
      <diffuse><texture texture="sampler" texcoord="uv"/></diffuse>
    </lambert></technique>
  </profile_COMMON></effect></library_effects>
  <library_materials><material id="material"><instance_effect url="#effect"/></material></library_materials>
  <library_geometries><geometry id="triangle"><mesh>
    <source id="corners"><float_array id="c" count="9">0 0 0 1 0 0 0 1 0</float_array>
      <technique_common><accessor source="#c" count="3" stride="3">
        <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
      </accessor></technique_common></source>
    <source id="coordinates"><float_array id="t" count="6">0 0 1 0 0 1</float_array>
      <technique_common><accessor source="#t" count="3" stride="2">
        <param name="S" type="float"/><param name="T" type="float"/>
      </accessor></technique_common></source>
    <vertices id="vertices"><input semantic="POSITION" source="#corners"/></vertices>
    <triangles count="1" material="paint">
      <input semantic="VERTEX" source="#vertices" offset="0"/>
      <input semantic="TEXCOORD" source="#coordinates" offset="0" set="0"/>
      <p>0 1 2</p>
    </triangles>
  </mesh></geometry></library_geometries>
  <library_visual_scenes><visual_scene id="scene"><node><instance_geometry url="#triangle">
    <bind_material><technique_common><instance_material symbol="paint" target="#material">
      <bind_vertex_input semantic="uv" input_semantic="TEXCOORD" input_set="0"/>
    </instance_material></technique_common></bind_material>
  </instance_geometry></node></visual_scene></library_visual_scenes>
  <scene><instance_visual_scene url="#scene"/></scene>
</COLLADA>
)";

TEST(GpuAnimPluginTest, texturesOfColladaAreInUnit0)
{
    usePluginsOfTheBuild();
    const ScratchFolder folder;
    const std::string file = folder.file("triangle.dae");
    std::ofstream(file) << texturedTriangle;
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(2, 2, 1, GL_RGB, GL_UNSIGNED_BYTE);
    ASSERT_TRUE(osgDB::writeImageFile(*image, folder.file("paint.png")));
    EXPECT_EQ(textureUnits(file, ""), (std::array<int, 2>{0, 1})) << "OSG's reader alone";
    EXPECT_EQ(textureUnits(file + ".gpuanim", ""), (std::array<int, 2>{1, 0}));
    EXPECT_EQ(textureUnits(file + ".gpuanim", "daeUsePredefinedTextureUnits"), (std::array<int, 2>{0, 1}));
}

TEST(ExportedScenesTest, nathanComesBackFromAGlb)
{
    SKIP_WITHOUT_SHARED_FILE("assets/nathan/nathan.osg");
    const osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile(sharedFile("assets/nathan/nathan.osg"));
    ASSERT_TRUE(scene);
    const osganimation::Conversion converted = osganimation::convertOsgAnimation(*scene);
    ASSERT_EQ(converted.characters.size(), 1u);
    ASSERT_FALSE(converted.warnings.empty());
    EXPECT_EQ(converted.warnings.back(),
              "the animation manager stays, for channels that move no bone: \"Head.diffuse\"");
    const osg::ref_ptr<osg::Group> read = throughGlb(*converted.node);
    expectSameClips(*converted.node, *read);
}

} // namespace

} // namespace osgGpuAnimation
