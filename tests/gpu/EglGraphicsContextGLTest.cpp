// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/gpu/EglGraphicsContext.h>

#include "support/GLTest.h"
#include "support/Picture.h"
#include "support/Results.h"
#include "support/ThreadingModels.h"

#include <osg/Geometry>
#include <osg/GLExtensions>
#include <osgViewer/GraphicsWindow>
#include <osgViewer/Viewer>

#include <array>
#include <utility>

#ifndef GL_RED_BITS // an OSG without the fixed pipeline
#define GL_RED_BITS 0x0D52
#define GL_GREEN_BITS 0x0D53
#define GL_BLUE_BITS 0x0D54
#define GL_ALPHA_BITS 0x0D55
#define GL_DEPTH_BITS 0x0D56
#define GL_STENCIL_BITS 0x0D57
#endif

namespace osgGpuAnimation
{
namespace
{

using Colour = std::array<unsigned char, 4>;

Colour readPixel(int x, int y)
{
    Colour colour{};
    glReadPixels(x, y, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, colour.data());
    return colour;
}

Colour clearAndRead(float red, float green, float blue)
{
    glClearColor(red, green, blue, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    return readPixel(5, 5);
}

/// Returns 1 for the core profile, 2 for the compatibility profile.
GLint profileMask()
{
    constexpr GLenum contextProfileMask = 0x9126; // GL_CONTEXT_PROFILE_MASK, which older GL headers do not have
    GLint mask = 0;
    glGetIntegerv(contextProfileMask, &mask);
    return mask;
}

osg::ref_ptr<osg::GraphicsContext::Traits> sizedTraits(int width, int height)
{
    osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
    traits->width = width;
    traits->height = height;
    return traits;
}

using CoreContextGLTest = InCoreProfile<GLTest>;

} // namespace

using EglGraphicsContextGLTest = GLTest;

TEST_F(EglGraphicsContextGLTest, isACompatibilityContextThatOsgKnows)
{
    ASSERT_TRUE(context().valid());
    EXPECT_TRUE(context().isRealized());
    EXPECT_FALSE(static_cast<EglGraphicsContext&>(context()).isCoreProfile());
    const osg::GLExtensions* extensions = state().get<osg::GLExtensions>();
    ASSERT_NE(extensions, nullptr);
    EXPECT_GE(extensions->glVersion, 3.3f);
    EXPECT_NE(extensions->glBeginTransformFeedback, nullptr);
    EXPECT_NE(extensions->glTexBuffer, nullptr);
    EXPECT_EQ(profileMask(), 2);
}

TEST_F(EglGraphicsContextGLTest, drawsAndReadsBack)
{
    EXPECT_EQ(state().get<osg::GLExtensions>()->glCheckFramebufferStatus(GL_FRAMEBUFFER_EXT),
              static_cast<GLenum>(GL_FRAMEBUFFER_COMPLETE_EXT));
    EXPECT_EQ(clearAndRead(1.0f, 0.2f, 0.0f), (Colour{255, 51, 0, 255}));
    GLint bits = 0;
    glGetIntegerv(GL_DEPTH_BITS, &bits);
    EXPECT_GE(bits, 24);
    glGetIntegerv(GL_STENCIL_BITS, &bits);
    EXPECT_GE(bits, 8);
}

TEST_F(EglGraphicsContextGLTest, twoContextsKeepTheirOwnPictures)
{
    const auto made = valueOf(EglGraphicsContext::create(32, 16));
    EglGraphicsContext& other = *made;
    EXPECT_EQ(clearAndRead(1.0f, 0.0f, 0.0f), (Colour{255, 0, 0, 255}));

    ASSERT_TRUE(other.realize());
    EXPECT_EQ(readPixel(5, 5), (Colour{255, 0, 0, 255})) << "realize() gives the thread its context back";
    EXPECT_NE(other.getState()->getContextID(), state().getContextID());
    ASSERT_TRUE(other.makeCurrent());
    EXPECT_EQ(clearAndRead(0.0f, 1.0f, 0.0f), (Colour{0, 255, 0, 255}));

    ASSERT_TRUE(context().makeContextCurrent(&other));
    EXPECT_EQ(readPixel(5, 5), (Colour{0, 255, 0, 255})) << "reads from the other";
    ASSERT_TRUE(context().makeCurrent());
    EXPECT_EQ(readPixel(5, 5), (Colour{255, 0, 0, 255}));
}

TEST_F(EglGraphicsContextGLTest, sharedContextsShareTexturesAndContextID)
{
    osg::ref_ptr<osg::GraphicsContext::Traits> traits = sizedTraits(8, 8);
    traits->sharedContext = &context();
    const auto made = valueOf(EglGraphicsContext::create(traits.get()));
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    ASSERT_TRUE(made->realize());
    ASSERT_TRUE(made->makeCurrent());
    EXPECT_TRUE(glIsTexture(texture));
    EXPECT_EQ(made->getState()->getContextID(), state().getContextID());
}

TEST_F(EglGraphicsContextGLTest, multisamplesOrSaysThatItDoesNot)
{
    osg::ref_ptr<osg::GraphicsContext::Traits> traits = sizedTraits(16, 16);
    traits->sampleBuffers = 1;
    traits->samples = 4;
    const auto made = valueOf(EglGraphicsContext::create(traits.get()));
    ASSERT_TRUE(made->realize());
    ASSERT_TRUE(made->makeCurrent());
    GLint samples = -1;
    glGetIntegerv(GL_SAMPLES, &samples);
    EXPECT_EQ(samples > 0, made->getTraits()->samples > 0);
    const std::string renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    const std::string version = reinterpret_cast<const char*>(glGetString(GL_VERSION));
    const bool hasSamples = renderer.find("llvmpipe") == 0 && version.find("Mesa 22.") != std::string::npos;
    EXPECT_TRUE(samples == 4 || !hasSamples) << samples;
    EXPECT_EQ(clearAndRead(0.0f, 0.2f, 1.0f), (Colour{0, 51, 255, 255}));
}

// EGL lists deeper colours and those with alpha first.
TEST_F(EglGraphicsContextGLTest, hasTheColorBitsAskedFor)
{
    for (const unsigned int alpha : {0u, 8u})
    {
        osg::ref_ptr<osg::GraphicsContext::Traits> traits = sizedTraits(16, 16);
        traits->alpha = alpha;
        const auto made = valueOf(EglGraphicsContext::create(traits.get()));
        ASSERT_TRUE(made->realize() && made->makeCurrent());
        const std::pair<GLenum, GLint> bits[] = {
            {GL_RED_BITS, 8}, {GL_GREEN_BITS, 8}, {GL_BLUE_BITS, 8}, {GL_ALPHA_BITS, static_cast<GLint>(alpha)}};
        for (const auto& [name, expected] : bits)
        {
            GLint found = -1;
            glGetIntegerv(name, &found);
            EXPECT_EQ(found, expected) << name << " with " << alpha << " bits of alpha";
        }
        made->close();
        EXPECT_FALSE(made->valid());
        EXPECT_FALSE(made->isRealized());
        EXPECT_FALSE(made->makeCurrent()) << "closed";
    }
    ASSERT_TRUE(context().makeCurrent());
}

TEST_F(EglGraphicsContextGLTest, refusesWhatCannotBe)
{
    EXPECT_FALSE(EglGraphicsContext::create(nullptr));
    EXPECT_FALSE(EglGraphicsContext::create(0, 10));
    EXPECT_FALSE(EglGraphicsContext::create(10, -1));
    osg::ref_ptr<osg::GraphicsContext::Traits> traits = sizedTraits(16, 16);
    traits->sharedContext = new osgViewer::GraphicsWindowEmbedded(0, 0, 16, 16);
    EXPECT_EQ(errorOf(EglGraphicsContext::create(traits.get())), "EGL: sharedContext is not an EglGraphicsContext");
    traits->sharedContext = nullptr;
    traits->glContextVersion = "9.1";
    EXPECT_TRUE(hasError(EglGraphicsContext::create(traits.get()), "version and profile"));
}

TEST_F(CoreContextGLTest, isACoreContext)
{
    EXPECT_TRUE(static_cast<EglGraphicsContext&>(context()).isCoreProfile());
    EXPECT_TRUE(state().getUseModelViewAndProjectionUniforms());
    EXPECT_EQ(clearAndRead(1.0f, 0.2f, 0.0f), (Colour{255, 51, 0, 255}));
    EXPECT_NO_GL_ERROR();
    EXPECT_EQ(profileMask(), 1);
}

TEST_F(EglGraphicsContextGLTest, takesAWindowsPlaceInEveryThreadingModel)
{
    context().releaseContext();
    for (const osgViewer::ViewerBase::ThreadingModel model : threadingModels)
    {
        SCOPED_TRACE(model);
        const auto made = valueOf(EglGraphicsContext::create(64, 48));
        // A white square covers the middle half of the picture.
        osg::ref_ptr<osg::Geometry> square = osg::createTexturedQuadGeometry({-0.5, 0, -0.5}, {1, 0, 0}, {0, 0, 1});
        square->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
        square->setUseVertexBufferObjects(true);
        osg::ref_ptr<Picture> picture = new Picture;
        osgViewer::Viewer viewer;
        osg::Camera* camera = viewer.getCamera();
        camera->setGraphicsContext(made);
        camera->setViewport(0, 0, 64, 48);
        camera->setClearColor({0, 0, 1, 1});
        camera->setProjectionMatrixAsOrtho(-1, 1, -1, 1, 0.1, 10);
        camera->setViewMatrixAsLookAt({0, -5, 0}, {0, 0, 0}, {0, 0, 1});
        camera->setFinalDrawCallback(picture);
        viewer.setSceneData(square);
        viewer.setThreadingModel(model);
        viewer.realize();
        ASSERT_TRUE(viewer.isRealized());
        for (int frame = 0; frame < 4; ++frame)
            viewer.frame();
        viewer.stopThreading();
        ASSERT_EQ(picture->image().s(), 64);
        EXPECT_EQ(picture->pixelsDrawn(), 32 * 24);
        EXPECT_EQ(picture->image().getColor(2, 2), osg::Vec4(0, 0, 1, 1));
    }
}

} // namespace osgGpuAnimation
