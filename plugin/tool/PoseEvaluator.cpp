// SPDX-License-Identifier: MIT
#include "tool/PoseEvaluator.h"

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/gpu/OffscreenContext.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/looks/CharacterProgram.h>
#include <osgGpuAnimation/mesh/draw/PaletteBinding.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <ShaderSources.h>

#include <osg/Program>
#include <osg/RenderInfo>
#include <osg/StateSet>

#include <memory>
#include <utility>

namespace osgGpuAnimation::tool
{

namespace
{

osg::ref_ptr<osg::Program> captureProgram()
{
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->setName("osggpuanim capture");
    program->addShader(skinShader());
    program->addShader(
        new osg::Shader(osg::Shader::VERTEX, std::string(shaders::version_glsl) + shaders::capture_vert));
    bindSkinAttributes(*program);
    program->addTransformFeedBackVarying("capturedPosition");
    program->setTransformFeedBackMode(GL_INTERLEAVED_ATTRIBS);
    return program;
}

osg::ref_ptr<SkinnedGeometry> asPoints(const osg::Geometry* geometry)
{
    const auto* skinned = dynamic_cast<const SkinnedGeometry*>(geometry);
    if (!skinned || !skinned->getVertexArray()) return nullptr;
    osg::ref_ptr<SkinnedGeometry> points = new SkinnedGeometry(*skinned);
    points->setStateSet(nullptr);
    points->removePrimitiveSet(0, points->getNumPrimitiveSets());
    const auto count = static_cast<GLsizei>(points->getVertexArray()->getNumElements());
    points->addPrimitiveSet(new osg::DrawArrays(GL_POINTS, 0, count));
    return points;
}

/// The pipeline of a context of its own.
class GpuPoses
{
public:
    GpuPoses(const gltf::ImportedModel& model, osg::ref_ptr<osg::GraphicsContext> context, PosePipeline& pipeline)
        : _model(model), _context(std::move(context)), _pipeline(pipeline), _stateSet(new osg::StateSet)
    {
        osg::ref_ptr<PaletteBinding> binding = new PaletteBinding;
        binding->set(_model.set, 0, 0);
        _stateSet->setAttribute(binding);
        _stateSet->setAttributeAndModes(captureProgram());
        _stateSet->setDefine("POSE_SKINNED"); // as SkinnedGeometry::meshState()
        for (const gltf::ImportedPrimitive& primitive : _model.primitives)
            _points.push_back(asPoints(primitive.geometry));
    }
    GpuPoses(const GpuPoses&) = delete;
    ~GpuPoses()
    {
        if (!_context->makeCurrent()) return;
        for (const osg::ref_ptr<SkinnedGeometry>& points : _points)
            if (points) points->releaseGLObjects(_context->getState());
        _stateSet->releaseGLObjects(_context->getState());
        _context->close();
    }

    Result<EvaluatedPose> evaluate(const PoseInstruction& instruction)
    {
        osg::State& state = *_context->getState();
        PoseBatch batch(_model.set);
        batch.add(instruction);
        if (!_pipeline.evaluate(state, batch, 0)) return Error{"the pose pipeline cannot evaluate this file"};
        EvaluatedPose pose;
        pose.palette = _pipeline.readPalette(state, *_model.set, 0, 0);
        state.pushStateSet(_stateSet);
        state.apply();
        for (const osg::ref_ptr<SkinnedGeometry>& points : _points)
            pose.positions.push_back(points ? capture(*points) : std::vector<glm::dvec3>());
        state.popStateSet();
        state.apply();
        if (const GLenum error = glGetError(); error != GL_NO_ERROR)
            return Error{"OpenGL reports error " + std::to_string(error)};
        return pose;
    }

private:
    std::vector<glm::dvec3> capture(SkinnedGeometry& points);

    const gltf::ImportedModel& _model;
    osg::ref_ptr<osg::GraphicsContext> _context;
    PosePipeline& _pipeline;
    osg::ref_ptr<osg::StateSet> _stateSet; ///< the capturing program and the character's palette
    /// One a primitive: its vertices in order, as points. Null if it is not drawn from the palette.
    std::vector<osg::ref_ptr<SkinnedGeometry>> _points;
};

std::vector<glm::dvec3> GpuPoses::capture(SkinnedGeometry& points)
{
    osg::State& state = *_context->getState();
    const osg::GLExtensions* gl = state.get<osg::GLExtensions>();
    std::vector<float> numbers(std::size_t(3) * points.getVertexArray()->getNumElements());
    const auto bytes = static_cast<GLsizeiptr>(numbers.size() * sizeof(float));
    GLuint buffer = 0;
    gl->glGenBuffers(1, &buffer);
    gl->glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffer); // and as the target's buffer
    gl->glBufferData(GL_TRANSFORM_FEEDBACK_BUFFER, bytes, nullptr, GL_STREAM_READ_ARB);

    osg::RenderInfo renderInfo(&state, nullptr);
    glEnable(GL_RASTERIZER_DISCARD);
    gl->glBeginTransformFeedback(GL_POINTS);
    points.draw(renderInfo);
    gl->glEndTransformFeedback();
    glDisable(GL_RASTERIZER_DISCARD);

    gl->glGetBufferSubData(GL_TRANSFORM_FEEDBACK_BUFFER, 0, bytes, numbers.data());
    gl->glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
    gl->glDeleteBuffers(1, &buffer);
    std::vector<glm::dvec3> positions;
    for (std::size_t v = 0; v < numbers.size(); v += 3)
        positions.emplace_back(numbers[v], numbers[v + 1], numbers[v + 2]);
    return positions;
}

} // namespace

PoseEvaluator cpuPoseEvaluator(const gltf::ImportedModel& model)
{
    const auto evaluate = [&model](const PoseInstruction& instruction)
    {
        EvaluatedPose pose;
        Pose::evaluate(*model.set, instruction, AffineMatrix(), pose.palette);
        for (const gltf::ImportedPrimitive& primitive : model.primitives)
        {
            pose.positions.emplace_back();
            const auto* geometry = dynamic_cast<const SkinnedGeometry*>(primitive.geometry.get());
            if (geometry) geometry->computePositions(pose.palette, pose.positions.back());
        }
        return pose;
    };
    return {"osggpuanim, CPU", evaluate};
}

Result<PoseEvaluator> gpuPoseEvaluator(const gltf::ImportedModel& model)
{
    Result<osg::ref_ptr<osg::GraphicsContext>> context = createOffscreenContext(1, 1);
    if (!context) return context.error();
    if (!context.value()->realize() || !context.value()->makeCurrent())
        return Error{"the graphics context cannot be used"};
    context.value()->getState()->initializeExtensionProcs();
    PosePipeline* pipeline = PosePipeline::of(*context.value()->getState());
    if (!pipeline) return Error{"the graphics context lacks OpenGL 3.3's transform feedback"};
    const auto* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    const auto poses = std::make_shared<GpuPoses>(model, context.value(), *pipeline);
    return PoseEvaluator{std::string("osggpuanim, GPU: ") + (renderer ? renderer : "unknown"),
                         [poses](const PoseInstruction& instruction) { return poses->evaluate(instruction); }};
}

} // namespace osgGpuAnimation::tool
