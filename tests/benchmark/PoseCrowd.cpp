// SPDX-License-Identifier: MIT
#include "PoseCrowd.h"

#include "StagedViewer.h"
#include "Subject.h"

#include <osgGpuAnimation/animation/Pose.h>

#include <cmath>

namespace osgGpuAnimation::benchmark
{

namespace
{

constexpr const char* floorShader = R"(
out vec4 row0;
out vec4 row1;
out vec4 row2;
void main()
{
    row0 = row1 = row2 = vec4(float(gl_VertexID));
}
)";

} // namespace

PoseCrowd::PoseCrowd(std::shared_ptr<const AnimationSet> set, std::size_t clip, std::size_t count,
                     osg::GraphicsContext& context)
    : controllers(count, AnimationController(set)), _set(set), _clip(clip),
      _batches(PoseBatch::blendCostCount, PoseBatch(set)), _places(count), _context(&context)
{
    static std::size_t slots = 0;
    _firstSlot = slots;
    slots += _batches.size();
    for (std::size_t i = 0; i < count; ++i)
    {
        static_cast<void>(controllers[i].play(clip));
        controllers[i].seek(phaseOf(i, controllers[i].duration()));
    }
}

void PoseCrowd::addSamples(std::size_t every)
{
    constexpr double hours = 36000.0;
    for (std::size_t i = 0; i < count(); i += every)
        for (int sample = 1; sample < 4; ++sample)
        {
            static_cast<void>(controllers[i].crossfade(_clip, hours));
            controllers[i].advance(0.4 * hours);
        }
}

Spent PoseCrowd::step()
{
    glFinish();
    const Stopwatch stopwatch;
    refill();
    submit();
    return stopwatch.elapsed();
}

void PoseCrowd::refill()
{
    for (PoseBatch& batch : _batches)
        batch.clear();
    for (std::size_t i = 0; i < count(); ++i)
    {
        const PoseInstruction& instruction = controllers[i].advance(frameTime);
        std::size_t batch = 0;
        while (!_batches[batch].accepts(instruction))
            ++batch;
        _places[i] = {batch, _batches[batch].add(instruction)};
    }
}

Spent PoseCrowd::evaluate()
{
    glFinish();
    const Stopwatch stopwatch;
    submit();
    return stopwatch.elapsed();
}

void PoseCrowd::submit()
{
    pipeline().options().form = options.form;
    pipeline().options().chunkSize = options.chunkSize;
    for (std::size_t batch = 0; batch < _batches.size(); ++batch)
        if (_batches[batch].size() > 0) pipeline().evaluate(*_context->getState(), _batches[batch], _firstSlot + batch);
    glFinish();
}

PosePipeline& PoseCrowd::pipeline() const
{
    PosePipeline* pipeline = PosePipeline::of(*_context->getState());
    if (!pipeline) throw std::runtime_error("there is no pose pipeline");
    return *pipeline;
}

void PoseCrowd::check() const
{
    for (const std::size_t i : {std::size_t(0), count() / 2, count() - 1})
        requireEqual(
            *_set, controllers[i].instruction(),
            pipeline().readPalette(*_context->getState(), *_set, _firstSlot + _places[i].batch, _places[i].instance));
    requireNoGlErrors();
}

FeedbackFloor::FeedbackFloor(std::size_t matrices, osg::GraphicsContext& context)
    : _matrices(matrices), _context(&context), _gl(*context.getState()->get<osg::GLExtensions>()),
      _pass(_gl, "floor", {floorShader}, {"row0", "row1", "row2"}), _out(_gl, GL_RGBA32F_ARB)
{
    _gl.glGenVertexArrays(1, &_vertexArray);
    _out.reserve(_matrices * sizeof(AffineMatrix));
}

FeedbackFloor::~FeedbackFloor()
{
    _pass.release();
    _out.release();
    _gl.glDeleteVertexArrays(1, &_vertexArray);
}

Spent FeedbackFloor::step()
{
    glFinish();
    const Stopwatch stopwatch;
    {
        const FeedbackScope scope(*_context->getState(), _vertexArray);
        _pass.use();
        _pass.run(0, _matrices, _out.buffer(), 0);
    }
    glFinish();
    return stopwatch.elapsed();
}

void requireEqual(const AnimationSet& set, const PoseInstruction& instruction, const std::vector<AffineMatrix>& palette,
                  const AffineMatrix& rootMatrix)
{
    std::vector<AffineMatrix> expected;
    Pose::evaluate(set, instruction, rootMatrix, expected);
    if (palette.size() != expected.size()) throw std::runtime_error("there is no palette");
    float size = 1.0f;
    float largest = 0.0f;
    for (std::size_t entry = 0; entry < expected.size(); ++entry)
        for (std::size_t row = 0; row < 3; ++row)
            for (int column = 0; column < 4; ++column)
            {
                const float wanted = expected[entry].rows[row][column];
                const float got = palette[entry].rows[row][column];
                if (!std::isfinite(got)) throw std::runtime_error("an entry of a palette is no number");
                size = std::max(size, std::abs(wanted));
                largest = std::max(largest, std::abs(wanted - got));
            }
    if (largest > 1e-4f * size)
        throw std::runtime_error("a palette differs from the CPU's by " + std::to_string(largest));
}

} // namespace osgGpuAnimation::benchmark
