// SPDX-License-Identifier: MIT
#pragma once

#include "support/GLTest.h"
#include "support/Picture.h"

#include <osgGA/TrackballManipulator>

#include <vector>

namespace osgGpuAnimation
{

/// A GL test that draws scenes with an osgViewer::Viewer on the test's context. The camera is 10 units before the
/// origin on -Y and looks along +Y with +Z up: a square of 4 units on each side of the origin fills the picture.
class ViewerGLTest : public GLTest
{
protected:
    void TearDown() override
    {
        _scenes.clear(); // before their context, which OSG would otherwise keep data of until the process ends
        // As with a window: closing the context makes the viewer's cameras release the GL objects of their scenes.
        GLTest::TearDown();
        _viewer = nullptr;
    }

    osgViewer::Viewer& viewer()
    {
        if (_viewer) return *_viewer;
        _viewer = new osgViewer::Viewer;
        _viewer->setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
        _viewer->setKeyEventSetsDone(0);
        osg::Camera* camera = _viewer->getCamera();
        camera->setGraphicsContext(&context());
        camera->setViewport(0, 0, context().getTraits()->width, context().getTraits()->height);
        camera->setProjectionMatrixAsOrtho(-4, 4, -4, 4, 1, 20);
        camera->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        camera->setViewMatrixAsLookAt({0, -10, 0}, {0, 0, 0}, {0, 0, 1});
        camera->setFinalDrawCallback(_picture);
        return *_viewer;
    }

    /// Draws the scene at that simulation time (seconds) and keeps the picture.
    void drawAt(double simulationTime)
    {
        viewer().frame(simulationTime);
        context().makeCurrent();
    }

    /// Draws the scene at each of these times and returns the last picture.
    osg::ref_ptr<osg::Image> pictureOf(osg::Node* scene, const std::vector<double>& times)
    {
        _scenes.emplace_back(scene);
        viewer().setSceneData(scene);
        for (const double time : times)
            drawAt(time);
        return picture().copy();
    }

    const Picture& picture() const { return *_picture; }

private:
    osg::ref_ptr<osgViewer::Viewer> _viewer;
    osg::ref_ptr<Picture> _picture = new Picture;
    /// What was drawn stays alive: OSG takes a new vertex array at the address of a deleted one for the one that it set
    /// last, and draws from freed memory (VertexArrayState::setArray in 3.6.5).
    std::vector<osg::ref_ptr<osg::Node>> _scenes;
};

} // namespace osgGpuAnimation
