// SPDX-License-Identifier: MIT
#pragma once

#include "Stopwatch.h"

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/gpu/buffers/BufferTexture.h>
#include <osgGpuAnimation/gpu/EglGraphicsContext.h>
#include <osgGpuAnimation/gpu/FeedbackPass.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>

#include <memory>
#include <string>
#include <vector>

namespace osgGpuAnimation::benchmark
{

/// So many controllers of one set and their palettes, without a scene: all from advance() to the finished palette.
/// Needs its graphics context current.
class PoseCrowd
{
public:
    PoseCrowd(std::shared_ptr<const AnimationSet> set, std::size_t clip, std::size_t count,
              osg::GraphicsContext& context);
    ~PoseCrowd();

    /// Every so-manieth begins a crossfade that goes on for hours: one more blend sample each.
    void crossfade(std::size_t clip, std::size_t every = 1);
    /// Whether those of another load get batches of their own, as PoseFrame does it; otherwise all go into one.
    void setDealtOut(bool isDealtOut) { _isDealtOut = isDealtOut; }

    /// Instances that step() has the pipeline evaluate at a time.
    void setChunkSize(std::size_t instances) { _chunkSize = instances; }

    /// Moves everybody on and computes all palettes, until the GPU has finished.
    Spent step(double seconds, PosePipeline::Form form = PosePipeline::Form::Fused);

    /// Reads some palettes back and compares them with the CPU twin's. Empty: all is well.
    std::string check();

    std::size_t count() const { return _controllers.size(); }

private:
    std::shared_ptr<const AnimationSet> _set;
    std::vector<AnimationController> _controllers;
    struct Place
    {
        std::size_t batch, instance;
    };
    Place add(const PoseInstruction& instruction);

    std::vector<PoseBatch> _batches;
    std::vector<Place> _places; ///< of the last step, a character each
    bool _isDealtOut = true;
    osg::ref_ptr<osg::GraphicsContext> _context;
    std::size_t _firstSlot;
    std::size_t _chunkSize = PosePipeline::usualChunkSize;
};

/// A feedback pass that writes as many bytes as a palette, and nothing else: the floor. In points as the design has it,
/// or in triangles, up to two matrices more, which is the least that llvmpipe can do.
class FeedbackFloor
{
public:
    enum class Primitive
    {
        Points,
        Triangles,
    };

    FeedbackFloor(std::size_t matrices, Primitive primitive, osg::GraphicsContext& context);
    ~FeedbackFloor();

    Spent step();

private:
    std::size_t _matrices;
    Primitive _primitive;
    osg::ref_ptr<osg::GraphicsContext> _context;
    FeedbackPass _pass;
    BufferTexture _out;
    GLuint _vertexArray = 0;
};

/// Is the palette what the CPU twin makes of the instruction? Empty: yes, to 1e-4 of its largest number.
std::string difference(const AnimationSet& set, const PoseInstruction& instruction,
                       const std::vector<AffineMatrix>& palette, const AffineMatrix& rootMatrix = {});

} // namespace osgGpuAnimation::benchmark
