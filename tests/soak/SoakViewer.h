// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Group>
#include <osgViewer/Viewer>

#include <atomic>
#include <random>

namespace osgGpuAnimation
{

/// Draws a scene without a display, by two cameras side by side, while the window's size, the cameras and the threading
/// model change.
class SoakViewer
{
public:
    explicit SoakViewer(osg::Group& scene);
    ~SoakViewer();
    SoakViewer(const SoakViewer&) = delete;
    SoakViewer& operator=(const SoakViewer&) = delete;

    void frame(double time);
    void moveCamera(std::mt19937& random);
    void changeThreading(std::mt19937& random);
    /// Draws everything, since cameras and batches keep memory for what they drew.
    void settle(double time);
    void close();
    /// Opens a window of another size.
    bool open(std::mt19937& random);

    int glErrors() const { return _glErrors; }

private:
    bool open(int width, int height);

    osg::ref_ptr<osg::Group> _scene;
    osg::ref_ptr<osgViewer::Viewer> _viewer;
    osg::ref_ptr<osg::Camera> _second; ///< a slave of the viewer's camera, looks another way
    osg::ref_ptr<osg::GraphicsContext> _window;
    std::atomic<int> _glErrors{0};
};

} // namespace osgGpuAnimation
