// SPDX-License-Identifier: MIT
#include "frame/GlCallTrace.h"
#include "support/TestCharacter.h"
#include "support/ViewerGLTest.h"

#include <osg/MatrixTransform>
#include <osg/Texture2D>
#include <osgUtil/GLObjectsVisitor>
#include <osgUtil/IncrementalCompileOperation>

#include <algorithm>

namespace osgGpuAnimation
{

namespace
{

/// The first frame after a compile traversal.
class FirstDrawGLTest : public ViewerGLTest
{
protected:
    /// A new context and a viewer that has drawn an empty scene.
    osg::Group& beginAgain()
    {
        TearDown();
        SetUp();
        _root = new osg::Group;
        pictureOf(_root, {0.0});
        return *_root;
    }

    void compileAtOnce(osg::Node& node)
    {
        osgUtil::GLObjectsVisitor visitor;
        visitor.setState(&state());
        visitor.compile(node);
    }

    /// As a DatabasePager has it: traversed in one thread, compiled in the next frames.
    void compileByAndBy(osg::Node& node)
    {
        const osg::ref_ptr<osgUtil::IncrementalCompileOperation> operation = new osgUtil::IncrementalCompileOperation;
        operation->addGraphicsContext(&context());
        operation->add(new osgUtil::IncrementalCompileOperation::CompileSet(&node));
        for (int tries = 0; tries < 100 && !operation->getToCompile().empty(); ++tries)
        {
            operation->compileAllForNextFrame(1);
            (*operation)(&context());
        }
        EXPECT_TRUE(operation->getToCompile().empty());
        operation->removeGraphicsContext(&context());
    }

private:
    osg::ref_ptr<osg::Group> _root;
};

/// Characters beside each other, with a texture and state sets of their own and above.
osg::ref_ptr<osg::Node> makeCharacters(int count)
{
    const osg::ref_ptr<AnimatedCharacter> first = makeTestCharacter();
    auto& mesh = dynamic_cast<SkinnedGeometry&>(*first->getChild(0));
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(2, 2, 1, GL_RGB, GL_UNSIGNED_BYTE);
    std::fill_n(image->data(), image->getTotalSizeInBytes(), static_cast<unsigned char>(200));
    mesh.getOrCreateStateSet()->setTextureAttributeAndModes(0, new osg::Texture2D(image));
    mesh.setColorArray(new osg::Vec4Array(osg::Array::BIND_OVERALL, 1));
    (*static_cast<osg::Vec4Array*>(mesh.getColorArray()))[0] = osg::Vec4(1, 0.5f, 0, 1);
    osg::ref_ptr<osg::Group> group = new osg::Group;
    group->getOrCreateStateSet()->setMode(GL_CULL_FACE, osg::StateAttribute::OFF);
    for (int i = 0; i < count; ++i)
    {
        osg::ref_ptr<AnimatedCharacter> each = osg::clone(first.get(), osg::CopyOp::DEEP_COPY_NODES);
        each->setMatrix(osg::Matrix::translate(1.2 * i - 3.0, 0, 0));
        group->addChild(each);
    }
    return group;
}

} // namespace

TEST_F(FirstDrawGLTest, theFirstFrameAfterACompileTraversalCompilesNothing)
{
    for (const int characters : {1, 3})
        for (const bool isAtOnce : {true, false})
        {
            SCOPED_TRACE(testing::Message() << characters << (isAtOnce ? ", by GLObjectsVisitor" : ", incremental"));
            beginAgain().addChild(makeCharacters(characters));
            osg::ref_ptr<osg::Image> expected;
            {
                const GlCallTrace trace(state());
                drawAt(0.5);
                expected = picture().copy();
                EXPECT_GT(trace.count("glLinkProgram"), 1) << "otherwise the trace sees none";
            }
            EXPECT_GT(picture().pixelsDrawn(), 50);
            osg::Group& root = beginAgain();
            const osg::ref_ptr<osg::Node> scene = makeCharacters(characters);
            isAtOnce ? compileAtOnce(*scene) : compileByAndBy(*scene);
            root.addChild(scene);
            const GlCallTrace trace(state());
            drawAt(0.5);
            EXPECT_EQ(trace.count("glCompileShader"), 0);
            EXPECT_EQ(trace.count("glLinkProgram"), 0);
            EXPECT_EQ(Picture::pixelsDifferent(*expected, picture().image()), 0);
            EXPECT_NO_GL_ERROR();
        }
}

// Applications compile more than once: when they attach a scene, and after each change of the graphics context.
TEST_F(FirstDrawGLTest, aCompileTraversalBetweenFramesChangesNoPicture)
{
    osg::Group& root = beginAgain();
    root.addChild(makeCharacters(3));
    root.addChild(osg::createTexturedQuadGeometry({-3, 0, -3}, {1, 0, 0}, {0, 0, 1}));
    drawAt(0.5);
    drawAt(0.5);
    const osg::ref_ptr<osg::Image> before = picture().copy(), shown = new osg::Image;
    // In clip space, where matrices that no frame has set would draw it, it covers the picture.
    const osg::ref_ptr<AnimatedCharacter> wide = makeTestCharacter();
    const osg::Vec3 corners[] = {{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}};
    auto& mesh = dynamic_cast<SkinnedGeometry&>(*wide->getChild(0));
    mesh.setVertexArray(new osg::Vec3Array(4, const_cast<osg::Vec3*>(corners)));
    for (int round = 0; round < 3; ++round)
    {
        compileAtOnce(root);
        compileAtOnce(*wide);
        shown->readPixels(0, 0, before->s(), before->t(), before->getPixelFormat(), GL_UNSIGNED_BYTE);
        EXPECT_EQ(Picture::pixelsDifferent(*before, *shown), 0) << "it draws into the frame, round " << round;
        drawAt(0.5);
        EXPECT_EQ(Picture::pixelsDifferent(*before, picture().image()), 0) << round;
        EXPECT_NO_GL_ERROR();
        if (round == 1) root.releaseGLObjects(&state());
    }
}

} // namespace osgGpuAnimation
