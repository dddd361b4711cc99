// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/gpu/OffscreenContext.h>

#include <osg/GL>
#include <osg/State>

#include <gtest/gtest.h>

#include <cstdlib>
#include <iomanip>
#include <sstream>
#include <string>

namespace osgGpuAnimation
{

/// A test that needs GL: it starts with an offscreen context of 64x64 current, and fails if GL reports an error that
/// it left behind. Test classes that derive from it (or are it) are named ...GLTest.
///
///     using PosePipelineGLTest = GLTest;
///     TEST_F(PosePipelineGLTest, writesOneEntryAJoint) { … context().getState() … EXPECT_NO_GL_ERROR(); }
///
/// Without a context the test is skipped with the reason; with OSGGPUANIMATION_REQUIRE_GL in the environment, as in
/// CI, it fails.
class GLTest : public ::testing::Test
{
protected:
    /// The picture's width and height in pixels.
    virtual int pictureSide() const { return 64; }

    /// The options of the context; a derived fixture sets more samples, the core profile and so on.
    virtual osg::ref_ptr<osg::GraphicsContext::Traits> traits() const
    {
        osg::ref_ptr<osg::GraphicsContext::Traits> wanted = new osg::GraphicsContext::Traits;
        wanted->width = wanted->height = pictureSide();
        wanted->stencil = 8;
        return wanted;
    }

    void SetUp() override
    {
        Result<osg::ref_ptr<osg::GraphicsContext>> made = createOffscreenContext(traits().get());
        const std::string reason = made ? "the context does not realize" : made.error().message;
        if (!made || !made.value()->realize() || !made.value()->makeCurrent())
        {
            if (std::getenv("OSGGPUANIMATION_REQUIRE_GL")) FAIL() << "GL is required and there is none: " << reason;
            GTEST_SKIP() << "no GL: " << reason;
        }
        _context = made.value();
        state().initializeExtensionProcs();
        const char* expected = std::getenv("OSGGPUANIMATION_RENDERER"); // see tests/zink.sh
        const std::string renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
        ASSERT_TRUE(!expected || renderer.find(expected) != std::string::npos) << renderer;
    }

    void TearDown() override
    {
        if (!_context) return;
        if (_context->isRealized() && _context->makeCurrent())
        {
            EXPECT_EQ(takeGLErrors(), "");
        }
        _context->close();
        _context = nullptr;
    }

    osg::GraphicsContext& context() { return *_context; }
    osg::State& state() { return *_context->getState(); }

    /// Takes the pending errors from GL, as "0x0502 …"; empty if there are none.
    static std::string takeGLErrors()
    {
        std::ostringstream errors;
        for (int kept = 0; kept < 32; ++kept)
        {
            const GLenum error = glGetError();
            if (error == GL_NO_ERROR) break;
            errors << "0x" << std::hex << std::setw(4) << std::setfill('0') << error << " ";
        }
        return errors.str();
    }

private:
    osg::ref_ptr<osg::GraphicsContext> _context;
};

/// The fixture in a context of the core profile.
template <typename Fixture>
class InCoreProfile : public Fixture
{
protected:
    osg::ref_ptr<osg::GraphicsContext::Traits> traits() const override
    {
        osg::ref_ptr<osg::GraphicsContext::Traits> wanted = Fixture::traits();
        wanted->glContextVersion = "3.3";
        wanted->glContextProfileMask = 1;
        return wanted;
    }
};

} // namespace osgGpuAnimation

/// Fails the test, with the error code, if GL has a pending error.
#define EXPECT_NO_GL_ERROR() EXPECT_EQ(::osgGpuAnimation::GLTest::takeGLErrors(), "")
