// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/Result.h>

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
/// Read the pixels with glReadPixels, for example in a camera's final draw callback. Swapping has no effect.
///
/// It tries Mesa's surfaceless platform first (a software renderer gives the same pixels everywhere), then EGL's
/// devices, then EGL's default display. The environment variable OSGGPUANIMATION_EGL_PLATFORM (surfaceless, device or
/// default) selects one of them. The process keeps the display that it opened first.
class EglGraphicsContext : public osg::GraphicsContext
{
public:
    /// Uses these traits: width, height; red, green, blue, alpha, depth, stencil (least numbers of bits); samples (if
    /// the platform does not support that number, the context has no multisampling and getTraits() has 0 samples, for
    /// example in Mesa 25.0, whose multisampled pbuffers have no colour buffer);
    /// sharedContext (an EglGraphicsContext); glContextProfileMask (1 core, 2 compatibility, 0: compatibility);
    /// glContextVersion ("major.minor"; ignored below 3.2; core is at least 3.3).
    /// Errors: no EGL display, no such configuration, profile or size; the message contains EGL's error code.
    static Result<osg::ref_ptr<EglGraphicsContext>> create(osg::GraphicsContext::Traits* traits);
    /// Creates a context with 24 depth bits, 8 stencil bits, no multisampling and the compatibility profile.
    static Result<osg::ref_ptr<EglGraphicsContext>> create(int width, int height);

    /// True for a core profile, false for a compatibility profile.
    bool isCoreProfile() const { return _core; }

    /// True if the object is an EglGraphicsContext.
    bool isSameKindAs(const osg::Object* object) const override
    {
        return dynamic_cast<const EglGraphicsContext*>(object) != nullptr;
    }
    const char* libraryName() const override { return "osgGpuAnimation"; }
    const char* className() const override { return "EglGraphicsContext"; }

    bool valid() const override { return _context != nullptr; }
    /// Initializes the GL extensions of osg::State and clears the GL errors of that query.
    bool realizeImplementation() override;
    bool isRealizedImplementation() const override { return _realized; }
    void closeImplementation() override;
    bool makeCurrentImplementation() override;
    /// Draws here and reads from the other, which must be an EglGraphicsContext.
    bool makeContextCurrentImplementation(osg::GraphicsContext* readContext) override;
    bool releaseContextImplementation() override;
    /// Not supported (warns): render to a texture with a frame buffer object.
    void bindPBufferToTextureImplementation(GLenum buffer) override;
    void swapBuffersImplementation() override;

protected:
    EglGraphicsContext() = default;
    ~EglGraphicsContext() override;

private:
    Result<void> open();
    /// Creates _context and _surface as the traits say.
    Result<void> createSurface();
    void destroySurface();
    /// True if pixels of _surface can be read. In Mesa 25.0 that is an error if it has samples.
    bool hasColors() const;
    void setUpState();

    // EGL's handles are pointers to void, so this header does not need EGL's.
    void* _display = nullptr;
    void* _context = nullptr;
    void* _surface = nullptr;
    bool _core = false;
    bool _realized = false;
};

} // namespace osgGpuAnimation
