// SPDX-License-Identifier: MIT
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>
#include <osgGpuAnimation/gpu/OffscreenContext.h>
#include <osgViewer/Viewer>

#include <iostream>

// The program of the guide application.md, "Rendering without a display", statement by statement. The test
// `install.picture` runs it.

int main(int argumentCount, char** arguments)
{
    osg::ref_ptr<osgDB::Options> options = new osgDB::Options("noKeys");
    osg::ref_ptr<osg::Node> scene = argumentCount == 3 ? osgDB::readRefNodeFile(arguments[1], options) : nullptr;
    auto context = osgGpuAnimation::createOffscreenContext(800, 600);
    if (!context) std::cerr << context.error().message << std::endl;
    if (!scene || !context) return 1;

    osgViewer::Viewer viewer;
    viewer.setSceneData(scene);
    viewer.setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    osg::Camera* camera = viewer.getCamera();
    camera->setGraphicsContext(context.value());
    camera->setViewport(0, 0, 800, 600);
    camera->setProjectionMatrixAsPerspective(30.0, 800.0 / 600.0, 1.0, 1000.0);
    const osg::BoundingSphere bound = scene->getBound();
    const osg::Vec3d eye = bound.center() + osg::Vec3d(1.5, -2.5, 1.0) * bound.radius();
    camera->setViewMatrixAsLookAt(eye, bound.center(), osg::Vec3d(0.0, 0.0, 1.0));

    osg::ref_ptr<osg::Image> picture = new osg::Image;
    camera->attach(osg::Camera::COLOR_BUFFER, picture);
    for (double seconds : {0.0, 0.5})
        viewer.frame(seconds);
    return osgDB::writeImageFile(*picture, arguments[2]) ? 0 : 1;
}
