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

/// The controllers and palettes of many instances of one set, without a scene: the work from advance() to the finished
/// palette. Requires its graphics context to be current.
class PoseCrowd
{
public:
    PoseCrowd(std::shared_ptr<const AnimationSet> set, std::size_t clip, std::size_t count,
              osg::GraphicsContext& context);
    ~PoseCrowd();

    /// Every n-th instance starts a crossfade that never ends; it adds one blend sample.
    void crossfade(std::size_t clip, std::size_t every = 1);
    /// True: one batch per blend cost, as in PoseFrame. False: one batch for all.
    void setDealtOut(bool isDealtOut) { _isDealtOut = isDealtOut; }

    /// The number of instances that step() passes to the pipeline at a time.
    void setChunkSize(std::size_t instances) { _chunkSize = instances; }

    /// Advances all controllers and computes all palettes; returns when the GPU has finished.
    Spent step(double seconds, PosePipeline::Form form = PosePipeline::Form::Fused);

    /// Compares some palettes with the CPU twin's. Empty if they agree.
    std::string check();

    std::size_t count() const { return _controllers.size(); }
    const AnimationSet& set() const { return *_set; }

    /// Calls function(index, controller) for all characters.
    template <typename Function>
    void forEach(Function function)
    {
        for (std::size_t i = 0; i < count(); ++i)
            function(i, _controllers[i]);
    }

private:
    std::shared_ptr<const AnimationSet> _set;
    std::vector<AnimationController> _controllers;
    struct Place
    {
        std::size_t batch, instance;
    };
    Place add(const PoseInstruction& instruction);

    std::vector<PoseBatch> _batches;
    std::vector<Place> _places; ///< of the last step, one per character
    bool _isDealtOut = true;
    osg::ref_ptr<osg::GraphicsContext> _context;
    std::size_t _firstSlot;
    std::size_t _chunkSize = PosePipeline::usualChunkSize;
};

/// A feedback pass that only writes as many bytes as a palette: the lower bound of the cost. It writes points as the
/// pipeline does, or triangles with up to two matrices more, the cheapest primitive in llvmpipe.
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

/// Compares the palette with the CPU twin's for the instruction. Empty if they agree to 1e-4 of its largest number.
std::string difference(const AnimationSet& set, const PoseInstruction& instruction,
                       const std::vector<AffineMatrix>& palette, const AffineMatrix& rootMatrix = {});

} // namespace osgGpuAnimation::benchmark
