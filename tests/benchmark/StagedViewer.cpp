// SPDX-License-Identifier: MIT
#include "StagedViewer.h"

#include "GpuClock.h"

#include <osgGpuAnimation/gpu/OffscreenContext.h>

#include <osgUtil/GLObjectsVisitor>
#include <osgViewer/Renderer>

#include <malloc.h>

#include <sstream>

namespace osgGpuAnimation::benchmark
{

void require(const std::string& wrong)
{
    if (!wrong.empty()) throw std::runtime_error(wrong);
}

void requireNoGlErrors()
{
    std::ostringstream errors;
    for (int kept = 0; kept < 32; ++kept)
    {
        const GLenum error = glGetError();
        if (error == GL_NO_ERROR) break;
        errors << (kept == 0 ? "GL reports" : "") << " 0x" << std::hex << error;
    }
    require(errors.str());
}

StagedViewer::StagedViewer(osg::Node* scene, const osg::BoundingSphere& sight, int width, int height) : _sight(sight)
{
    if (height == 0) height = width;
    _context = taken(createOffscreenContext(width, height));
    _viewer.setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    _viewer.setReleaseContextAtEndOfFrameHint(false);
    osg::Camera* camera = _viewer.getCamera();
    camera->setGraphicsContext(_context);
    camera->setViewport(0, 0, width, height);
    camera->setClearColor(osg::Vec4(0, 0, 0, 0));
    camera->setCullingMode(osg::CullSettings::VIEW_FRUSTUM_CULLING);
    _viewer.setSceneData(scene);
    osg::Vec3d back(0.3, -1.0, 0.8);
    back.normalize();
    camera->setViewMatrixAsLookAt(sight.center() + back * sight.radius() * 4.0, sight.center(), osg::Vec3d(0, 0, 1));
    camera->setProjectionMatrixAsPerspective(35.0, 1.0, sight.radius(), sight.radius() * 10.0);
    _viewer.realize();
    if (!_viewer.isRealized()) throw std::runtime_error("the viewer cannot be realized");
}

StagedViewer::~StagedViewer()
{
    // The scene must release its GL objects first: OSG destroys its vertex array states at exit, after what they use.
    _context->close();
    _viewer.setSceneData(nullptr);
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
    osgUtil::GLObjectsVisitor visitor;
    visitor.setState(&currentState());
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

FrameCost StagedViewer::frameAt(double time)
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
    if (_clock) _clock->begin();
    sceneView.draw();
    if (_clock)
        _clock->end();
    else
        glFinish();
    cost.draw = draw.elapsed();
    return cost;
}

Spent StagedViewer::framesInARow(int count)
{
    GpuClock clock(currentState());
    glFinish();
    const Stopwatch stopwatch;
    _clock = &clock;
    for (int i = 0; i < count; ++i)
        frame();
    _clock = nullptr;
    glFinish();
    return stopwatch.elapsed().with(clock.take()) / count;
}

void StagedViewer::requireNoErrors()
{
    _context->makeCurrent();
    requireNoGlErrors();
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

osg::State& StagedViewer::currentState()
{
    _context->makeCurrent();
    return *_context->getState();
}

Viewers viewersOf(const std::vector<osg::ref_ptr<osg::Node>>& scenes, const osg::BoundingSphere& sight)
{
    Viewers viewers;
    for (const osg::ref_ptr<osg::Node>& scene : scenes)
        viewers.push_back(std::make_unique<StagedViewer>(scene, sight));
    return viewers;
}

Viewers viewersFromAbove(const std::vector<osg::ref_ptr<osg::Node>>& scenes, const osg::BoundingSphere& sight)
{
    Viewers viewers;
    for (const osg::ref_ptr<osg::Node>& scene : scenes)
    {
        viewers.push_back(std::make_unique<StagedViewer>(scene, sight, 1000, 600));
        viewers.back()->lookFrom(sight.center() + osg::Vec3d(0.0, -1.6, 0.9) * sight.radius(), sight.center(), 35.0);
    }
    return viewers;
}

std::vector<Costs> race(const Viewers& viewers, int rounds)
{
    std::vector<Costs> costs(viewers.size());
    for (const auto& viewer : viewers)
        for (int frame = 0; frame < 3; ++frame)
            viewer->frame();
    for (int round = 0; round < rounds; ++round)
        for (std::size_t i = 0; i < viewers.size(); ++i)
        {
            const FrameCost cost = viewers[i]->frame();
            costs[i].whole.push_back(cost.whole());
            costs[i].update.push_back(cost.update);
            costs[i].cull.push_back(cost.cull);
            costs[i].updateAndCull.push_back(cost.updateAndCull());
            costs[i].draw.push_back(cost.draw);
        }
    for (std::size_t i = 0; i < viewers.size(); ++i)
    {
        viewers[i]->requireNoErrors();
        if (viewers[i]->pixelsDrawn() < 4) throw std::runtime_error("scene " + std::to_string(i) + " is empty");
    }
    return costs;
}

double bytesInUse()
{
    const struct mallinfo2 info = mallinfo2();
    return static_cast<double>(info.uordblks + info.hblkhd);
}

} // namespace osgGpuAnimation::benchmark
