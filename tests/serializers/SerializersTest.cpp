// SPDX-License-Identifier: MIT
#include "plugin/SharedAssets.h"
#include "serializers/StoredTest.h"
#include <osgGpuAnimation/animation/JointPose.h>

#include <osgGpuAnimation/animation/JointMask.h>
#include <osgGpuAnimation/animation/keyframes/CompactTracks.h>
#include <osgGpuAnimation/animation/keyframes/PackedKeyframes.h>
#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>
#include <osgGpuAnimation/frame/PoseStatistics.h>
#include <osgGpuAnimation/looks/CharacterProgram.h>
#include <osgGpuAnimation/looks/shading/ShaderPermutations.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/detail/CrowdDetail.h>

#include <osg/Texture2D>

#include <filesystem>

namespace osgGpuAnimation
{

namespace
{

using SerializersTest = StoredArmTest;
using Read = osgDB::ReaderWriter::ReadResult;

void setUpLayers(AnimationController& controller)
{
    controller.setLoopMode(LoopMode::PingPong);
    controller.setSpeed(0.7);
    ASSERT_TRUE(controller.play(0));
    controller.advance(1.9);
    CrossfadeOptions inStep;
    inStep.sync = Sync::Phase;
    inStep.curve = FadeCurve::Smooth;
    ASSERT_TRUE(controller.crossfade(1, 0.8, inStep));
    controller.advance(0.3);
    AnimationLayer& over = controller.layer(1);
    ASSERT_TRUE(over.setMask(JointMask(controller.set(), 0.3f)));
    over.setLoopMode(LoopMode::Once);
    ASSERT_TRUE(over.play(1));
    over.fadeWeight(0.2f, 1.0, FadeCurve::Smooth);
    AnimationLayer& added = controller.layer(2);
    added.setMode(AnimationLayer::Mode::Additive, AnimationLayer::Reference::FirstFrame);
    ASSERT_TRUE(added.play(0));
    added.setBlendPriority(7);
    controller.advance(0.25);
}

} // namespace

// A marker at the present time is told once: before the scene is stored, or after it is read.
TEST_F(SerializersTest, markersAreToldOnceBeforeOrAfter)
{
    const auto set = character().getAnimationSet().withClips(
        {character().getAnimationSet().clips()[0].withMarkers({{0.0, "a"}, {0.5, "b"}}).value()});
    ASSERT_TRUE(set) << set.error().message;
    ASSERT_TRUE(character().setAnimationSet(set.value()));
    struct Case
    {
        double seek, advance;
        const char* told; ///< of the first 0.25 s after reading
    };
    for (const Case& c : {Case{0.0, 0.0, "a"}, Case{0.0, 0.5, ""}, Case{0.5, 0.0, "b"}, Case{0.25, 0.25, ""}})
        for (const char* format : storedFormats)
        {
            AnimationController& before = character().getController();
            ASSERT_TRUE(before.play(0));
            before.seek(c.seek);
            before.advance(c.advance);
            const osg::ref_ptr<osg::Node> read = files.throughFile(*scene, format);
            ASSERT_TRUE(read && findCharacter(*read));
            AnimationController& after = findCharacter(*read)->getController();
            std::string told;
            after.setEventCallback([&](const AnimationEvent& event)
                                   { told += event.marker ? event.marker->name : "|"; });
            after.advance(0.25);
            EXPECT_EQ(told, c.told) << format << ", from " << c.seek << " by " << c.advance;
        }
}

TEST_F(SerializersTest, charactersOfOneSetShareItAfterwards)
{
    osg::ref_ptr<osg::Group> both = new osg::Group;
    both->addChild(scene);
    const osg::ref_ptr<osg::Node> clone = osg::clone(scene.get(), osg::CopyOp::DEEP_COPY_NODES);
    findCharacter(*clone)->getController().setSpeed(3.0);
    both->addChild(clone);
    for (const char* format : storedFormats)
    {
        const osg::ref_ptr<osg::Node> read = files.throughFile(*both, format);
        ASSERT_TRUE(read && read->asGroup()->getNumChildren() == 2);
        AnimatedCharacter* first = findCharacter(*read->asGroup()->getChild(0));
        AnimatedCharacter* second = findCharacter(*read->asGroup()->getChild(1));
        ASSERT_TRUE(first && second && first != second);
        EXPECT_EQ(&first->getAnimationSet(), &second->getAnimationSet());
        EXPECT_EQ(first->getController().layer(0).settings().speed, 1.0);
        EXPECT_EQ(second->getController().layer(0).settings().speed, 3.0);
        EXPECT_EQ(first->getChild(0), second->getChild(0)) << "the meshes";
        EXPECT_EQ(first->getAnimationSet().skeleton().joint(0).name, "arm \"1\" <&{ä");
        EXPECT_EQ(first->getAnimationSet().clips()[0].name(), "Slow slide");
    }
}

TEST_F(SerializersTest, pixelErrorsAndDrawingAloneComeBack)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(character());
    for (const char* format : storedFormats)
        for (const float pixels : {0.0f, 0.3f})
        {
            ASSERT_TRUE(character().getMeshes().setPixelError(pixels));
            ASSERT_TRUE(crowd->getMeshes().setPixelError(pixels));
            character().setDrawnTogether(pixels == 0.0f);
            const osg::ref_ptr<osg::Node> again = files.throughFile(*scene, format);
            const osg::ref_ptr<osg::Node> crowdAgain = files.throughFile(*crowd, format);
            ASSERT_TRUE(again && crowdAgain) << format;
            EXPECT_EQ(findCharacter(*again)->getMeshes().getPixelError(), pixels) << format;
            EXPECT_EQ(findCharacter(*again)->isDrawnTogether(), pixels == 0.0f) << format;
            EXPECT_EQ(findCharacter(*again)->getClipBounds(0)._max, character().getClipBounds(0)._max) << format;
            EXPECT_EQ(dynamic_cast<AnimatedCrowd&>(*crowdAgain).getMeshes().getPixelError(), pixels) << format;
        }
    for (const float wrong : {-0.5f, std::nanf(""), std::numeric_limits<float>::infinity()})
    {
        EXPECT_FALSE(character().getMeshes().setPixelError(wrong));
        EXPECT_FALSE(crowd->getMeshes().setPixelError(wrong));
        EXPECT_EQ(crowd->getMeshes().getPixelError(), 0.3f);
    }
}

TEST_F(SerializersTest, aCrowdKeepsItsInstances)
{
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(character());
    EXPECT_TRUE(crowd->setOrigin(osg::Vec3d(1e6, -2e6, 30)));
    crowd->addEventCallback(new PoseStatistics);
    AnimationController controller(crowd->getSharedAnimationSet());
    ASSERT_TRUE(crowd->add(osg::Matrixd::translate(1e6, -2e6, 31), controller));
    ASSERT_TRUE(controller.play(1));
    controller.seek(0.3);
    controller.setSpeed(-0.5);
    ASSERT_TRUE(crowd->add(osg::Matrixd::rotate(1, 0, 0, 1) * osg::Matrixd::translate(1e6 + 5, -2e6, 30), controller,
                           osg::Vec4(0.2f, 0.4f, 1, 1)));
    controller.pause();
    ASSERT_TRUE(crowd->add(osg::Matrixd::translate(1e6, -2e6 - 3, 30), controller));
    setUpLayers(controller);
    ASSERT_TRUE(crowd->add(osg::Matrixd::translate(1e6, -2e6, 40), controller));
    crowd->update(0.0);
    crowd->update(0.4);
    for (const char* format : storedFormats)
    {
        SCOPED_TRACE(format);
        const osg::ref_ptr<osg::Node> read = files.throughFile(*crowd, format);
        auto* back = dynamic_cast<AnimatedCrowd*>(read.get());
        ASSERT_TRUE(back);
        ASSERT_EQ(back->getNumInstances(), crowd->getNumInstances());
        EXPECT_EQ(back->getOrigin(), crowd->getOrigin());
        EXPECT_TRUE(dynamic_cast<PoseStatistics*>(back->getEventCallback()));
        EXPECT_EQ(back->getNumChildren(), crowd->getNumChildren());
        EXPECT_NEAR((back->getBound().center() - crowd->getBound().center()).length(), 0.0, 1e-9);
        for (std::size_t i = 0; i < crowd->getNumInstances(); ++i)
        {
            EXPECT_EQ(CrowdDetail::instances(*back).hasController(i), CrowdDetail::instances(*crowd).hasController(i));
            AnimationController first = CrowdDetail::instances(*crowd).controllerCopy(i);
            AnimationController second = CrowdDetail::instances(*back).controllerCopy(i);
            EXPECT_EQ(CrowdDetail::instances(*back).rootMatrix(i).rows,
                      CrowdDetail::instances(*crowd).rootMatrix(i).rows);
            EXPECT_EQ(CrowdDetail::instances(*back).tint(i), CrowdDetail::instances(*crowd).tint(i));
            EXPECT_EQ(second.state(), first.state());
            EXPECT_LE(paletteDifference(first, second), 1e-6f);
            EXPECT_LE(paletteDifference((first.advance(0.6), first), (second.advance(0.6), second)), 1e-6f);
        }
    }
    EXPECT_EQ(log->text, "");
    const Read other = readContent("crowd.osgt", replaced(textOf(*crowd), "Instances 1 ", "Instances 5 "));
    EXPECT_NE(other.message().find("a crowd has version 5, expected 1"), std::string::npos);
}

/// The layer or the target is lost, the scene is not.
TEST_F(SerializersTest, posesAndTargetsThatDoNotFitAreDropped)
{
    const LookAt look{"look", {"hand"}};
    ASSERT_TRUE(character().setAnimationSet(character().getAnimationSet().withConstraints({look}).value()));
    JointPose& pose = character().getController().layer(1).pose();
    ASSERT_TRUE(pose.setRotation(0, glm::quat(0.5f, 0.5f, -0.5f, 0.5f)));
    ASSERT_TRUE(character().getController().constraint("look").setTarget({2, 3, 4}));
    const std::string sound = textOf(*scene);
    const struct
    {
        const char *pattern, *instead, *message;
    } cases[] = {{"Track 0 240", "Track 9 240", "a pose with values of track 9"},
                 {"(Target [^0-9]*)2 3 4", "$1 2 3 1e30", "it is dropped"}};
    for (const auto& each : cases)
    {
        Read result = readContent("far.osgt", replaced(sound, each.pattern, each.instead));
        ASSERT_TRUE(result.validNode()) << log->text;
        EXPECT_EQ(findCharacter(*result.getNode())->getController().constraint("look").hasTarget(),
                  each.message[0] == 'a');
        EXPECT_NE(log->text.find(each.message), std::string::npos) << log->text;
    }
}

TEST_F(SerializersTest, shadersAreNotInTheFile)
{
    ASSERT_TRUE(osgDB::writeNodeFile(*scene, files.folder.file("arm.osgt")));
    const std::string text = readBytes(files.folder.file("arm.osgt"));
    EXPECT_NE(text.find("osgGpuAnimation::SurfaceProgram"), std::string::npos);
    EXPECT_EQ(text.find("osg::Shader"), std::string::npos);
    const osg::ref_ptr<osg::Node> read = osgDB::readRefNodeFile(files.folder.file("arm.osgt"));
    const auto programOf = [](AnimatedCharacter& of)
    { return of.getChild(0)->getStateSet()->getAttribute(osg::StateAttribute::PROGRAM); };
    EXPECT_EQ(programOf(*findCharacter(*read)), programOf(character()));
}

TEST_F(SerializersTest, theWhiteTextureIsKnownInCopiesAndFiles)
{
    const auto textureOf = [](osg::Node& of)
    {
        const osg::Node& mesh = *findCharacter(of)->getChild(0);
        return static_cast<const osg::Texture2D*>(
            mesh.getStateSet()->getTextureAttribute(0, osg::StateAttribute::TEXTURE));
    };
    const osg::Texture2D* white = textureOf(*scene);
    ASSERT_TRUE(white);
    EXPECT_TRUE(isWhiteTexture(white));
    const osg::ref_ptr<osg::Texture2D> copy = osg::clone(white, osg::CopyOp::DEEP_COPY_ALL);
    EXPECT_TRUE(isWhiteTexture(copy));
    for (const char* format : storedFormats)
        EXPECT_TRUE(isWhiteTexture(textureOf(*files.throughFile(*scene, format)))) << format;
    EXPECT_FALSE(isWhiteTexture(nullptr));
    copy->setName("");
    EXPECT_FALSE(isWhiteTexture(copy));
}

TEST_F(SerializersTest, compactClipsStayCompact)
{
    const std::string file = ownScene("Wanderer.glb");
    const osg::ref_ptr<osg::Node> exact = osgDB::readRefNodeFile(file);
    const osg::ref_ptr<osg::Node> compact = osgDB::readRefNodeFile(file, new osgDB::Options("compact=1e-4"));
    ASSERT_TRUE(exact && compact);
    const AnimationSet& set = findCharacter(*compact)->getAnimationSet();
    ASSERT_TRUE(set.clips().front().compactTracks());
    ASSERT_TRUE(files.throughFile(*exact, "osgb"));
    const auto exactBytes = std::filesystem::file_size(files.folder.file("scene.osgb"));
    for (const char* format : storedFormats)
    {
        SCOPED_TRACE(format);
        const osg::ref_ptr<osg::Node> read = files.throughFile(*compact, format);
        ASSERT_TRUE(read && findCharacter(*read));
        const AnimationSet& found = findCharacter(*read)->getAnimationSet();
        EXPECT_TRUE(haveSameKeyframes(set, found));
        EXPECT_EQ(PackedKeyframes(found).texels(), PackedKeyframes(set).texels()) << "what goes to the GPU";
        if (std::string(format) == "osgb")
        {
            EXPECT_LT(std::filesystem::file_size(files.folder.file("scene.osgb")), exactBytes);
        }
    }
}

} // namespace osgGpuAnimation
