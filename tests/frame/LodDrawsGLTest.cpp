// SPDX-License-Identifier: MIT
#include "mesh/Tube.h"
#include "support/PrimitiveCount.h"
#include "support/TestCrowd.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/frame/stage/LodSelection.h>

#include <set>

// Tests which meshes are drawn with fewer triangles, by the number of triangles in a frame.

namespace osgGpuAnimation
{

namespace
{

constexpr float pixelError = 100.0f; ///< selects the coarsest level of every mesh that has levels

class LodDrawsGLTest : public ViewerGLTest
{
protected:
    /// The number of triangles in the scene's second frame.
    GLuint trianglesOf(osg::Node& scene)
    {
        viewer().getCamera()->setProjectionMatrixAsOrtho(-20, 20, -20, 20, 1, 20);
        return trianglesDrawn(scene);
    }

    /// The same with the camera as it is.
    GLuint trianglesDrawn(osg::Node& scene)
    {
        _count->attach(*viewer().getCamera(), picture());
        pictureOf(&scene, {0.0, 0.1});
        return _count->primitives();
    }

private:
    osg::ref_ptr<PrimitiveCount> _count = new PrimitiveCount;
};

/// A mesh of that many vertices without triangles: it has no levels, and building them takes no time.
osg::ref_ptr<SkinnedGeometry> makeBlank(std::size_t vertices)
{
    const osg::ref_ptr<SkinnedGeometry> blank = new SkinnedGeometry;
    blank->setVertexArray(new osg::Vec3Array(static_cast<unsigned int>(vertices)));
    blank->setRigidEntry(0);
    return blank;
}

void fillUp(AnimatedCharacter& character)
{
    for (std::size_t vertices = 0; vertices < LodRange::maxVertices; vertices += LodLevels::maxVertices)
        character.addChild(makeBlank(LodLevels::maxVertices));
}

TEST_F(LodDrawsGLTest, whatComesAfterTheMostVerticesOrBelowOtherNodesIsDrawnWhole)
{
    const osg::ref_ptr<AnimatedCharacter> nested = makeTubeCharacter(armSet()), large = makeTubeCharacter(armSet());
    ASSERT_TRUE(large->getMeshes().setPixelError(pixelError));
    EXPECT_LT(trianglesOf(*large), tubeTriangles / 4);
    const osg::ref_ptr<osg::Group> group = new osg::Group;
    group->addChild(makeShownTube(nested->getAnimationSet()));
    nested->addChild(group);
    fillUp(*large);
    large->addChild(makeShownTube(large->getAnimationSet()));
    for (const auto& character : {nested, large})
        ASSERT_TRUE(character->getMeshes().setPixelError(pixelError));
    for (const auto& scene : std::vector<osg::ref_ptr<osg::Node>>{nested, large, makeCrowd(*large)})
    {
        const GLuint triangles = trianglesOf(*scene);
        EXPECT_GE(triangles, tubeTriangles) << scene->className();
        EXPECT_LT(triangles, tubeTriangles + tubeTriangles / 4) << scene->className();
    }
}

// The nearest point of the sphere selects the level, not its centre.
TEST_F(LodDrawsGLTest, whatReachesBehindTheEyeIsDrawnWhole)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTubeCharacter(armSet());
    ASSERT_TRUE(character->getMeshes().setPixelError(pixelError));
    const osg::BoundingSphere bound = character->getBound(); // the crowd's instance has the same
    for (const auto& animated : std::vector<osg::ref_ptr<osg::Node>>{character, makeCrowd(*character)})
    {
        const auto trianglesAt = [&](double radii)
        {
            osg::Camera& camera = *viewer().getCamera();
            camera.setProjectionMatrixAsPerspective(60, 1, 0.01, 1000);
            const osg::Vec3d centre = bound.center();
            camera.setViewMatrixAsLookAt(centre - osg::Vec3d(0, radii * bound.radius(), 0), centre, {0, 0, 1});
            return trianglesDrawn(*animated);
        };
        EXPECT_EQ(trianglesAt(0.9), tubeTriangles) << animated->className();
        EXPECT_LT(trianglesAt(1.3), tubeTriangles / 4) << animated->className();
    }
}

// An error of the mesh grows with the largest scale of its placement, whatever way that scale points.
TEST_F(LodDrawsGLTest, aTurnDoesNotChangeTheLevel)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTubeCharacter(armSet());
    std::set<GLuint> counts;
    for (const float error : {0.02f, 0.03f, 0.05f, 0.08f, 0.13f, 0.21f, 0.34f})
    {
        ASSERT_TRUE(character->getMeshes().setPixelError(error));
        std::vector<GLuint> triangles;
        for (const osg::Vec3d& towards : {osg::Vec3d(1, 0, 0), osg::Vec3d(1, 1, 1)})
        {
            const osg::Matrixd place = osg::Matrixd::scale(0.9, 0.1, 0.1) * osg::Matrixd::rotate({1, 0, 0}, towards);
            triangles.push_back(trianglesOf(*makeCrowd(*character, {place})));
        }
        EXPECT_EQ(triangles[0], triangles[1]) << error;
        counts.insert(triangles[0]);
    }
    EXPECT_GE(counts.size(), 3u);
}

TEST_F(LodDrawsGLTest, charactersOfASetHaveLevelsOfTheirOwnMeshes)
{
    const auto set = armSet();
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    for (int i = 0; i < 4; ++i)
    {
        const osg::ref_ptr<AnimatedCharacter> character = makeTubeCharacter(set);
        ASSERT_TRUE(character->getMeshes().setPixelError(pixelError));
        // The mesh is set after setPixelError(), so the cull traversal has to build its levels.
        character->setChild(0, makeShownTube(*set));
        if (i % 2 == 1) character->insertChild(0, makeBlank(1));
        scene->addChild(character);
    }
    EXPECT_LT(trianglesOf(*scene), tubeTriangles);
}

/// Far and near places in turn, whose tubes have levels of their own: three at each of 45, 90 and 270 units away.
osg::Matrixd placeAtDepth(int index)
{
    const double away = index % 3 == 0 ? 90.0 : index % 3 == 1 ? 45.0 : 270.0;
    return osg::Matrixd::translate((0.11 * (index / 3) - 0.2) * away, away - 10.0, (index % 3 - 1) * 0.16 * away);
}

// Characters share instanced draws by level: the first of a level is drawn alone, the others together.
TEST_F(LodDrawsGLTest, charactersThatAreDrawnTogetherHaveTheirOwnLevels)
{
    viewer().getCamera()->setProjectionMatrixAsPerspective(30, 1, 1, 1000);
    const osg::ref_ptr<AnimatedCharacter> first = makeTubeCharacter(armSet());
    ASSERT_TRUE(first->getMeshes().setPixelError(0.25f));
    const auto charactersOf = [&](int begin, int end)
    {
        osg::ref_ptr<osg::Group> group = new osg::Group;
        for (int i = begin; i < end; ++i)
        {
            const osg::ref_ptr<AnimatedCharacter> character = osg::clone(first.get(), osg::CopyOp::DEEP_COPY_NODES);
            character->setMatrix(placeAtDepth(i));
            group->addChild(character);
        }
        return group;
    };
    GLuint ofEach = 0;
    std::set<GLuint> counts;
    for (int i = 0; i < 9; ++i)
    {
        const GLuint triangles = trianglesDrawn(*charactersOf(i, i + 1));
        counts.insert(triangles);
        ofEach += triangles;
    }
    EXPECT_EQ(counts.size(), 3u) << "three levels";
    const osg::ref_ptr<osg::Group> apart = charactersOf(0, 9), together = charactersOf(0, 9);
    for (unsigned int i = 0; i < 9; ++i)
        static_cast<AnimatedCharacter*>(apart->getChild(i))->setDrawnTogether(false);
    EXPECT_EQ(trianglesDrawn(*apart), ofEach);
    const osg::ref_ptr<osg::Image> expected = picture().copy();
    EXPECT_GT(picture().pixelsDrawn(), 100);
    EXPECT_EQ(trianglesDrawn(*together), ofEach);
    EXPECT_LE(Picture::pixelsDifferent(*expected, picture().image()), 8) << "placements are floats in shared draws";
    double drawables = 0.0;
    osg::Stats& stats = *viewer().getCamera()->getStats();
    stats.collectStats("scene", true);
    drawAt(0.1);
    stats.getAttribute(viewer().getFrameStamp()->getFrameNumber(), "Visible number of drawables", drawables);
    EXPECT_EQ(drawables, 2.0 * 3.0);
}

// Instances of one level of detail share a draw: the draws of later levels start within the batch.
TEST_F(LodDrawsGLTest, tintsAreTheInstancesOwnAtEveryLevel)
{
    const osg::ref_ptr<AnimatedCharacter> tube = makeTubeCharacter(armSet());
    ASSERT_TRUE(tube->getMeshes().setPixelError(0.25f));
    viewer().getCamera()->setProjectionMatrixAsPerspective(30, 1, 1, 1000);
    const osg::ref_ptr<AnimatedCrowd> all = new AnimatedCrowd(*tube);
    const osg::ref_ptr<osg::Group> alone = new osg::Group;
    GLuint ofEach = 0;
    for (int i = 0; i < 9; ++i)
    {
        const osg::ref_ptr<AnimatedCrowd> one = new AnimatedCrowd(*tube);
        for (AnimatedCrowd* crowd : {all.get(), one.get()})
        {
            EXPECT_TRUE(crowd->setOrigin(osg::Vec3d()));
            const osg::Vec4 tint(0.3f * static_cast<float>(i % 3), 0.3f * static_cast<float>(i / 3), 1, 1);
            ASSERT_TRUE(crowd->add(placeAtDepth(i), tube->getController(), tint));
        }
        alone->addChild(one);
        ofEach += trianglesDrawn(*one);
    }
    EXPECT_EQ(trianglesDrawn(*alone), ofEach);
    const osg::ref_ptr<osg::Image> expected = picture().copy();
    EXPECT_GT(picture().pixelsDrawn(), 100);
    EXPECT_EQ(trianglesDrawn(*all), ofEach);
    EXPECT_EQ(Picture::pixelsDifferent(*expected, picture().image()), 0);
}

} // namespace

} // namespace osgGpuAnimation
