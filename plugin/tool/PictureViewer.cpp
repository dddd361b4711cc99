// SPDX-License-Identifier: MIT
#include "tool/PictureViewer.h"

#include <osgGpuAnimation/gpu/EglGraphicsContext.h>

#include <osg/BoundingBox>
#include <osg/Depth>
#include <osg/Geometry>
#include <osg/GLExtensions>
#include <osg/LightModel>
#include <osg/MatrixTransform>
#include <osg/Projection>
#include <osg/Texture2D>

#include <algorithm>
#include <cmath>

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

/// The radiance of the white surrounding, without the studio.
float surroundingOf(Look look)
{
    return look == Look::Sun ? 0.3f : look == Look::File ? 0.05f : 1.0f;
}

void setUpLight(osgViewer::Viewer& viewer, Look look)
{
    if (look != Look::Sun) return viewer.setLightingMode(osg::View::NO_LIGHT);
    viewer.setLightingMode(osg::View::SKY_LIGHT);
    osg::Light* light = viewer.getLight();
    light->setPosition(osg::Vec4(0.6f, -0.9f, 1.1f, 0.0f));
    light->setAmbient(osg::Vec4(0.0f, 0.0f, 0.0f, 1.0f));
    light->setDiffuse(osg::Vec4(0.7f, 0.7f, 0.68f, 1.0f));
    light->setSpecular(osg::Vec4(0.2f, 0.2f, 0.2f, 1.0f));
}

/// The scene in its surroundings.
osg::ref_ptr<osg::Group> lit(osg::Node* scene, Look look, Environment* studio)
{
    osg::ref_ptr<osg::Group> group = look == Look::Studio ? studio : new osg::Group;
    if (look != Look::Studio)
    {
        const float radiance = surroundingOf(look);
        osg::ref_ptr<osg::LightModel> ambient = new osg::LightModel;
        ambient->setAmbientIntensity(osg::Vec4(radiance, radiance, radiance, 1.0f));
        group->getOrCreateStateSet()->setAttribute(ambient);
    }
    group->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::ON);
    group->addChild(scene);
    return group;
}

/// The position of the camera and its target.
struct Standpoint
{
    osg::Vec3d eye;
    osg::Vec3d middle;
    double radius = 1.0; ///< of the points around the middle
};

/// The distance from the middle along `back` at which the picture holds all points.
double fittingDistance(const std::vector<osg::Vec3d>& points, const Standpoint& place, const osg::Vec3d (&axes)[3],
                       double aspect)
{
    const double tangent = std::tan(osg::DegreesToRadians(fieldOfView) / 2.0) / margin;
    double distance = place.radius;
    for (const osg::Vec3d& point : points)
    {
        const osg::Vec3d offset = point - place.middle;
        const double spread = std::max(std::abs(offset * axes[1]), std::abs(offset * axes[0]) / aspect);
        distance = std::max(distance, spread / tangent + offset * axes[2]);
    }
    return distance;
}

/// The view along `back` in which all points are visible and as large as possible.
Standpoint standpoint(const std::vector<osg::Vec3d>& points, const osg::Vec3d& back, double aspect)
{
    osg::Vec3d right = osg::Vec3d(0, 0, 1) ^ back;
    right.normalize();
    const osg::Vec3d axes[] = {right, back ^ right, back};
    osg::BoundingBoxd box; // along those axes
    for (const osg::Vec3d& point : points)
        box.expandBy(point * axes[0], point * axes[1], point * axes[2]);
    if (!box.valid()) box.set(-1, -1, -1, 1, 1, 1);

    Standpoint place;
    place.middle = axes[0] * box.center().x() + axes[1] * box.center().y() + axes[2] * box.center().z();
    place.radius = std::max(box.radius(), 1e-6);
    double distance = fittingDistance(points, place, axes, aspect);
    // Near points look larger, so the middle of the points is not the middle of the picture: a few steps centre it.
    for (int step = 0; step < 4; ++step)
    {
        osg::BoundingBoxd seen;
        for (const osg::Vec3d& point : points)
        {
            const osg::Vec3d offset = point - place.middle;
            const double depth = distance - offset * back;
            seen.expandBy(offset * axes[0] / depth, offset * axes[1] / depth, 0.0);
        }
        if (!seen.valid()) break;
        place.middle += (axes[0] * seen.center().x() + axes[1] * seen.center().y()) * distance;
        distance = fittingDistance(points, place, axes, aspect);
    }
    place.eye = place.middle + back * distance;
    return place;
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

/// Reads the picture from the texture.
class PictureViewer::ReadPixels : public osg::Camera::DrawCallback
{
public:
    void operator()(osg::RenderInfo& renderInfo) const override
    {
        osg::State& state = *renderInfo.getState();
        state.applyTextureAttribute(0, texture);
        image = new osg::Image;
        image->readImageFromCurrentTexture(state.getContextID(), false);
        if (glGetError() != GL_NO_ERROR) image = nullptr;
    }

    osg::ref_ptr<osg::Texture2D> texture;
    mutable osg::ref_ptr<osg::Image> image;
};

PictureViewer::PictureViewer() : _reader(new ReadPixels), _studio(new Environment)
{
    _studio->setToneMapping(true);
}

PictureViewer::~PictureViewer() = default;

Result<std::unique_ptr<PictureViewer>> PictureViewer::create(int width, int height, Look look)
{
    osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
    traits->width = width;
    traits->height = height;
    const Result<osg::ref_ptr<EglGraphicsContext>> context = EglGraphicsContext::create(traits);
    if (!context) return context.error();

    std::unique_ptr<PictureViewer> made(new PictureViewer);
    made->_look = look;
    osgViewer::Viewer& viewer = made->_viewer;
    viewer.setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    viewer.setRealizeOperation(new ForgetMissingExtensions);
    setUpLight(viewer, look);
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

void PictureViewer::show(osg::Node* scene, const std::vector<osg::Vec3d>& points)
{
    osg::ref_ptr<osg::Group> all = new osg::Group;
    all->addChild(makeBackground());
    all->addChild(lit(scene, _look, _studio));
    _viewer.setSceneData(all);

    osg::Vec3d back(0.55, -1.0, 0.3);
    back.normalize();
    osg::Camera* camera = _viewer.getCamera();
    const double aspect = camera->getViewport()->aspectRatio();
    const Standpoint place = standpoint(points, back, aspect);
    camera->setViewMatrixAsLookAt(place.eye, place.middle, osg::Vec3d(0, 0, 1));
    // The cull traversal computes the near and far planes.
    camera->setProjectionMatrixAsPerspective(fieldOfView, aspect, place.radius / 100.0, place.radius * 100.0);
    _viewer.realize();
}

osg::ref_ptr<osg::Image> PictureViewer::draw(double simulationTime)
{
    _reader->image = nullptr;
    _viewer.frame(simulationTime);
    return _reader->image;
}

} // namespace osgGpuAnimation::tool
