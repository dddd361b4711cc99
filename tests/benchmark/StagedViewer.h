// SPDX-License-Identifier: MIT
#pragma once

#include "Stopwatch.h"

#include <osgGpuAnimation/gpu/PosePipeline.h>

#include <osgViewer/Viewer>

#include <memory>
#include <string>
#include <vector>

namespace osgGpuAnimation::benchmark
{

/// The cost of each stage of a frame; draw lasts until the GPU has finished.
struct FrameCost
{
    Spent update;
    Spent cull;
    Spent draw;

    Spent whole() const { return {update.cpu + cull.cpu + draw.cpu, update.wall + cull.wall + draw.wall}; }
    Spent updateAndCull() const { return {update.cpu + cull.cpu, update.wall + cull.wall}; }
};

/// An osgViewer without a display, by default of 64x64 pixels, that runs each frame stage by stage. It shows the whole
/// scene and culls no small features.
class StagedViewer
{
public:
    /// sight: the bounds that the picture shows. width, height: in pixels; a height of 0: a square. Error: no GL is
    /// available.
    static Result<std::shared_ptr<StagedViewer>> create(osg::Node* scene, const osg::BoundingSphere& sight,
                                                        int width = 64, int height = 0);
    ~StagedViewer();

    /// Draws a frame at that simulation time (seconds). The first one is an ordinary viewer.frame(), timed as draw.
    FrameCost frame(double time);

    /// Looks from a place to another one, in place of the whole scene. fieldOfView: vertical, in degrees.
    void lookFrom(const osg::Vec3d& eye, const osg::Vec3d& centre, double fieldOfView);

    /// Runs OSG's compile traversal over a scene, until the GPU has finished. Call it after the first frame.
    void compile(osg::Node& scene);

    /// From the next frame on the scene is culled and drawn as before, but outside the picture: llvmpipe keeps up to 36
    /// MiB of triangles per picture, which would distort the memory of the scene.
    void lookAside();

    /// The functions below require an earlier frame. Returns the pending GL errors; empty if there are none.
    std::string takeErrors();
    /// The last frame in RGBA, 8 bits a channel; the background is 0.
    std::vector<unsigned char> pixels();
    /// The number of pixels of the last frame that differ from the background.
    int pixelsDrawn();
    osg::State& state() { return *_context->getState(); }
    void makeCurrent() { _context->makeCurrent(); }

private:
    explicit StagedViewer(osg::ref_ptr<osg::GraphicsContext> context) : _context(std::move(context)) {}
    void lookAt(const osg::BoundingSphere& sight);

    osg::BoundingSphere _sight;
    osg::ref_ptr<osg::GraphicsContext> _context;
    osgViewer::Viewer _viewer;
    bool _hasDrawn = false;
};

/// Returns the pending errors of the current GL context; empty if there are none.
std::string takeGlErrors();

} // namespace osgGpuAnimation::benchmark
