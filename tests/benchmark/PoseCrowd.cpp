// SPDX-License-Identifier: MIT
#include "PoseCrowd.h"

#include "StagedViewer.h"
#include "Subject.h"

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/gpu/FeedbackPass.h>

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
    : _set(std::move(set)), _controllers(count, AnimationController(_set)),
      _batches(PoseBatch::blendCostCount, PoseBatch(_set)), _places(count), _context(&context)
{
    static std::size_t slots = 0;
    _firstSlot = slots;
    slots += _batches.size();
    for (std::size_t i = 0; i < count; ++i)
    {
        static_cast<void>(_controllers[i].play(clip));
        _controllers[i].seek(phaseOf(i, _controllers[i].duration()));
    }
}

PoseCrowd::~PoseCrowd() = default;

void PoseCrowd::crossfade(std::size_t clip, std::size_t every)
{
    constexpr double hours = 36000.0;
    for (std::size_t i = 0; i < count(); i += every)
    {
        static_cast<void>(_controllers[i].crossfade(clip, hours));
        _controllers[i].advance(0.4 * hours);
    }
}

PoseCrowd::Place PoseCrowd::add(const PoseInstruction& instruction)
{
    std::size_t batch = 0;
    while (_isDealtOut && !_batches[batch].accepts(instruction))
        ++batch;
    return {batch, _batches[batch].add(instruction)};
}

Spent PoseCrowd::step(double seconds, PosePipeline::Form form)
{
    osg::State& state = *_context->getState();
    PosePipeline* pipeline = PosePipeline::of(state);
    if (!pipeline) return {};
    pipeline->options().form = form;
    pipeline->options().chunkSize = _chunkSize;
    glFinish();
    const Stopwatch stopwatch;
    refill(seconds);
    submit(*pipeline);
    return stopwatch.elapsed();
}

void PoseCrowd::refill(double seconds)
{
    for (PoseBatch& batch : _batches)
        batch.clear();
    for (std::size_t i = 0; i < count(); ++i)
        _places[i] = add(_controllers[i].advance(seconds));
}

void PoseCrowd::submit(PosePipeline& pipeline)
{
    for (std::size_t batch = 0; batch < _batches.size(); ++batch)
        if (_batches[batch].size() > 0) pipeline.evaluate(*_context->getState(), _batches[batch], _firstSlot + batch);
    glFinish();
}

Spent PoseCrowd::streamPoses(double seconds)
{
    if (_captured.empty())
        for (int frame = 0; frame < 16; ++frame)
        {
            _captured.emplace_back();
            Pose::mix(*_set, _controllers[0].advance(0.05), _captured.back());
            _captured.back().resize(_set->skeleton().jointCount());
        }
    for (AnimationController& controller : _controllers)
        if (!controller.layer(0).findPose()) controller.layer(0).showPose();
    const Stopwatch stopwatch;
    for (AnimationController& controller : _controllers)
        static_cast<void>(controller.layer(0).pose().setTransforms(_captured[++_capturedFrame % _captured.size()]));
    refill(seconds);
    return stopwatch.elapsed();
}

void PoseCrowd::fade()
{
    for (AnimationController& controller : _controllers)
        controller.layer(0).setWeight(controller.layer(0).weight() == 1.0f ? 0.99f : 1.0f);
}

Spent PoseCrowd::evaluate()
{
    PosePipeline* pipeline = PosePipeline::of(*_context->getState());
    if (!pipeline) return {};
    glFinish();
    const Stopwatch stopwatch;
    submit(*pipeline);
    return stopwatch.elapsed();
}

std::string PoseCrowd::check()
{
    osg::State& state = *_context->getState();
    PosePipeline* pipeline = PosePipeline::of(state);
    if (!pipeline) return "there is no pose pipeline";
    for (const std::size_t instance : {std::size_t(0), count() / 2, count() - 1})
    {
        const Place& place = _places[instance];
        const std::string wrong =
            difference(*_set, _controllers[instance].instruction(),
                       pipeline->readPalette(state, *_set, _firstSlot + place.batch, place.instance));
        if (!wrong.empty()) return "instance " + std::to_string(instance) + ": " + wrong;
    }
    return takeGlErrors();
}

FeedbackFloor::FeedbackFloor(std::size_t matrices, Primitive primitive, osg::GraphicsContext& context)
    : _matrices(primitive == Primitive::Triangles ? (matrices + 2) / 3 * 3 : matrices), _primitive(primitive),
      _context(&context),
      _pass(*context.getState()->get<osg::GLExtensions>(), "floor", {floorShader}, {"row0", "row1", "row2"}),
      _out(*context.getState()->get<osg::GLExtensions>(), GL_RGBA32F_ARB)
{
    context.getState()->get<osg::GLExtensions>()->glGenVertexArrays(1, &_vertexArray);
    _out.reserve(_matrices * sizeof(AffineMatrix));
}

FeedbackFloor::~FeedbackFloor()
{
    _pass.release();
    _out.release();
    _context->getState()->get<osg::GLExtensions>()->glDeleteVertexArrays(1, &_vertexArray);
}

Spent FeedbackFloor::step()
{
    glFinish();
    const Stopwatch stopwatch;
    {
        const FeedbackScope scope(*_context->getState(), _vertexArray);
        _pass.use();
        if (_primitive == Primitive::Points)
            _pass.run(0, _matrices, _out.buffer(), 0);
        else
            _pass.runInstanced(_matrices, 1, 0, _out.buffer(), 0);
    }
    glFinish();
    return stopwatch.elapsed();
}

std::string difference(const AnimationSet& set, const PoseInstruction& instruction,
                       const std::vector<AffineMatrix>& palette, const AffineMatrix& rootMatrix)
{
    std::vector<AffineMatrix> expected;
    Pose::evaluate(set, instruction, rootMatrix, expected);
    if (palette.size() != expected.size()) return "there is no palette";
    float size = 1.0f;
    float largest = 0.0f;
    for (std::size_t entry = 0; entry < expected.size(); ++entry)
        for (std::size_t row = 0; row < 3; ++row)
            for (int column = 0; column < 4; ++column)
            {
                const float wanted = expected[entry].rows[row][column];
                const float got = palette[entry].rows[row][column];
                if (!std::isfinite(got)) return "entry " + std::to_string(entry) + " is no number";
                size = std::max(size, std::abs(wanted));
                largest = std::max(largest, std::abs(wanted - got));
            }
    return largest <= 1e-4f * size ? "" : "differs from the CPU's by " + std::to_string(largest);
}

} // namespace osgGpuAnimation::benchmark
