// SPDX-License-Identifier: MIT
#pragma once

#include "Report.h"

#include <osgGpuAnimation/math/Result.h>

#include <osgViewer/Viewer>

#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace osgGpuAnimation::benchmark
{

constexpr double frameTime = 1.0 / 60.0; ///< seconds

/// The value; an error ends the run without a report.
template <typename T>
T taken(Result<T> result)
{
    if (!result) throw std::runtime_error(result.error().message);
    if constexpr (!std::is_void_v<T>) return std::move(result).value();
}

/// Ends the run without a report, unless `wrong` is empty: figures of a wrong result are invalid.
void require(const std::string& wrong);
/// Takes the pending errors of the current GL context, which end the run.
void requireNoGlErrors();

/// The cost of each stage of a frame; draw lasts until the GPU has finished.
struct FrameCost
{
    Spent update;
    Spent cull;
    Spent draw;

    Spent updateAndCull() const { return update + cull; }
    Spent whole() const { return update + cull + draw; }
};

class GpuClock;

/// An osgViewer without a display, by default of 64x64 pixels, that runs each frame stage by stage. It shows the whole
/// scene and culls no small features.
class StagedViewer
{
public:
    /// sight: the bounds that the picture shows. width, height: in pixels; a height of 0: a square.
    StagedViewer(osg::Node* scene, const osg::BoundingSphere& sight, int width = 64, int height = 0);
    ~StagedViewer();

    /// Draws a frame at that simulation time (seconds). The first one is an ordinary viewer.frame(), timed as draw.
    FrameCost frameAt(double time);
    /// Draws the next frame of 60 a second.
    FrameCost frame() { return frameAt(_time += frameTime); }

    /// Draws that many frames without waiting for the GPU in between; the cost of one.
    Spent framesInARow(int count);

    /// Looks from a place to another one, in place of the whole scene. fieldOfView: vertical, in degrees.
    void lookFrom(const osg::Vec3d& eye, const osg::Vec3d& centre, double fieldOfView);

    /// Runs OSG's compile traversal over a scene, until the GPU has finished. Call it after the first frame.
    void compile(osg::Node& scene);

    /// From the next frame on the scene is culled and drawn as before, but outside the picture: llvmpipe keeps up to 36
    /// MiB of triangles per picture, which would distort the memory of the scene.
    void lookAside();

    // These functions require an earlier frame.

    void requireNoErrors(); ///< See requireNoGlErrors().
    /// The last frame in RGBA, 8 bits a channel; the background is 0.
    std::vector<unsigned char> pixels();
    /// The number of pixels of the last frame that differ from the background.
    int pixelsDrawn();
    osg::State& currentState(); ///< Its context is current from then on.

private:
    osg::BoundingSphere _sight;
    osg::ref_ptr<osg::GraphicsContext> _context;
    osgViewer::Viewer _viewer;
    bool _hasDrawn = false;
    double _time = 0.0;
    GpuClock* _clock = nullptr; ///< in framesInARow()
};

using Viewers = std::vector<std::unique_ptr<StagedViewer>>;

/// One viewer of 64x64 pixels a scene; all show the same sight.
Viewers viewersOf(const std::vector<osg::ref_ptr<osg::Node>>& scenes, const osg::BoundingSphere& sight);

/// The same of 1000x600 pixels, with perspective from before and above.
Viewers viewersFromAbove(const std::vector<osg::ref_ptr<osg::Node>>& scenes, const osg::BoundingSphere& sight);

/// The costs of the frames of one viewer.
struct Costs
{
    Series whole, update, cull, updateAndCull, draw;
};

/// Draws frames until all programs and buffers exist and osgAnimation is set up; then measures the viewers in turns.
/// Requires pictures that are not empty and no GL errors.
std::vector<Costs> race(const Viewers& viewers, int rounds);

/// Bytes allocated on the heap; they include the GPU's memory if GL is a software renderer.
double bytesInUse();

} // namespace osgGpuAnimation::benchmark
