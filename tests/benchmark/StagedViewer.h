// SPDX-License-Identifier: MIT
#pragma once

#include "Stopwatch.h"

#include <osgGpuAnimation/gpu/PosePipeline.h>

#include <osgViewer/Viewer>

#include <memory>
#include <string>

namespace osgGpuAnimation::benchmark
{

/// What the stages of a frame took; draw: until the GPU has finished.
struct FrameCost
{
    Spent update;
    Spent cull;
    Spent draw;

    Spent whole() const { return {update.cpu + cull.cpu + draw.cpu, update.wall + cull.wall + draw.wall}; }
    Spent updateAndCull() const { return {update.cpu + cull.cpu, update.wall + cull.wall}; }
};

/// An osgViewer without a display, 64x64 pixels, whose frames are gone through stage by stage. Everything in its scene
/// is in sight and drawn, however small.
class StagedViewer
{
public:
    /// sight: what is to be in the picture. Errors: there is no GL.
    static Result<std::shared_ptr<StagedViewer>> create(osg::Node* scene, const osg::BoundingSphere& sight);
    ~StagedViewer();

    /// The frame of that simulation time, in seconds. The first is an ordinary viewer.frame(), timed as draw.
    FrameCost frame(double time);

    /// From the next frame on all is culled and drawn as before, with no triangle of it in the picture: llvmpipe keeps
    /// the triangles of past pictures, up to 36 MiB a picture, which are nobody's memory in particular.
    void lookAside();

    /// The rest needs a frame before it. What GL reports and has not been asked for; empty: nothing.
    std::string takeErrors();
    /// Pixels of the last frame that are not the background's.
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

/// What GL reports in the current context; empty: nothing.
std::string takeGlErrors();

} // namespace osgGpuAnimation::benchmark
