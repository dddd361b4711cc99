// SPDX-License-Identifier: MIT
#include "SoakViewer.h"

#include "support/ThreadingModels.h"

#include <osgGpuAnimation/gpu/EglGraphicsContext.h>

#include <iostream>

namespace osgGpuAnimation
{

namespace
{

class ErrorCount : public osg::Camera::DrawCallback
{
public:
    explicit ErrorCount(std::atomic<int>& errors) : _errors(errors) {}
    void operator()(osg::RenderInfo&) const override
    {
        for (int kept = 0; kept < 32 && glGetError() != GL_NO_ERROR; ++kept)
            ++_errors;
    }

private:
    std::atomic<int>& _errors;
};

} // namespace

// One viewer for all windows: osgViewer never frees a few hundred bytes per viewer (its list of Scenes).
SoakViewer::SoakViewer(osg::Group& scene) : _scene(&scene), _viewer(new osgViewer::Viewer), _second(new osg::Camera)
{
    _viewer->setKeyEventSetsDone(0);
    _viewer->setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    for (osg::Camera* camera : {_viewer->getCamera(), _second.get()})
        camera->setFinalDrawCallback(new ErrorCount(_glErrors));
    _viewer->addSlave(_second, osg::Matrixd(), osg::Matrixd::rotate(osg::DegreesToRadians(50.0), osg::Y_AXIS));
    _viewer->setSceneData(_scene);
    open(320, 240);
}

SoakViewer::~SoakViewer()
{
    close();
}

bool SoakViewer::open(int width, int height)
{
    const Result<osg::ref_ptr<EglGraphicsContext>> window = EglGraphicsContext::create(width, height);
    if (!window)
    {
        std::cerr << window.error().message << std::endl;
        return false;
    }
    _window = window.value();
    osg::Camera& camera = *_viewer->getCamera();
    const int half = width / 2;
    camera.setGraphicsContext(_window);
    camera.setViewport(0, 0, half, height);
    camera.setProjectionMatrixAsPerspective(40.0, double(half) / height, 1.0, 10000.0);
    _second->setGraphicsContext(_window);
    _second->setViewport(half, 0, width - half, height);
    _viewer->realize();
    return _viewer->isRealized();
}

void SoakViewer::close()
{
    if (!_window) return;
    _viewer->stopThreading();
    _window->close();
    for (osg::Camera* camera : {_viewer->getCamera(), _second.get()})
        camera->setGraphicsContext(nullptr);
    _window = nullptr;
}

void SoakViewer::frame(double time)
{
    _viewer->frame(time);
}

void SoakViewer::moveCamera(std::mt19937& random)
{
    const osg::BoundingSphere bound = _scene->getBound();
    std::uniform_real_distribution<double> way(-1.0, 1.0);
    osg::Vec3d from(way(random), way(random), 0.3 + 0.2 * way(random));
    from = bound.center() + from * bound.radius();
    _viewer->getCamera()->setViewMatrixAsLookAt(from, bound.center(), {0, 0, 1});
}

// With draw threads a camera keeps two frames.
void SoakViewer::settle(double time)
{
    _viewer->setThreadingModel(osgViewer::ViewerBase::DrawThreadPerContext);
    const osg::BoundingSphere bound = _scene->getBound();
    const osg::Vec3d above = bound.center() + osg::Vec3d(0.0, 0.0, 40.0 * bound.radius());
    _viewer->getCamera()->setViewMatrixAsLookAt(above, bound.center(), osg::Y_AXIS);
    for (int frames = 0; frames < 3; ++frames)
        _viewer->frame(time);
}

void SoakViewer::changeThreading(std::mt19937& random)
{
    _viewer->setThreadingModel(threadingModels[std::uniform_int_distribution<int>(0, 3)(random)]);
}

bool SoakViewer::open(std::mt19937& random)
{
    std::uniform_int_distribution<int> size(100, 500);
    const int width = size(random);
    return open(width, size(random));
}

} // namespace osgGpuAnimation
