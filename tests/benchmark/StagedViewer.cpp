// SPDX-License-Identifier: MIT
#include "StagedViewer.h"

#include <osgGpuAnimation/gpu/EglGraphicsContext.h>

#include <osgUtil/GLObjectsVisitor>
#include <osgViewer/Renderer>

#include <sstream>
#include <vector>

namespace osgGpuAnimation::benchmark
{

Result<std::shared_ptr<StagedViewer>> StagedViewer::create(osg::Node* scene, const osg::BoundingSphere& sight,
                                                           int width, int height)
{
    if (height == 0) height = width;
    Result<osg::ref_ptr<EglGraphicsContext>> context = EglGraphicsContext::create(width, height);
    if (!context) return context.error();
    std::shared_ptr<StagedViewer> made(new StagedViewer(context.value()));
    osgViewer::Viewer& viewer = made->_viewer;
    viewer.setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    viewer.setReleaseContextAtEndOfFrameHint(false);
    osg::Camera* camera = viewer.getCamera();
    camera->setGraphicsContext(context.value());
    camera->setViewport(0, 0, width, height);
    camera->setClearColor(osg::Vec4(0, 0, 0, 0));
    camera->setCullingMode(osg::CullSettings::VIEW_FRUSTUM_CULLING);
    viewer.setSceneData(scene);
    made->lookAt(sight);
    viewer.realize();
    if (!viewer.isRealized()) return Error{"the viewer cannot be realized"};
    return made;
}

StagedViewer::~StagedViewer()
{
    // The scene must release its GL objects first: OSG destroys its vertex array states at exit, after what they use.
    _context->close();
    _viewer.setSceneData(nullptr);
}

void StagedViewer::lookAt(const osg::BoundingSphere& sight)
{
    _sight = sight;
    osg::Vec3d back(0.3, -1.0, 0.8);
    back.normalize();
    osg::Camera* camera = _viewer.getCamera();
    camera->setViewMatrixAsLookAt(sight.center() + back * sight.radius() * 4.0, sight.center(), osg::Vec3d(0, 0, 1));
    camera->setProjectionMatrixAsPerspective(35.0, 1.0, sight.radius(), sight.radius() * 10.0);
}

void StagedViewer::lookFrom(const osg::Vec3d& eye, const osg::Vec3d& centre, double fieldOfView)
{
    osg::Camera* camera = _viewer.getCamera();
    const osg::Viewport* viewport = camera->getViewport();
    camera->setViewMatrixAsLookAt(eye, centre, osg::Vec3d(0, 0, 1));
    camera->setProjectionMatrixAsPerspective(fieldOfView, viewport->width() / viewport->height(), 1.0,
                                             10.0 * _sight.radius());
}

void StagedViewer::compile(osg::Node& scene)
{
    _context->makeCurrent();
    osgUtil::GLObjectsVisitor visitor;
    visitor.setState(_context->getState());
    visitor.compile(scene);
    glFinish();
}

void StagedViewer::lookAside()
{
    osg::Camera* camera = _viewer.getCamera();
    camera->setCullingMode(osg::CullSettings::NO_CULLING);
    camera->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    camera->setViewMatrix(camera->getViewMatrix() * osg::Matrixd::translate(1000.0 * _sight.radius(), 0.0, 0.0));
}

FrameCost StagedViewer::frame(double time)
{
    FrameCost cost;
    _context->makeCurrent();
    const Stopwatch update;
    if (!_hasDrawn)
    {
        _hasDrawn = true;
        _viewer.frame(time);
        _context->makeCurrent();
        glFinish();
        cost.draw = update.elapsed();
        return cost;
    }
    _viewer.advance(time);
    _viewer.updateTraversal();
    cost.update = update.elapsed();
    auto* renderer = static_cast<osgViewer::Renderer*>(_viewer.getCamera()->getRenderer());
    osgUtil::SceneView& sceneView = *renderer->getSceneView(0);
    sceneView.setFrameStamp(_viewer.getFrameStamp());
    const Stopwatch cull;
    sceneView.cull();
    cost.cull = cull.elapsed();
    const Stopwatch draw;
    sceneView.draw();
    glFinish();
    cost.draw = draw.elapsed();
    return cost;
}

std::string StagedViewer::takeErrors()
{
    _context->makeCurrent();
    return takeGlErrors();
}

std::vector<unsigned char> StagedViewer::pixels()
{
    _context->makeCurrent();
    const int width = _context->getTraits()->width, height = _context->getTraits()->height;
    std::vector<unsigned char> pixels(std::size_t(4) * width * height);
    glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    return pixels;
}

int StagedViewer::pixelsDrawn()
{
    const std::vector<unsigned char> picture = pixels();
    int drawn = 0;
    for (std::size_t pixel = 0; pixel < picture.size(); pixel += 4)
        if (picture[pixel] != 0 || picture[pixel + 1] != 0 || picture[pixel + 2] != 0) ++drawn;
    return drawn;
}

std::string takeGlErrors()
{
    std::ostringstream errors;
    for (int kept = 0; kept < 32; ++kept)
    {
        const GLenum error = glGetError();
        if (error == GL_NO_ERROR) break;
        errors << "0x" << std::hex << error << " ";
    }
    return errors.str();
}

} // namespace osgGpuAnimation::benchmark
