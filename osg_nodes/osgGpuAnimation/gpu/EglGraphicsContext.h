// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Result.h>

#include <osg/GraphicsContext>

namespace osgGpuAnimation
{

/// An OSG graphics context without a window or a display server: EGL with a pbuffer, so that the default framebuffer is
/// complete. For servers, tools and tests; it takes the place of a window in osgViewer, in all its threading models.
///
///     Result<osg::ref_ptr<EglGraphicsContext>> made = EglGraphicsContext::create(800, 600);
///     if (!made) { OSG_WARN << made.error().message << std::endl; return; }
///     viewer.getCamera()->setGraphicsContext(made.value());
///     viewer.getCamera()->setViewport(0, 0, 800, 600);
///
/// or by hand: `context->realize(); context->makeCurrent(); …; context->releaseContext();`.
/// Pictures are read with glReadPixels, in a camera's final draw callback for instance; there is nothing to swap.
///
/// Mesa's surfaceless platform is tried first (a software renderer gives the same pictures everywhere), then EGL's
/// devices, then EGL's default display; the environment variable OSGGPUANIMATION_EGL_PLATFORM (surfaceless, device or
/// default) asks for one of them. The process keeps the display it opened first.
class EglGraphicsContext : public osg::GraphicsContext
{
public:
    /// Of the traits count: width, height; red, green, blue, alpha, depth, stencil (bits, at least); samples (where the
    /// platform has no such multisampling, the context has none, and getTraits() says so); sharedContext (an
    /// EglGraphicsContext); glContextProfileMask (1 core, 2 compatibility, 0: compatibility) and glContextVersion
    /// ("major.minor"; below 3.2 it is not looked at; core is 3.3 at least).
    /// Errors: no EGL display, no such configuration, profile or size; the message has EGL's error code.
    static Result<osg::ref_ptr<EglGraphicsContext>> create(osg::GraphicsContext::Traits* traits);
    /// 24 bits of depth, 8 of stencil, no multisampling, compatibility profile.
    static Result<osg::ref_ptr<EglGraphicsContext>> create(int width, int height);

    bool isCoreProfile() const { return _core; } ///< true for a core profile context

    /// True if the object is an EglGraphicsContext.
    bool isSameKindAs(const osg::Object* object) const override
    {
        return dynamic_cast<const EglGraphicsContext*>(object) != nullptr;
    }
    const char* libraryName() const override { return "osgGpuAnimation"; }
    const char* className() const override { return "EglGraphicsContext"; }

    bool valid() const override { return _context != nullptr; }
    /// Afterwards osg::State knows the GL's extensions, and no GL error is left over from asking for them.
    bool realizeImplementation() override;
    bool isRealizedImplementation() const override { return _realized; }
    void closeImplementation() override;
    bool makeCurrentImplementation() override;
    /// Draws here and reads from the other, which must be an EglGraphicsContext.
    bool makeContextCurrentImplementation(osg::GraphicsContext* readContext) override;
    bool releaseContextImplementation() override;
    /// Not offered (warns): render to a texture with a frame buffer object.
    void bindPBufferToTextureImplementation(GLenum buffer) override;
    void swapBuffersImplementation() override;

protected:
    EglGraphicsContext() = default;
    ~EglGraphicsContext() override;

private:
    Result<bool> open();
    void setUpState();

    // EGL's handles (all pointers to void), so that this header needs no EGL.
    void* _display = nullptr;
    void* _context = nullptr;
    void* _surface = nullptr;
    bool _core = false;
    bool _realized = false;
};

} // namespace osgGpuAnimation
