// SPDX-License-Identifier: MIT
#pragma once

#include "Report.h"

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/gpu/buffers/BufferTexture.h>
#include <osgGpuAnimation/gpu/FeedbackPass.h>
#include <osgGpuAnimation/gpu/OffscreenContext.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>

#include <memory>
#include <vector>

namespace osgGpuAnimation::benchmark
{

/// The controllers and palettes of many instances of one set, without a scene: the work from advance() to the finished
/// palette. Requires its graphics context to be current.
class PoseCrowd
{
public:
    PoseCrowd(std::shared_ptr<const AnimationSet> set, std::size_t clip, std::size_t count,
              osg::GraphicsContext& context);

    std::vector<AnimationController> controllers;
    PosePipeline::Options options;

    /// Every n-th instance starts a crossfade to the clip it plays, three times; the fades never end. It then has four
    /// blend samples.
    void addSamples(std::size_t every = 1);

    /// Advances all controllers by a frame and computes all palettes; returns when the GPU has finished.
    Spent step();
    void refill();    ///< The first half of step(): fills the batches, one per blend cost, as in PoseFrame.
    Spent evaluate(); ///< The second half, of the batches that are filled.

    /// Requires palettes that agree with the CPU twin's and no GL error.
    void check() const;

    std::size_t count() const { return controllers.size(); }
    const AnimationSet& set() const { return *_set; }

private:
    struct Place
    {
        std::size_t batch, instance;
    };
    void submit();
    PosePipeline& pipeline() const;

    std::shared_ptr<const AnimationSet> _set;
    std::size_t _clip;
    std::vector<PoseBatch> _batches;
    std::vector<Place> _places; ///< of the last step, one per character
    osg::ref_ptr<osg::GraphicsContext> _context;
    std::size_t _firstSlot;
};

/// A feedback pass of points that only writes as many bytes as a palette: the lower bound of the cost.
class FeedbackFloor
{
public:
    FeedbackFloor(std::size_t matrices, osg::GraphicsContext& context);
    ~FeedbackFloor();

    Spent step();

private:
    std::size_t _matrices;
    osg::ref_ptr<osg::GraphicsContext> _context;
    osg::GLExtensions& _gl;
    FeedbackPass _pass;
    BufferTexture _out;
    GLuint _vertexArray = 0;
};

/// Requires a palette that agrees with the CPU twin's for the instruction to 1e-4 of its largest number.
void requireEqual(const AnimationSet& set, const PoseInstruction& instruction, const std::vector<AffineMatrix>& palette,
                  const AffineMatrix& rootMatrix = {});

} // namespace osgGpuAnimation::benchmark
