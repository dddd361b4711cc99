// SPDX-License-Identifier: MIT
#include "tool/PictureViewer.h"

#include <osgGpuAnimation/gpu/OffscreenContext.h>
#include <osgGpuAnimation/nodes/viewing/StartView.h>

#include <osg/BoundingBox>
#include <osg/Depth>
#include <osg/Geometry>
#include <osg/GLExtensions>
#include <osg/LightModel>
#include <osg/LightSource>
#include <osg/MatrixTransform>
#include <osg/Projection>
#include <osg/Texture2D>

namespace osgGpuAnimation::tool
{

namespace
{

constexpr double fieldOfView = 30.0; ///< degrees, vertical
constexpr double margin = 1.08;      ///< size of the picture relative to the points in it
constexpr unsigned int samplesAPixel = 4;

/// A quad behind everything, light at the top and a little darker at the bottom.
osg::ref_ptr<osg::Node> makeBackground()
{
    osg::ref_ptr<osg::Geometry> quad = new osg::Geometry;
    osg::ref_ptr<osg::Vec3Array> corners = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array;
    for (const float y : {-1.0f, 1.0f})
    {
        const float grey = y > 0.0f ? 0.93f : 0.74f;
        for (const float x : {-1.0f, 1.0f})
        {
            corners->push_back(osg::Vec3(x, y, 0.0f));
            colors->push_back(osg::Vec4(grey, grey, grey * 1.01f, 1.0f));
        }
    }
    quad->setVertexArray(corners);
    quad->setColorArray(colors, osg::Array::BIND_PER_VERTEX);
    quad->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLE_STRIP, 0, 4));
    quad->setCullingActive(false);
    osg::StateSet* state = quad->getOrCreateStateSet();
    state->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    state->setAttributeAndModes(new osg::Depth(osg::Depth::ALWAYS, 0.0, 1.0, false));
    state->setRenderBinDetails(-1, "RenderBin");

    osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform;
    place->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    place->setCullingActive(false);
    place->addChild(quad);
    osg::ref_ptr<osg::Projection> projection = new osg::Projection(osg::Matrix::ortho2D(-1, 1, -1, 1));
    projection->setCullingActive(false);
    projection->addChild(place);
    return projection;
}

osg::ref_ptr<osg::LightSource> makeSun()
{
    osg::ref_ptr<osg::LightSource> sun = new osg::LightSource;
    osg::Light* light = sun->getLight();
    light->setPosition(osg::Vec4(0.6f, -0.9f, 1.1f, 0.0f));
    light->setAmbient(osg::Vec4(0.0f, 0.0f, 0.0f, 1.0f));
    light->setDiffuse(osg::Vec4(0.7f, 0.7f, 0.68f, 1.0f));
    light->setSpecular(osg::Vec4(0.2f, 0.2f, 0.2f, 1.0f));
    return sun;
}

/// The scene in its surroundings.
osg::ref_ptr<osg::Group> lit(osg::Node* scene, Look look, Environment* surroundings)
{
    osg::ref_ptr<osg::Group> group = look == Look::Studio ? surroundings : new osg::Group;
    if (look != Look::Studio)
    {
        const float radiance = look == Look::Sun ? 0.3f : look == Look::File ? 0.05f : 1.0f;
        osg::ref_ptr<osg::LightModel> ambient = new osg::LightModel;
        ambient->setAmbientIntensity(osg::Vec4(radiance, radiance, radiance, 1.0f));
        group->getOrCreateStateSet()->setAttribute(ambient);
    }
    group->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::ON);
    if (look == Look::Sun) // no light of the viewer's: an OSG without the fixed pipeline has none
    {
        const osg::ref_ptr<osg::LightSource> sun = makeSun();
        sun->setStateSetModes(*group->getStateSet(), osg::StateAttribute::ON);
        group->addChild(sun);
    }
    group->addChild(scene);
    return group;
}

} // namespace

/// OSG takes the address of an entry point for its extension; EGL has addresses of entry points that the driver lacks.
class ForgetMissingExtensions : public osg::Operation
{
public:
    void operator()(osg::Object* object) override
    {
        auto* const context = static_cast<osg::GraphicsContext*>(object);
        osg::GLExtensions* const gl = context->getState()->get<osg::GLExtensions>();
        if (!osg::isGLExtensionSupported(gl->contextID, "GL_NV_framebuffer_multisample_coverage"))
            gl->glRenderbufferStorageMultisampleCoverageNV = nullptr;
    }
};

/// Reads the colours from the texture. Its alpha is what blending has left there, not what the picture shows.
class PictureViewer::ReadPixels : public osg::Camera::DrawCallback
{
public:
    void operator()(osg::RenderInfo& renderInfo) const override
    {
        osg::State& state = *renderInfo.getState();
        state.applyTextureAttribute(0, texture);
        image = new osg::Image;
        image->allocateImage(texture->getTextureWidth(), texture->getTextureHeight(), 1, GL_RGB, GL_UNSIGNED_BYTE, 1);
        glPixelStorei(GL_PACK_ALIGNMENT, 1);
        glGetTexImage(GL_TEXTURE_2D, 0, GL_RGB, GL_UNSIGNED_BYTE, image->data());
        if (glGetError() != GL_NO_ERROR) image = nullptr;
    }

    osg::ref_ptr<osg::Texture2D> texture;
    mutable osg::ref_ptr<osg::Image> image;
};

PictureViewer::PictureViewer() : _reader(new ReadPixels) {}

PictureViewer::~PictureViewer() = default;

Result<std::unique_ptr<PictureViewer>> PictureViewer::create(int width, int height, Look look,
                                                             const osg::ref_ptr<Environment>& surroundings)
{
    osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
    traits->width = width;
    traits->height = height;
    const Result<osg::ref_ptr<osg::GraphicsContext>> context = createOffscreenContext(traits);
    if (!context) return context.error();

    std::unique_ptr<PictureViewer> made(new PictureViewer);
    made->_look = look;
    made->_surroundings = surroundings;
    surroundings->setToneMapping(true);
    osgViewer::Viewer& viewer = made->_viewer;
    viewer.setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    viewer.setRealizeOperation(new ForgetMissingExtensions);
    viewer.setLightingMode(osg::View::NO_LIGHT);
    osg::Camera* camera = viewer.getCamera();
    camera->setGraphicsContext(context.value());
    camera->setViewport(0, 0, width, height);
    // Multisampled pbuffers are resolved differently by different drivers, framebuffer objects are not.
    camera->setRenderTargetImplementation(osg::Camera::FRAME_BUFFER_OBJECT);
    camera->attach(osg::Camera::DEPTH_BUFFER, GL_DEPTH_COMPONENT24);
    osg::ref_ptr<osg::Texture2D> picture = new osg::Texture2D;
    picture->setTextureSize(width, height);
    picture->setInternalFormat(GL_RGBA8);
    camera->attach(osg::Camera::COLOR_BUFFER, picture, 0, 0, false, samplesAPixel, samplesAPixel);
    made->_reader->texture = picture;
    camera->setFinalDrawCallback(made->_reader);
    return made;
}

void PictureViewer::show(osg::Node* scene, const std::vector<osg::Vec3d>& points,
                         const std::optional<ViewDirection>& from)
{
    osg::ref_ptr<osg::Group> all = new osg::Group;
    all->addChild(makeBackground());
    all->addChild(lit(scene, _look, _surroundings));
    _viewer.setSceneData(all);

    osg::Camera* camera = _viewer.getCamera();
    const double aspect = camera->getViewport()->aspectRatio();
    _place = from ? standpointFrom(*from, points, fieldOfView, aspect, margin)
                  : raisedStandpoint(points, fieldOfView, aspect, margin);
    osg::BoundingBoxd box;
    for (const osg::Vec3d& point : points)
        box.expandBy(point);
    _axis = box.center();
    turn(0.0);
    // The cull traversal computes the near and far planes.
    camera->setProjectionMatrixAsPerspective(fieldOfView, aspect, _place.radius / 100.0, _place.radius * 100.0);
    _viewer.realize();
}

void PictureViewer::turn(double degrees)
{
    const osg::Quat turned(osg::DegreesToRadians(degrees), osg::Vec3d(0, 0, 1));
    _viewer.getCamera()->setViewMatrixAsLookAt(_axis + turned * (_place.eye - _axis),
                                               _axis + turned * (_place.middle - _axis), turned * _place.up);
}

void PictureViewer::lookThrough(const osg::CameraView& view)
{
    _view = &view;
    setProjection(*_viewer.getCamera(), view);
}

osg::ref_ptr<osg::Image> PictureViewer::draw(double simulationTime)
{
    _reader->image = nullptr;
    // As frame() does, but with the camera placed after the update, which moves it.
    _viewer.advance(simulationTime);
    _viewer.eventTraversal();
    _viewer.updateTraversal();
    if (_view) setProjection(*_viewer.getCamera(), *_view); // clips may animate it
    if (_view) _viewer.getCamera()->setViewMatrix(osg::Matrixd::inverse(viewToWorld(*_view)));
    _viewer.renderingTraversals();
    return _reader->image;
}

} // namespace osgGpuAnimation::tool
