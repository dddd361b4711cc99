// SPDX-License-Identifier: MIT
#include "plugin/PseudoLoaderTest.h"

#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/detail/CrowdDetail.h>
#include <osgGpuAnimation/nodes/studio/ModelExtent.h>
#include <osgGpuAnimation/nodes/studio/Studio.h>

#include <osg/MatrixTransform>
#include <osgDB/FileNameUtils>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>
#include <osgGA/EventVisitor>
#include <osgGA/TrackballManipulator>
#include <osgViewer/Viewer>

#include <algorithm>
#include <set>

namespace osgGpuAnimation::gltf
{

namespace
{

class CrowdPluginTest : public PseudoLoaderTest
{
protected:
    osg::ref_ptr<AnimatedCrowd> readCrowd(const std::string& name, const std::string& options = "")
    {
        Read result = read(name, options);
        osg::ref_ptr<AnimatedCrowd> crowd = dynamic_cast<AnimatedCrowd*>(result.getNode());
        EXPECT_TRUE(crowd) << result.message();
        return crowd;
    }

    static osg::Vec3d placeOf(const AnimatedCrowd& crowd, std::size_t index)
    {
        return crowd.getPlacement(CrowdDetail::instances(crowd).handleOf(index)).getTrans();
    }

    static std::vector<std::pair<int, double>> playedBy(const AnimatedCrowd& crowd)
    {
        std::vector<std::pair<int, double>> played;
        for (std::size_t index = 0; index < crowd.getNumInstances(); ++index)
        {
            const AnimationController controller = CrowdDetail::instances(crowd).controllerCopy(index);
            played.emplace_back(controller.clip(), controller.time());
        }
        return played;
    }
};

struct CrowdFault
{
    const char* file;
    const char* options;
    const char* message;
};

const CrowdFault crowdFaults[] = {
    {"arm.gltf.0x0.crowd", "", "is empty"},
    {"arm.gltf.3x0.crowd", "", "is empty"},
    {"arm.gltf.1001x1000.crowd", "", "1000000"},
    {"arm.gltf.99999999999999999999x2.crowd", "", "size"},
    {"arm.gltf.4294967296x4294967296.crowd", "", "1000000"},
    {"arm.gltf.-3x4.crowd", "", "size"},
    {"arm.gltf.3x.crowd", "", "size"},
    {"arm.gltf.3y4.crowd", "", "size"},
    {"arm.gltf.crowd", "", "size"},
    {"arm.crowd", "", "size"},
    {"absent.gltf.2x2.crowd", "", "absent.gltf does not exist"},
    {"absent.gltf.1000x1000.crowd", "", "absent.gltf"}, // the largest size is no fault
    {"absent.gltf.1x1000000.crowd", "", "absent.gltf"},
    {"absent.gltf.1x1000001.crowd", "", "1000000"},
    {"still.gltf.2x2.crowd", "", "no animated character"},
    {"arm.gltf.2x2.crowd", "clips=Jump", "\"Slide\""},
    {"arm.gltf.2x2.crowd", "clips=Slide,",
     "option clips: \"Slide,\" is not names or numbers of clips separated by commas"},
    {"arm.gltf.2x2.crowd", "spacing=0", "option spacing: \"0\" is not a number of units above 0"},
    {"arm.gltf.2x2.crowd", "spacing=nan", "option spacing"},
    {"arm.gltf.2x2.crowd", "spacing=1e300", "placement"},
    {"arm.gltf.2x2.crowd", "pixelError=-1", "option pixelError: \"-1\" is not a number of pixels from 0 to 1000000"},
    {"arm.gltf.2x2.crowd", "seed=-1", "option seed: \"-1\" is not a whole number from 0 to 4294967295"},
};

} // namespace

TEST_F(CrowdPluginTest, readsColumnsAndRowsByTheBounds)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = readCrowd("arm.gltf.4x3.crowd");
    ASSERT_TRUE(crowd);
    ASSERT_EQ(crowd->getNumInstances(), 12u);
    const double spacing = placeOf(*crowd, 1).x() - placeOf(*crowd, 0).x();
    EXPECT_GT(spacing, 0.0);
    EXPECT_NEAR(placeOf(*crowd, 4).y() - placeOf(*crowd, 0).y(), spacing, 1e-4 * spacing);
    EXPECT_NEAR(placeOf(*crowd, 0).x() + placeOf(*crowd, 11).x(), 0.0, 1e-4 * spacing);
    EXPECT_NEAR(placeOf(*crowd, 0).y() + placeOf(*crowd, 11).y(), 0.0, 1e-4 * spacing);
    EXPECT_EQ(placeOf(*crowd, 0).z(), placeOf(*crowd, 11).z());
    const osg::Matrixd placement = crowd->getPlacement(CrowdDetail::instances(*crowd).handleOf(0));
    EXPECT_EQ(osg::Matrixd::transform3x3(osg::Vec3d(0, 1, 0), crowd->getFileToNode() * placement), osg::Vec3d(0, 0, 1))
        << "+Z is up, as for the model itself";
    EXPECT_EQ(osg::Matrixd::transform3x3(osg::Vec3d(0, 0, 1), placement), osg::Vec3d(0, 0, 1));
}

TEST_F(CrowdPluginTest, theSpacingIsOfTheLargerHorizontalSide)
{
    ModelBuilder mast; // slides by 1: 1.5 wide, 8 high, 3 deep in the file's axes
    mast.node("mast", -1, mast.mesh({{"POSITION", mast.floats(TINYGLTF_TYPE_VEC3, {0, 0, 0, 0.5f, 8, 0, 0, 0, 3})}}));
    mast.slidingClip("slide", 0);
    mast.slidingClip("slide again", 0);
    mast.animation("leap"); // one wide clip does not spread the crowd
    mast.channel(0, "translation", {0, 1}, TINYGLTF_TYPE_VEC3, {0, 0, 0, 0, 0, 30});
    folder.write("mast.gltf", mast.text());
    for (const char* options : {"", "noRotation"})
    {
        const osg::ref_ptr<AnimatedCrowd> crowd = readCrowd("mast.gltf.2x2.crowd", options);
        ASSERT_TRUE(crowd);
        // Neighbours are 1.2 sides apart; bounds may be a little larger than the vertices need.
        EXPECT_NEAR(placeOf(*crowd, 1).x() - placeOf(*crowd, 0).x(), 3.6, 0.1) << options;
    }
}

// A vehicle has a body that stays with its root, below it or beside the parts that move.
TEST_F(CrowdPluginTest, meshesThatDoNotMoveFollowTheirInstance)
{
    for (const bool isBelow : {true, false})
    {
        ModelBuilder vehicle;
        const int mesh = vehicle.triangle(), root = vehicle.node("vehicle");
        const int body = vehicle.node("body", isBelow ? root : -1, mesh);
        vehicle.at(body).translation = {0, 0, 5};
        vehicle.at(body).scale = {4, 1, 1};
        vehicle.slidingClip("spin", vehicle.node("rotor", isBelow ? root : -1, mesh));
        folder.write("vehicle.gltf", vehicle.text());
        const osg::ref_ptr<AnimatedCrowd> crowd = readCrowd("vehicle.gltf.2x1.crowd", "spacing=20");
        ASSERT_TRUE(crowd);
        ASSERT_EQ(crowd->getNumChildren(), 2u);
        for (unsigned int child = 0; child < 2; ++child)
        {
            const auto* part = dynamic_cast<const SkinnedGeometry*>(crowd->getChild(child));
            ASSERT_TRUE(part);
            if (part->getName() != "body") continue;
            const osg::ref_ptr<osg::Geometry> posed =
                crowd->getPosedMesh(CrowdDetail::instances(*crowd).handleOf(1), *part);
            const auto& vertices = dynamic_cast<const osg::Vec3Array&>(*posed->getVertexArray());
            EXPECT_LT((osg::Vec3d(vertices[1] - vertices[0]) - osg::Vec3d(4, 0, 0)).length(), 1e-5);
            EXPECT_NEAR(vertices[0].y(), -5, 1e-5) << "+Z is up";
        }
        EXPECT_EQ(log->text, "");
        ASSERT_TRUE(osgDB::writeNodeFile(*read("vehicle.gltf").getNode(), folder.file("vehicle.osgt")));
        EXPECT_EQ(readCrowd("vehicle.osgt.2x1.crowd")->getNumChildren(), 2u);
        EXPECT_EQ(log->text, "");
        // What is beside the still parts is no part of the file.
        const osg::ref_ptr<osg::Group> more = read("vehicle.gltf").getNode()->asGroup();
        more->addChild(read("still.gltf").getNode());
        ASSERT_TRUE(osgDB::writeNodeFile(*more, folder.file("more.osgt")));
        EXPECT_EQ(readCrowd("more.osgt.2x1.crowd")->getNumChildren(), 2u);
        EXPECT_NE(log->text.find("\"vehicle\": meshes that are no part of it are left out"), std::string::npos)
            << log->text;
        log->text.clear();
    }
    EXPECT_FALSE(findCharacter(*read("still.gltf", "wholeModel").getNode())) << "nothing moves";
}

TEST_F(CrowdPluginTest, theSeedFixesClipsAndTimes)
{
    const auto first = playedBy(*readCrowd("arm.gltf.5x5.crowd"));
    EXPECT_EQ(playedBy(*readCrowd("arm.gltf.5X5.CROWD")), first);
    EXPECT_NE(playedBy(*readCrowd("arm.gltf.5x5.crowd", "seed=2")), first);
    std::set<int> clips;
    std::set<double> times;
    for (const auto& [clip, time] : first)
    {
        clips.insert(clip);
        times.insert(time);
    }
    EXPECT_EQ(clips, (std::set<int>{0, 1}));
    EXPECT_GT(times.size(), 20u);
}

TEST_F(CrowdPluginTest, takesOptions)
{
    for (const char* clips : {"clips=Slide", "clips=1", "clips=\"Slide,1\""})
        for (const auto& [clip, time] : playedBy(*readCrowd("arm.gltf.3x3.crowd", clips)))
            EXPECT_EQ(clip, 1) << clips;
    EXPECT_EQ(readCrowd("arm.gltf.2x2.crowd", "")->getMeshes().getPixelError(), 0.0f);
    EXPECT_EQ(readCrowd("arm.gltf.2x2.crowd", "pixelError=0.5")->getMeshes().getPixelError(), 0.5f);
    const osg::ref_ptr<AnimatedCrowd> wide = readCrowd("arm.gltf.2x2.crowd", "spacing=7.5");
    EXPECT_NEAR(placeOf(*wide, 1).x() - placeOf(*wide, 0).x(), 7.5, 1e-6);
    EXPECT_NEAR(placeOf(*wide, 2).y() - placeOf(*wide, 0).y(), 7.5, 1e-6);
    const osg::ref_ptr<AnimatedCrowd> yUp = readCrowd("arm.gltf.2x2.crowd", "spacing=7.5 noRotation");
    EXPECT_NEAR(placeOf(*yUp, 0).z() - placeOf(*yUp, 2).z(), 7.5, 1e-6);
    osgDB::ReaderWriter& reader =
        readerOf("crowd", {"clips=NAME|INDEX,...", "spacing=UNITS", "seed=NUMBER", "pixelError=PIXELS"});
    EXPECT_EQ(reader.readNode("fox.glb", nullptr).status(), Read::FILE_NOT_HANDLED);
}

TEST_F(CrowdPluginTest, dressesInstancesByAFileOrAtRandom)
{
    const std::string people = OSGGPUANIMATION_SCENES "/People.glb.10x10.crowd";
    const osg::ref_ptr<AnimatedCrowd> byFile = readCrowd(people, "outfits=People.outfits.json"); // beside the model
    ASSERT_TRUE(byFile);
    EXPECT_EQ(byFile->getOutfits().getList().size(), 24u);
    std::set<std::string> worn, sizes;
    const CrowdInstances& instances = CrowdDetail::instances(*byFile);
    for (std::size_t i = 0; i < instances.size(); ++i)
    {
        ASSERT_NE(byFile->getOutfit(instances.handleOf(i)), nullptr);
        worn.insert(byFile->getOutfit(instances.handleOf(i))->getName());
        sizes.insert(std::to_string(instances.scale(i)).substr(0, 4));
    }
    EXPECT_GT(worn.size(), 12u);
    EXPECT_EQ(sizes, (std::set<std::string>{"0.75", "1.00", "1.10"}));

    const osg::ref_ptr<AnimatedCrowd> atRandom = readCrowd(people, "outfits=random");
    ASSERT_TRUE(atRandom);
    ASSERT_EQ(atRandom->getOutfits().getList().size(), 24u);
    for (const osg::ref_ptr<Outfit>& outfit : atRandom->getOutfits().getList())
    {
        int held = 0; // of the rigid parts of the left hand
        for (const char* part : {"Lantern", "Basket", "Staff"})
            if (const auto wish = outfit->getVisibility().find(part); wish != outfit->getVisibility().end())
                held += wish->second;
        EXPECT_LE(held, 1);
        EXPECT_EQ(outfit->getColors().count("Skin"), 0u);
        EXPECT_EQ(outfit->getColors().count("Coat"), 1u);
    }
    expectError("arm.gltf.2x2.crowd", "outfits=none.json", "none.json: the file does not exist");
}

TEST_F(CrowdPluginTest, handsOtherWordsToTheModelsReaderAsTheyAre)
{
    /// Records the options that it receives; it finds no file.
    class Listener : public osgDB::ReaderWriter
    {
    public:
        Listener() { supportsExtension("listened", ""); }
        Read readNode(const std::string& file, const Options* options) const override
        {
            if (!acceptsExtension(osgDB::getFileExtension(file))) return Read::FILE_NOT_HANDLED;
            heard = options->getOptionString();
            return Read::FILE_NOT_FOUND;
        }
        mutable std::string heard;
    };
    const osg::ref_ptr<Listener> listener = new Listener;
    osgDB::Registry::instance()->addReaderWriter(listener);
    read("arm.listened.2x2.crowd", "dds_flip seed=2 clip=Run \"clips=a b\" \"name=with space\" noRotation");
    osgDB::Registry::instance()->removeReaderWriter(listener);
    EXPECT_EQ(listener->heard, "dds_flip \"name=with space\" noRotation");
}

TEST_F(CrowdPluginTest, saysWhichOptionsItTakesForMisspelt)
{
    const std::pair<const char*, const char*> cases[] = {
        {"clips=Slide spacing=3 seed=7 noRotation noKeys maxNodeDepth=9", ""}, // the model reader's options
        {"sped=7", "\"seed\""},
        {"spaceing=3", "\"spacing\""},
        {"clip=Slide", "single characters"},
        {"speed=2", "single characters"},
    };
    for (const auto& [options, hint] : cases)
    {
        SCOPED_TRACE(options);
        log->text.clear();
        readCrowd("arm.gltf.2x2.crowd", options);
        EXPECT_EQ(log->text.empty(), *hint == '\0') << log->text;
        EXPECT_NE(log->text.find(hint), std::string::npos) << log->text;
    }
}

TEST_F(CrowdPluginTest, faultsHaveAMessage)
{
    for (const CrowdFault& fault : crowdFaults)
        expectError(fault.file, fault.options, fault.message);
}

namespace
{

using StudioPluginTest = PseudoLoaderTest;

TEST_F(StudioPluginTest, faultsHaveAMessage)
{
    const std::pair<const char*, const char*> faults[] = {
        {"absent.gltf.studio", "absent.gltf does not exist"},
        {"absent.gltf.STUDIO", "absent.gltf"},
        {"arm.studio", "is not a model's file, like fox.glb in fox.glb.studio"},
        {"arm.gltf.0x0.crowd.studio", "arm.gltf.0x0.crowd: a crowd of 0x0 is empty"},
        {"absent.gltf.2x2.crowd.studio", "absent.gltf"},
        {"arm.gltf.studio.unknown.studio", "arm.gltf.studio.unknown"},
    };
    for (const auto& [file, message] : faults)
        expectError(file, "", message);
}

TEST_F(StudioPluginTest, showsCharactersAndCrowds)
{
    for (const char* name : {"arm.gltf.studio", "arm.gltf.Studio", "arm.gltf.3x3.crowd.studio"})
    {
        SCOPED_TRACE(name);
        Read result = read(name);
        const auto* studio = dynamic_cast<const Studio*>(result.getNode());
        ASSERT_TRUE(studio) << result.message();
        EXPECT_TRUE(studio->getToneMapping());
        EXPECT_TRUE(studio->getNumChildrenRequiringEventTraversal() > 0) << "the home view";
    }
    EXPECT_EQ(readerOf("studio", {"noRotation"}).readNode("fox.glb", nullptr).status(), Read::FILE_NOT_HANDLED);
}

TEST_F(StudioPluginTest, aModelThatKeepsYUpStandsOnAGroundOfItsOwnAxes)
{
    Read result = read("arm.gltf.studio", "noRotation");
    const auto* back = dynamic_cast<const osg::MatrixTransform*>(result.getNode());
    ASSERT_TRUE(back) << result.message();
    ASSERT_TRUE(dynamic_cast<const Studio*>(back->getChild(0)));
    EXPECT_LT((osg::Matrixd::transform3x3(osg::Vec3d(0, 0, 1), back->getMatrix()) - osg::Vec3d(0, 1, 0)).length(), 1e-9)
        << "the studio's +Z is the file's +Y";
}

TEST_F(StudioPluginTest, aFileWithoutMeshesIsReadWithAWarning)
{
    Read result = read("empty.gltf.studio");
    EXPECT_TRUE(dynamic_cast<const Studio*>(result.getNode())) << result.message();
    EXPECT_NE(log->text.find("nothing to see"), std::string::npos) << log->text;
}

/// A viewer that takes events and draws nothing.
class FirstView : public osgViewer::Viewer
{
public:
    FirstView(osg::Group& scene, double aspect)
    {
        getCamera()->setProjectionMatrixAsPerspective(30.0, aspect, 1.0, 10000.0);
        setCameraManipulator(new osgGA::TrackballManipulator);
        const osg::ref_ptr<osgGA::EventVisitor> visitor = new osgGA::EventVisitor;
        const osg::ref_ptr<osgGA::GUIEventAdapter> frame = new osgGA::GUIEventAdapter;
        frame->setEventType(osgGA::GUIEventAdapter::FRAME);
        visitor->addEvent(frame);
        visitor->setActionAdapter(this);
        scene.accept(*visitor);
        getCamera()->setViewMatrix(getCameraManipulator()->getInverseMatrix());
        const osg::Matrixd toPicture = getCamera()->getViewMatrix() * getCamera()->getProjectionMatrix();
        for (const osg::Vec3d& point : pointsOf(scene))
            shown.expandBy(point * toPicture);
    }

    osg::BoundingBoxd shown; ///< what the scene fills of the window, which reaches from -1 to 1
};

TEST_F(StudioPluginTest, theFirstViewIsFilled)
{
    const std::string scenes = OSGGPUANIMATION_SCENES;
    const struct
    {
        std::string file;
        double least; ///< share of the window's limiting side
        double other; ///< of the other one
    } cases[] = {
        {scenes + "/Wanderer.glb", 0.7, 0.15},
        {scenes + "/Wanderer.glb.5x5.crowd", 0.7, 0.5},
        {scenes + "/Wanderer.glb.40x40.crowd", 0.7, 0.5},
        {folder.file("still.gltf"), 0.7, 0.4},
    };
    for (const auto& [file, least, other] : cases)
        for (const double aspect : {1.0, 4.0 / 3.0, 16.0 / 9.0})
        {
            SCOPED_TRACE(testing::Message() << file << ' ' << aspect);
            const osg::ref_ptr<osg::Node> studio = osgDB::readRefNodeFile(file + ".studio");
            ASSERT_TRUE(studio);
            const osg::BoundingBoxd shown = FirstView(*studio->asGroup(), aspect).shown;
            const double width = 0.5 * (shown.xMax() - shown.xMin()), height = 0.5 * (shown.yMax() - shown.yMin());
            EXPECT_GT(std::max(width, height), least);
            EXPECT_GT(std::min(width, height), other);
            EXPECT_LT(std::max({-shown.xMin(), shown.xMax(), -shown.yMin(), shown.yMax()}), 1.0)
                << "nothing is cut off";
        }
}

TEST_F(StudioPluginTest, isKeptInOsgsFormats)
{
    Read result = read("arm.gltf.studio");
    ASSERT_TRUE(result.getNode()) << result.message();
    for (const char* format : {"kept.osgb", "kept.osgt"})
    {
        const std::string file = folder.file(format);
        ASSERT_TRUE(osgDB::writeNodeFile(*result.getNode(), file)) << format;
        const osg::ref_ptr<osg::Node> kept = osgDB::readRefNodeFile(file);
        const auto* studio = dynamic_cast<const Studio*>(kept.get());
        ASSERT_TRUE(studio) << format;
        EXPECT_TRUE(studio->getToneMapping()) << format;
        EXPECT_TRUE(findCharacter(*kept)) << format;
        EXPECT_TRUE(studio->getEventCallback()) << format;
    }
}

} // namespace

} // namespace osgGpuAnimation::gltf
