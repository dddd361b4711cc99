// SPDX-License-Identifier: MIT
#include "nodes/Tube.h"
#include "support/PrimitiveCount.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/frame/stage/LodSelection.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

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

    static osg::ref_ptr<AnimatedCrowd> crowdOf(const AnimatedCharacter& character)
    {
        const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(character);
        EXPECT_TRUE(crowd->add(osg::Matrix(), character.getController()));
        return crowd;
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

TEST_F(LodDrawsGLTest, whatComesAfterTheMostVerticesIsDrawnWhole)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTubeCharacter(armSet());
    ASSERT_TRUE(character->getMeshes().setPixelError(pixelError));
    EXPECT_LT(trianglesOf(*character), tubeTriangles / 4);
    fillUp(*character);
    character->addChild(makeShownTube(character->getAnimationSet()));
    ASSERT_TRUE(character->getMeshes().setPixelError(pixelError));
    for (const osg::ref_ptr<osg::Node>& scene : std::vector<osg::ref_ptr<osg::Node>>{character, crowdOf(*character)})
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
    for (const auto& animated : std::vector<osg::ref_ptr<osg::Node>>{character, crowdOf(*character)})
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
            const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*character);
            const osg::Matrixd place = osg::Matrixd::scale(0.9, 0.1, 0.1) * osg::Matrixd::rotate({1, 0, 0}, towards);
            ASSERT_TRUE(crowd->add(place, character->getController()));
            triangles.push_back(trianglesOf(*crowd));
        }
        EXPECT_EQ(triangles[0], triangles[1]) << error;
        counts.insert(triangles[0]);
    }
    EXPECT_GE(counts.size(), 3u);
}

TEST_F(LodDrawsGLTest, whatIsNotTheCharactersOwnChildIsDrawnWhole)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTubeCharacter(armSet());
    ASSERT_TRUE(character->getMeshes().setPixelError(pixelError));
    const osg::ref_ptr<osg::Group> group = new osg::Group;
    group->addChild(makeShownTube(character->getAnimationSet()));
    character->addChild(group);
    const GLuint triangles = trianglesOf(*character);
    EXPECT_GE(triangles, tubeTriangles);
    EXPECT_LT(triangles, tubeTriangles + tubeTriangles / 4);
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

    const osg::ref_ptr<AnimatedCharacter> large = makeTubeCharacter(set);
    ASSERT_TRUE(large->getMeshes().setPixelError(pixelError));
    fillUp(*large);
    large->addChild(makeShownTube(*set));
    scene->addChild(large);
    const GLuint triangles = trianglesOf(*scene);
    EXPECT_GE(triangles, tubeTriangles);
    EXPECT_LT(triangles, 2 * tubeTriangles);
}

} // namespace

} // namespace osgGpuAnimation
