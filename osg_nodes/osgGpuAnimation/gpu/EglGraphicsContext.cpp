// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/gpu/EglGraphicsContext.h>

#include <osgGpuAnimation/gpu/detail/FixedPipeline.h>

#include <osg/DisplaySettings>
#include <osg/Fog>
#include <osg/Light>
#include <osg/Material>
#include <osg/Notify>
#include <osg/TexGen>
#include <osg/Texture1D>
#include <osg/TextureRectangle>

#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>
#include <cstdlib>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

Error eglFailure(const std::string& what)
{
    std::ostringstream message;
    message << "EGL: " << what << " (error 0x" << std::hex << eglGetError() << ")";
    return {message.str()};
}

bool hasClientExtension(const std::string& name)
{
    const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    return extensions && (" " + std::string(extensions) + " ").find(" " + name + " ") != std::string::npos;
}

/// Initializes the display; EGL_NO_DISPLAY if that fails or the display does not support desktop GL.
EGLDisplay started(EGLDisplay display)
{
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr)) return EGL_NO_DISPLAY;
    const char* interfaces = eglQueryString(display, EGL_CLIENT_APIS);
    const bool desktop = interfaces && (std::string(interfaces) + " ").find("OpenGL ") != std::string::npos;
    return desktop ? display : EGL_NO_DISPLAY;
}

EGLDisplay openSurfaceless()
{
    if (!hasClientExtension("EGL_MESA_platform_surfaceless")) return EGL_NO_DISPLAY;
    return started(eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
}

EGLDisplay openDevice()
{
    const auto queryDevices = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
    if (!queryDevices || !hasClientExtension("EGL_EXT_platform_device")) return EGL_NO_DISPLAY;
    std::array<EGLDeviceEXT, 16> devices{};
    EGLint count = 0;
    if (!queryDevices(static_cast<EGLint>(devices.size()), devices.data(), &count)) return EGL_NO_DISPLAY;
    for (EGLint i = 0; i < count; ++i)
    {
        EGLDeviceEXT device = devices[static_cast<std::size_t>(i)];
        EGLDisplay display = started(eglGetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, device, nullptr));
        if (display != EGL_NO_DISPLAY) return display;
    }
    return EGL_NO_DISPLAY;
}

EGLDisplay openAny()
{
    static constexpr std::pair<const char*, EGLDisplay (*)()> platforms[]{
        {"surfaceless", openSurfaceless},
        {"device", openDevice},
        {"default", [] { return started(eglGetDisplay(EGL_DEFAULT_DISPLAY)); }}};
    const char* wanted = std::getenv("OSGGPUANIMATION_EGL_PLATFORM");
    for (const auto& [name, open] : platforms)
    {
        if (wanted && *wanted && wanted != std::string(name)) continue;
        EGLDisplay display = open();
        if (display == EGL_NO_DISPLAY) continue;
        OSG_INFO << "EglGraphicsContext: platform " << name << std::endl;
        return display;
    }
    return EGL_NO_DISPLAY;
}

/// Opened once per process and never terminated: EGL returns the same display to every caller.
EGLDisplay processDisplay()
{
    static const EGLDisplay display = openAny();
    return display;
}

/// Prefers the configuration with exactly the requested colour bits: EGL lists deeper colours first.
EGLConfig pickConfig(EGLDisplay display, const std::vector<EGLConfig>& configs,
                     const osg::GraphicsContext::Traits& traits)
{
    for (EGLConfig config : configs)
    {
        EGLint red = 0;
        EGLint alpha = 0;
        eglGetConfigAttrib(display, config, EGL_RED_SIZE, &red);
        eglGetConfigAttrib(display, config, EGL_ALPHA_SIZE, &alpha);
        if (red == static_cast<EGLint>(traits.red) && (alpha > 0) == (traits.alpha > 0)) return config;
    }
    return configs.front();
}

/// Null if no configuration has the traits.
EGLConfig chooseConfig(EGLDisplay display, const osg::GraphicsContext::Traits& traits)
{
    std::vector<EGLint> wanted;
    const auto require = [&wanted](EGLint attribute, unsigned int value) {
        wanted.insert(wanted.end(), {attribute, static_cast<EGLint>(value)});
    };
    require(EGL_SURFACE_TYPE, EGL_PBUFFER_BIT);
    require(EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT);
    require(EGL_RED_SIZE, traits.red);
    require(EGL_GREEN_SIZE, traits.green);
    require(EGL_BLUE_SIZE, traits.blue);
    require(EGL_ALPHA_SIZE, traits.alpha);
    require(EGL_DEPTH_SIZE, traits.depth);
    require(EGL_STENCIL_SIZE, traits.stencil);
    require(EGL_SAMPLE_BUFFERS, traits.samples ? 1 : 0);
    require(EGL_SAMPLES, traits.samples);
    wanted.push_back(EGL_NONE);
    EGLint count = 0;
    if (!eglChooseConfig(display, wanted.data(), nullptr, 0, &count) || count < 1) return nullptr;
    std::vector<EGLConfig> configs(static_cast<std::size_t>(count));
    if (!eglChooseConfig(display, wanted.data(), configs.data(), count, &count) || count < 1) return nullptr;
    configs.resize(static_cast<std::size_t>(count));
    return pickConfig(display, configs, traits);
}

/// An OSG built without the fixed pipeline has no use for a compatibility profile.
bool wantsCore(const osg::GraphicsContext::Traits& traits)
{
    return !hasFixedPipeline || (traits.glContextProfileMask & EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT) != 0;
}

EGLContext createContext(EGLDisplay display, EGLConfig config, const osg::GraphicsContext::Traits& traits,
                         EGLContext shared)
{
    unsigned int major = 0;
    unsigned int minor = 0;
    if (!traits.getContextVersion(major, minor)) major = minor = 0;
    const bool core = wantsCore(traits);
    // Profiles exist since GL 3.2. OSG's default version, "1.0", leaves the version to the driver.
    const bool profiles = major > 3 || (major == 3 && minor >= 2);
    std::vector<EGLint> attributes;
    if (core || profiles)
    {
        attributes = {EGL_CONTEXT_MAJOR_VERSION,
                      profiles ? static_cast<EGLint>(major) : 3,
                      EGL_CONTEXT_MINOR_VERSION,
                      profiles ? static_cast<EGLint>(minor) : 3,
                      EGL_CONTEXT_OPENGL_PROFILE_MASK,
                      core ? EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT : EGL_CONTEXT_OPENGL_COMPATIBILITY_PROFILE_BIT};
    }
    attributes.push_back(EGL_NONE);
    return eglCreateContext(display, config, shared, attributes.data());
}

/// An osg::State without the modes of the fixed pipeline: an OSG that was built with them sets them in every context,
/// and in the core profile that is a GL error.
class CoreState : public osg::State
{
public:
    CoreState()
    {
        for (const osg::StateAttribute::GLMode mode :
             {GL_LIGHTING, GL_FOG, GL_NORMALIZE, GL_RESCALE_NORMAL, GL_ALPHA_TEST, GL_COLOR_MATERIAL})
            setModeValidity(mode, false);
        for (unsigned int light = 0; light < 8; ++light)
            setModeValidity(GL_LIGHT0 + light, false);
        _textureModeMapList.resize(16);
        for (ModeMap& modes : _textureModeMapList)
            for (const osg::StateAttribute::GLMode mode :
                 {GL_TEXTURE_1D, GL_TEXTURE_2D, GL_TEXTURE_3D, GL_TEXTURE_CUBE_MAP, GL_TEXTURE_RECTANGLE,
                  GL_TEXTURE_GEN_S, GL_TEXTURE_GEN_T, GL_TEXTURE_GEN_R, GL_TEXTURE_GEN_Q})
                modes[mode].valid = false;
    }
};

/// RAII: the destructor makes the EGL context current again that was current at construction.
class CurrentContextKeeper
{
public:
    CurrentContextKeeper()
        : _display(eglGetCurrentDisplay()), _context(eglGetCurrentContext()), _draw(eglGetCurrentSurface(EGL_DRAW)),
          _read(eglGetCurrentSurface(EGL_READ))
    {
    }
    CurrentContextKeeper(const CurrentContextKeeper&) = delete;
    CurrentContextKeeper& operator=(const CurrentContextKeeper&) = delete;
    ~CurrentContextKeeper()
    {
        if (_context != EGL_NO_CONTEXT) eglMakeCurrent(_display, _draw, _read, _context);
    }

private:
    EGLDisplay _display;
    EGLContext _context;
    EGLSurface _draw;
    EGLSurface _read;
};

} // namespace

Result<osg::ref_ptr<EglGraphicsContext>> EglGraphicsContext::create(osg::GraphicsContext::Traits* traits)
{
    if (!traits || traits->width <= 0 || traits->height <= 0)
        return Error{"EGL: a context needs traits with a width and a height above 0"};
    osg::ref_ptr<EglGraphicsContext> context = new EglGraphicsContext;
    context->_traits = traits;
    if (Result<void> opened = context->open(); !opened) return opened.error();
    context->setUpState();
    return context;
}

Result<osg::ref_ptr<EglGraphicsContext>> EglGraphicsContext::create(int width, int height)
{
    osg::ref_ptr<Traits> traits = new Traits;
    traits->width = width;
    traits->height = height;
    traits->depth = 24;
    traits->stencil = 8;
    return create(traits.get());
}

Result<void> EglGraphicsContext::open()
{
    _traits->pbuffer = true;
    _traits->doubleBuffer = false;
    _display = processDisplay();
    if (_display == EGL_NO_DISPLAY) return eglFailure("no display without a window system; is Mesa's EGL installed?");
    // Each thread has its own current API; the initial one is OpenGL ES.
    if (!eglBindAPI(EGL_OPENGL_API)) return eglFailure("no desktop OpenGL");

    Result<void> created = createSurface();
    if (_traits->samples && (!created || !hasColors()))
    {
        OSG_INFO << "EglGraphicsContext: no multisampling with " << _traits->samples << " samples" << std::endl;
        destroySurface();
        _traits->samples = _traits->sampleBuffers = 0;
        created = createSurface();
    }
    return created;
}

Result<void> EglGraphicsContext::createSurface()
{
    EGLConfig config = chooseConfig(_display, *_traits);
    if (!config) return eglFailure("no configuration with the colour, depth and stencil bits asked for");

    const auto* shared = dynamic_cast<EglGraphicsContext*>(_traits->sharedContext.get());
    if (_traits->sharedContext.valid() && !shared) return Error{"EGL: sharedContext is not an EglGraphicsContext"};
    _context = createContext(_display, config, *_traits, shared ? shared->_context : EGL_NO_CONTEXT);
    if (_context == EGL_NO_CONTEXT) return eglFailure("no context of the version and profile asked for");
    _core = wantsCore(*_traits);

    const std::array<EGLint, 5> size{EGL_WIDTH, _traits->width, EGL_HEIGHT, _traits->height, EGL_NONE};
    _surface = eglCreatePbufferSurface(_display, config, size.data());
    if (_surface == EGL_NO_SURFACE)
    {
        return eglFailure("no pbuffer of " + std::to_string(_traits->width) + "x" + std::to_string(_traits->height));
    }
    return {};
}

void EglGraphicsContext::destroySurface()
{
    if (_surface) eglDestroySurface(_display, _surface);
    if (_context) eglDestroyContext(_display, _context);
    _surface = nullptr;
    _context = nullptr;
}

bool EglGraphicsContext::hasColors() const
{
    const CurrentContextKeeper keeper;
    if (!eglMakeCurrent(_display, _surface, _surface, _context)) return false;
    std::array<unsigned char, 4> color{};
    glReadPixels(0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, color.data());
    const bool isRead = glGetError() == GL_NO_ERROR;
    eglMakeCurrent(_display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    return isRead;
}

void EglGraphicsContext::setUpState()
{
    osg::ref_ptr<osg::State> state = _core ? new CoreState : new osg::State;
    setState(state.get());
    state->setGraphicsContext(this);
    if (_traits->sharedContext.valid())
    {
        state->setContextID(_traits->sharedContext->getState()->getContextID());
        incrementContextIDUsageCount(state->getContextID());
    }
    else
    {
        state->setContextID(createNewContextID());
    }
    if (!_core) return;
    // The core profile has neither matrix stacks, nor named vertex attributes, nor vertex arrays without an object.
    state->setUseModelViewAndProjectionUniforms(true);
    state->setUseVertexAttributeAliasing(true);
    osg::ref_ptr<osg::DisplaySettings> settings = new osg::DisplaySettings(*osg::DisplaySettings::instance());
    settings->setVertexBufferHint(osg::DisplaySettings::VERTEX_ARRAY_OBJECT);
    state->setDisplaySettings(settings.get());
}

EglGraphicsContext::~EglGraphicsContext()
{
    close(true);
}

bool EglGraphicsContext::realizeImplementation()
{
    if (_realized || !valid()) return _realized;
    const CurrentContextKeeper keeper;
    _realized = true;
    _realized = makeCurrentImplementation();
    if (!_realized)
    {
        OSG_WARN << eglFailure("cannot make the context current").message << std::endl;
        return false;
    }
    getState()->initializeExtensionProcs();
    // OSG's queries include some that cause errors in the core profile. GL stores a few errors at most.
    for (int kept = 0; kept < 32 && glGetError() != GL_NO_ERROR; ++kept)
    {
    }
    releaseContextImplementation();
    return true;
}

void EglGraphicsContext::closeImplementation()
{
    if (_display)
    {
        if (_context && eglGetCurrentContext() == _context) releaseContextImplementation();
        destroySurface();
    }
    _display = nullptr;
    _realized = false;
}

bool EglGraphicsContext::makeCurrentImplementation()
{
    return makeContextCurrentImplementation(this);
}

bool EglGraphicsContext::makeContextCurrentImplementation(osg::GraphicsContext* readContext)
{
    const auto* read = dynamic_cast<EglGraphicsContext*>(readContext);
    if (!_realized || !read || !read->valid()) return false;
    eglBindAPI(EGL_OPENGL_API);
    return eglMakeCurrent(_display, _surface, read->_surface, _context) == EGL_TRUE;
}

bool EglGraphicsContext::releaseContextImplementation()
{
    if (!_realized) return false;
    eglBindAPI(EGL_OPENGL_API);
    return eglMakeCurrent(_display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT) == EGL_TRUE;
}

void EglGraphicsContext::bindPBufferToTextureImplementation(GLenum)
{
    OSG_WARN << "EglGraphicsContext: a pbuffer cannot be bound to a texture; use a frame buffer object" << std::endl;
}

void EglGraphicsContext::swapBuffersImplementation()
{
    // A pbuffer has one buffer. The flush submits the commands, so that frames do not accumulate.
    glFlush();
}

} // namespace osgGpuAnimation
