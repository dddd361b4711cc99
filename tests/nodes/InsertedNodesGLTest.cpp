// SPDX-License-Identifier: MIT
#include "support/TestCrowd.h"
#include "support/ViewerGLTest.h"

#include <osg/Group>
#include <osgFX/Scribe>

// Applications insert nodes above the mesh that a ray has hit (osgkeyboardmouse: an osgFX::Scribe). The mesh stays
// visible, in characters and in crowds.

namespace osgGpuAnimation
{

namespace
{

class InsertedNodesGLTest : public ViewerGLTest
{
protected:
    /// Inserts the node above the first mesh of each character and crowd.
    static void insert(osg::Group& scene, osg::Group& node)
    {
        for (unsigned int i = 0; i < scene.getNumChildren(); ++i)
        {
            osg::Group& parent = *scene.getChild(i)->asGroup();
            const osg::ref_ptr<osg::Group> inserted = osg::clone(&node, osg::CopyOp::SHALLOW_COPY);
            const osg::ref_ptr<osg::Node> mesh = parent.getChild(0);
            inserted->addChild(mesh);
            parent.replaceChild(mesh, inserted);
        }
    }

    void expectVisible(osg::Group& scene)
    {
        const osg::ref_ptr<osg::Image> before = pictureOf(&scene, {3.0, 3.5});
        const int drawn = picture().pixelsDrawn();
        EXPECT_GT(drawn, 100);
        insert(scene, *new osg::Group);
        const osg::ref_ptr<osg::Image> below = pictureOf(&scene, {4.0, 3.5});
        EXPECT_EQ(Picture::pixelsDifferent(*before, *below), 0);
        insert(scene, *new osgFX::Scribe);
        pictureOf(&scene, {4.0, 3.5});
        EXPECT_GE(picture().pixelsDrawn(), drawn);
        EXPECT_LE(picture().pixelsDrawn(), drawn + drawn / 2) << "lines at the edges alone";
    }
};

} // namespace

TEST_F(InsertedNodesGLTest, charactersStayVisible)
{
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    for (const double x : {-3.0, 0.5})
    {
        const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
        character->setMatrix(osg::Matrix::translate(x, 0, 0));
        scene->addChild(character);
    }
    expectVisible(*scene);
}

// With the origin far outside the picture, the bounds of the mesh below the crowd are there, too.
TEST_F(InsertedNodesGLTest, crowdsStayVisible)
{
    using Settings = osg::CullSettings;
    for (const auto mode : {Settings::DO_NOT_COMPUTE_NEAR_FAR, Settings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES})
        for (const osg::Vec3d& origin : {osg::Vec3d(0, 0, 0), osg::Vec3d(100, 0, 0), osg::Vec3d(0, -100, 0)})
        {
            SCOPED_TRACE(testing::Message() << origin.x() << " " << origin.y() << ", mode " << mode);
            viewer().getCamera()->setComputeNearFarMode(mode);
            const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
            EXPECT_TRUE(crowd->setOrigin(origin));
            addInstances(*crowd, {osg::Matrix::translate(-3, 0, 0), osg::Matrix::translate(0.5, 0, 0)},
                         playing("shift"));
            const osg::ref_ptr<osg::Group> scene = new osg::Group;
            scene->addChild(crowd);
            expectVisible(*scene);
        }
}

} // namespace osgGpuAnimation
