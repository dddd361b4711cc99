// SPDX-License-Identifier: MIT
#include "plugin/SharedAssets.h"
#include "serializers/StoredScene.h"
#include "support/Levels.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/JointAttachment.h>

#include <osg/ShapeDrawable>
#include <osgUtil/Optimizer>

// Every flag of osgUtil::Optimizer, one by one and all at once: the pictures stay the same.

namespace osgGpuAnimation
{

namespace
{

using Flags = osgUtil::Optimizer::OptimizationOptions;

/// The sets of flags, then each flag that there is.
std::vector<unsigned int> flagCases()
{
    std::vector<unsigned int> cases{Flags::DEFAULT_OPTIMIZATIONS, Flags::ALL_OPTIMIZATIONS};
    for (unsigned int flag = 1; flag <= Flags::BUFFER_OBJECT_SETTINGS; flag *= 2)
        cases.push_back(flag);
    return cases;
}

class OptimizerGLTest : public ViewerGLTest, public ::testing::WithParamInterface<unsigned int>
{
protected:
    int pictureSide() const override { return 160; }

    static osg::ref_ptr<osg::MatrixTransform> placed(osg::Node* node, const osg::Matrix& matrix)
    {
        osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform(matrix);
        place->setDataVariance(osg::Object::STATIC);
        place->addChild(node);
        return place;
    }

    /// Pictures of the scene from a fixed camera, which does not depend on the scene's bounds.
    std::vector<osg::ref_ptr<osg::Image>> pictures(osg::Node& scene)
    {
        viewer().setSceneData(&scene);
        viewer().getCamera()->setProjectionMatrixAsOrtho(-5, 5, -5, 5, 1, 60);
        viewer().getCamera()->setViewMatrixAsLookAt({6, -24, 8}, {0, 0, 1}, {0, 0, 1});
        std::vector<osg::ref_ptr<osg::Image>> taken;
        for (const double time : {0.0, 0.45})
        {
            drawAt(time);
            taken.push_back(picture().copy());
        }
        return taken;
    }

    static osg::ref_ptr<osg::Node> makeCharacters()
    {
        osg::ref_ptr<osg::Node> model = osgDB::readRefNodeFile(ownScene("Wanderer.glb"));
        EXPECT_TRUE(findCharacter(*model)->getMeshes().setPixelError(0.5f)); // levels of detail survive, too
        findCharacter(*model)->getMeshes().waitForLevels();
        osg::ref_ptr<JointAttachment> hand = new JointAttachment("Hand_R");
        const osg::ref_ptr<osg::ShapeDrawable> box = new osg::ShapeDrawable(new osg::Box(osg::Vec3(), 0.3f));
        box->setUseDisplayList(false); // Mesa's zink leaves one out now and then
        box->setUseVertexBufferObjects(true);
        hand->addChild(box);
        findCharacter(*model)->addChild(hand);
        osg::ref_ptr<osg::Group> scene = new osg::Group;
        scene->addChild(placed(model, osg::Matrix::translate(-2, 0, 0)));
        const osg::Matrix turned = osg::Matrix::rotate(1.0, 0, 0, 1) * osg::Matrix::translate(2, 0, 0);
        scene->addChild(placed(placed(model, osg::Matrix::scale(1.3, 1.3, 1.3)), turned));
        osg::ref_ptr<osg::Node> other = osg::clone(model.get(), osg::CopyOp::DEEP_COPY_NODES);
        findCharacter(*other)->getController().seek(0.3);
        scene->addChild(placed(other, osg::Matrix::translate(0, 0, 2)));
        return scene;
    }

    static osg::ref_ptr<osg::Node> makeCrowds()
    {
        const osg::ref_ptr<osgDB::Options> options = new osgDB::Options("spacing=2");
        osg::ref_ptr<osg::Node> crowd = osgDB::readRefNodeFile(ownScene("Wanderer.glb.2x2.crowd"), options);
        osg::ref_ptr<osg::Group> scene = new osg::Group;
        // Many materials of People differ in nothing but their names, by which outfits colour them.
        options->setOptionString("spacing=1 outfits=\"" + ownScene("People.outfits.json") + '"');
        const osg::ref_ptr<osg::Node> people = osgDB::readRefNodeFile(ownScene("People.glb.2x2.crowd"), options);
        scene->addChild(placed(people, osg::Matrix::translate(2, -2, -2)));
        scene->addChild(placed(crowd, osg::Matrix::translate(-2, 0, 0)));
        scene->addChild(placed(osg::clone(crowd.get(), osg::CopyOp::DEEP_COPY_NODES),
                               osg::Matrix::rotate(1.0, 0, 0, 1) * osg::Matrix::translate(2, 0, 1)));
        return scene;
    }

    StoredScene plugins;
};

} // namespace

TEST_P(OptimizerGLTest, charactersAndCrowdsLookTheSame)
{
    for (const auto make : {makeCharacters, makeCrowds})
    {
        SCOPED_TRACE(make == makeCharacters ? "characters" : "crowds");
        const osg::ref_ptr<osg::Node> plain = make();
        const auto expected = pictures(*plain);
        EXPECT_GT(Picture::pixelsDifferent(*expected[0], *expected[1]), 20) << "nothing moves";
        const osg::ref_ptr<osg::Node> optimized = make();
        // Twice, because osgviewer optimizes a scene again that osgconv has optimized.
        osgUtil::Optimizer().optimize(optimized, GetParam());
        osgUtil::Optimizer().optimize(optimized, GetParam());
        EXPECT_EQ(findCharacter(*optimized) != nullptr, make == makeCharacters);
        // Reordered triangles have new levels.
        waitForLevels(*optimized);
        const auto found = pictures(*optimized);
        for (std::size_t i = 0; i < expected.size(); ++i)
        {
            // Flattened matrices round differently, which moves edges.
            EXPECT_LE(Picture::pixelsDifferent(*expected[i], *found[i]), 12) << "picture " << i;
        }
        if (GetParam() != Flags::DEFAULT_OPTIMIZATIONS) continue;
        EXPECT_TRUE(osgDB::writeNodeFile(*optimized, plugins.folder.file("optimized.osgb"))) << "as osgconv does";
        EXPECT_TRUE(osgDB::readRefNodeFile(plugins.folder.file("optimized.osgb")));
    }
}

INSTANTIATE_TEST_SUITE_P(Flags, OptimizerGLTest, ::testing::ValuesIn(flagCases()),
                         [](const auto& info) { return "flags" + std::to_string(info.param); });

} // namespace osgGpuAnimation
