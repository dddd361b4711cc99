// SPDX-License-Identifier: MIT
#include "tool/PoseEvaluator.h"

#include <osgGpuAnimation/gpu/OffscreenContext.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/looks/CharacterProgram.h>
#include <osgGpuAnimation/mesh/draw/PaletteBinding.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <ShaderSources.h>

#include <osg/Program>
#include <osg/RenderInfo>
#include <osg/StateSet>

#ifndef GL_TEXTURE_BUFFER_DATA_STORE_BINDING
#define GL_TEXTURE_BUFFER_DATA_STORE_BINDING 0x8C2D
#endif

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

class GpuPoseEvaluator : public PoseEvaluator
{
public:
    GpuPoseEvaluator(const gltf::ImportedModel& model, osg::ref_ptr<osg::GraphicsContext> context,
                     PosePipeline& pipeline);
    ~GpuPoseEvaluator() override;

    std::string name() const override;
    Result<EvaluatedPose> evaluate(const PoseInstruction& instruction,
                                   const std::vector<FixedEntry>& fixedEntries) override;

private:
    void writeEntries(const std::vector<FixedEntry>& fixedEntries);
    std::vector<glm::dvec3> capture(SkinnedGeometry& points);

    const gltf::ImportedModel& _model;
    osg::ref_ptr<osg::GraphicsContext> _context;
    PosePipeline& _pipeline;
    osg::ref_ptr<osg::StateSet> _stateSet; ///< the capturing program and the character's palette
    /// One a primitive: its vertices in order, as points. Null if it is not drawn from the palette.
    std::vector<osg::ref_ptr<SkinnedGeometry>> _points;
};

GpuPoseEvaluator::GpuPoseEvaluator(const gltf::ImportedModel& model, osg::ref_ptr<osg::GraphicsContext> context,
                                   PosePipeline& pipeline)
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

GpuPoseEvaluator::~GpuPoseEvaluator()
{
    if (!_context->makeCurrent()) return;
    for (const osg::ref_ptr<SkinnedGeometry>& points : _points)
        if (points) points->releaseGLObjects(_context->getState());
    _stateSet->releaseGLObjects(_context->getState());
    _context->close();
}

std::string GpuPoseEvaluator::name() const
{
    const auto* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    return std::string("osggpuanim, GPU: ") + (renderer ? renderer : "unknown");
}

Result<EvaluatedPose> GpuPoseEvaluator::evaluate(const PoseInstruction& instruction,
                                                 const std::vector<FixedEntry>& fixedEntries)
{
    osg::State& state = *_context->getState();
    PoseBatch batch(_model.set);
    batch.add(instruction);
    if (!_pipeline.evaluate(state, batch, 0)) return Error{"the pose pipeline cannot evaluate this file"};
    writeEntries(fixedEntries);

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

void GpuPoseEvaluator::writeEntries(const std::vector<FixedEntry>& fixedEntries)
{
    if (fixedEntries.empty()) return;
    const PalettePlace place = _pipeline.place(*_model.set, 0, 0);
    const osg::GLExtensions* gl = _context->getState()->get<osg::GLExtensions>();
    GLint buffer = 0;
    glBindTexture(GL_TEXTURE_BUFFER, place.texture);
    glGetTexLevelParameteriv(GL_TEXTURE_BUFFER, 0, GL_TEXTURE_BUFFER_DATA_STORE_BINDING, &buffer);
    glBindTexture(GL_TEXTURE_BUFFER, 0);
    gl->glBindBuffer(GL_TEXTURE_BUFFER, static_cast<GLuint>(buffer));
    for (const FixedEntry& fixed : fixedEntries)
    {
        const auto matrix = static_cast<GLintptr>(fixed.entry) * place.stride + place.instance;
        gl->glBufferSubData(GL_TEXTURE_BUFFER, matrix * static_cast<GLintptr>(sizeof(AffineMatrix)),
                            sizeof(AffineMatrix), &fixed.value);
    }
    gl->glBindBuffer(GL_TEXTURE_BUFFER, 0);
}

std::vector<glm::dvec3> GpuPoseEvaluator::capture(SkinnedGeometry& points)
{
    osg::State& state = *_context->getState();
    const osg::GLExtensions* gl = state.get<osg::GLExtensions>();
    std::vector<float> numbers(std::size_t(3) * points.getVertexArray()->getNumElements());
    const auto bytes = static_cast<GLsizeiptr>(numbers.size() * sizeof(float));
    GLuint buffer = 0;
    gl->glGenBuffers(1, &buffer);
    gl->glBindBuffer(GL_TRANSFORM_FEEDBACK_BUFFER, buffer);
    gl->glBufferData(GL_TRANSFORM_FEEDBACK_BUFFER, bytes, nullptr, GL_STREAM_READ_ARB);
    gl->glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffer);

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

Result<std::unique_ptr<PoseEvaluator>> gpuPoseEvaluator(const gltf::ImportedModel& model)
{
    Result<osg::ref_ptr<osg::GraphicsContext>> context = createOffscreenContext(1, 1);
    if (!context) return context.error();
    if (!context.value()->realize() || !context.value()->makeCurrent())
        return Error{"the graphics context cannot be used"};
    context.value()->getState()->initializeExtensionProcs();
    PosePipeline* pipeline = PosePipeline::of(*context.value()->getState());
    if (!pipeline) return Error{"the graphics context lacks OpenGL 3.3's transform feedback"};
    return std::unique_ptr<PoseEvaluator>(std::make_unique<GpuPoseEvaluator>(model, context.value(), *pipeline));
}

} // namespace osgGpuAnimation::tool
