// SPDX-License-Identifier: MIT
#include "support/TestCharacter.h"
#include "support/ViewerGLTest.h"

#include <osg/GLExtensions>
#include <osg/Group>

namespace osgGpuAnimation
{

namespace
{

/// GL objects are created and deleted with contexts, scenes and sets.
class GlObjectsGLTest : public ViewerGLTest
{
protected:
    struct Count
    {
        int buffers = 0;
        int textures = 0;
        int programs = 0;
    };

    /// Counts the existing GL objects by testing every name that may be in use.
    Count count()
    {
        constexpr GLuint namesToTry = 5000;
        const osg::GLExtensions* gl = state().get<osg::GLExtensions>();
        Count result;
        for (GLuint name = 1; name < namesToTry; ++name)
        {
            if (gl->glIsBuffer(name)) ++result.buffers;
            if (glIsTexture(name)) ++result.textures;
            if (gl->glIsProgram(name)) ++result.programs;
        }
        return result;
    }
};

TEST_F(GlObjectsGLTest, charactersSurviveTheReleaseOfTheirGlObjects)
{
    osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    viewer().setSceneData(character);
    drawAt(0);
    const int drawn = picture().pixelsDrawn();
    EXPECT_GT(drawn, 0);
    character->releaseGLObjects(&state());
    drawAt(0);
    EXPECT_EQ(picture().pixelsDrawn(), drawn);
    character->resizeGLObjectBuffers(16);
    drawAt(0);
    EXPECT_EQ(picture().pixelsDrawn(), drawn);
}

TEST_F(GlObjectsGLTest, aSceneMovesToAnotherContext)
{
    osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    int drawn = 0;
    for (int round = 0; round < 3; ++round)
    {
        viewer().setSceneData(character);
        drawAt(0);
        if (round == 0) drawn = picture().pixelsDrawn();
        EXPECT_GT(drawn, 0);
        EXPECT_EQ(picture().pixelsDrawn(), drawn) << "context " << round;
        TearDown();
        SetUp();
    }
}

TEST_F(GlObjectsGLTest, addingAndRemovingCharactersLeavesNothingBehind)
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    viewer().setSceneData(root);
    const auto round = [&](int number)
    {
        osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
        root->addChild(character);
        drawAt(0.1 * number);
        root->removeChild(character);
        character = nullptr;
        drawAt(0.1 * number + 0.05);
        // OSG deletes objects when a frame has time left; this deletes them now.
        osg::flushAllDeletedGLObjects(state().getContextID());
    };
    for (int number = 0; number < 5; ++number)
        round(number);
    const Count before = count();
    for (int number = 5; number < 1000; ++number)
        round(number);
    const Count after = count();
    EXPECT_EQ(after.buffers, before.buffers);
    EXPECT_EQ(after.textures, before.textures);
    EXPECT_EQ(after.programs, before.programs);
}

// The DatabasePager compiles between frames, and so does osgviewer when it first shows its help or statistics.
TEST_F(GlObjectsGLTest, whatIsCompiledBetweenFramesTakesNothingFromThem)
{
    osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    auto& mesh = dynamic_cast<SkinnedGeometry&>(*character->getChild(0));
    const GLushort corners[] = {0, 1, 2, 0, 2, 3};
    mesh.setPrimitiveSet(0, new osg::DrawElementsUShort(GL_TRIANGLES, 6, corners));
    viewer().setSceneData(character);
    drawAt(0.0);
    drawAt(0.0);
    EXPECT_GT(picture().pixelsDrawn(), 50);
    const osg::ref_ptr<osg::Image> before = picture().copy();

    osg::ref_ptr<osg::Geometry> other = new osg::Geometry;
    other->setUseDisplayList(false);
    other->setUseVertexBufferObjects(true);
    other->setVertexArray(new osg::Vec3Array(3));
    const GLushort triangle[] = {0, 1, 2};
    other->addPrimitiveSet(new osg::DrawElementsUShort(GL_TRIANGLES, 3, triangle));
    osg::RenderInfo renderInfo(&state(), nullptr);
    other->compileGLObjects(renderInfo);

    drawAt(0.0);
    EXPECT_NO_GL_ERROR();
    EXPECT_EQ(Picture::pixelsDifferent(*before, *picture().copy()), 0);
}

} // namespace

} // namespace osgGpuAnimation
