// SPDX-License-Identifier: MIT
#include "support/TestCharacter.h"
#include "support/ViewerGLTest.h"

#include <osg/GLExtensions>
#include <osg/Group>

#include <array>
#include <functional>

namespace osgGpuAnimation
{

namespace
{

/// GL objects are created and deleted with contexts, scenes and sets.
class GlObjectsGLTest : public ViewerGLTest
{
protected:
    /// The numbers of buffers, textures and programs that exist, by testing every name that may be in use.
    std::array<int, 3> count()
    {
        const osg::GLExtensions* gl = state().get<osg::GLExtensions>();
        std::array<int, 3> result{};
        for (GLuint name = 1; name < 5000; ++name)
        {
            result[0] += gl->glIsBuffer(name);
            result[1] += glIsTexture(name);
            result[2] += gl->glIsProgram(name);
        }
        return result;
    }
};

TEST_F(GlObjectsGLTest, charactersSurviveTheReleaseOfTheirGlObjectsAndMoveToAnotherContext)
{
    osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    const osg::ref_ptr<osg::Image> expected = pictureOf(character, {0.0});
    EXPECT_GT(picture().pixelsDrawn(), 0);
    const std::function<void()> changes[] = {[&] { character->releaseGLObjects(&state()); },
                                             [&] { character->resizeGLObjectBuffers(16); },
                                             [&] { TearDown(), SetUp(); }, [&] { TearDown(), SetUp(); }};
    for (const auto& change : changes)
    {
        change();
        EXPECT_EQ(Picture::pixelsDifferent(*expected, *pictureOf(character, {0.0})), 0) << &change - changes;
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
    const std::array<int, 3> before = count();
    for (int number = 5; number < 1000; ++number)
        round(number);
    EXPECT_EQ(count(), before);
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
