// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/gpu/passes/EvaluationContext.h>

#include <ShaderSources.h>

namespace osgGpuAnimation
{

EvaluationContext::EvaluationContext(osg::GLExtensions& extensions)
    : gl(&extensions), vertexArrays(extensions), scratch(extensions, GL_RGBA32F_ARB),
      mixedTracks(extensions, GL_RGBA32F_ARB), solved(extensions, GL_RGBA32F_ARB),
      corrections(extensions, GL_RGBA32F_ARB)
{
    osg::setGLExtensionFuncPtr(copyBufferSubData, "glCopyBufferSubData");
}

FeedbackPass& EvaluationContext::pass(Stage stage, const PoseVariant& variant, const ConstraintShape& shape)
{
    using namespace shaders;
    std::unique_ptr<FeedbackPass>& pass = _passes[{stage, variant, shape}];
    if (pass) return *pass;
    const std::vector<const char*> rows{"row0", "row1", "row2"};
    const char* const limits = "const bool hasLimits = true;\n";
    const std::string constants = variant.constants() + (stage == Stage::Constrain ? shape.constants() : "");
    const char* const given = constants.c_str();
    const auto make =
        [&](const char* name, std::initializer_list<const char*> source, const std::vector<const char*>& outputs)
    { pass = std::make_unique<FeedbackPass>(*gl, name, source, outputs); };
    std::vector<std::string> rotations;
    for (int joint = 0; joint < shape.chainLength; ++joint)
        rotations.push_back("rotations[" + std::to_string(joint) + "]");
    std::vector<const char*> solved;
    for (const std::string& rotation : rotations)
        solved.push_back(rotation.c_str());
    if (stage == Stage::Pose) make("pose", {given, mix_glsl, local_glsl, world_glsl, pose_vert}, rows);
    if (stage == Stage::Constrain)
        make("constrain", {given, mix_glsl, local_glsl, world_glsl, constrain_glsl, constrain_vert}, solved);
    if (stage == Stage::Mix) make("mix", {given, mix_glsl, mix_vert}, {"translation", "rotation", "scale"});
    if (stage == Stage::Local) make("local", {local_glsl, local_vert}, rows);
    if (stage == Stage::World) make("world", {limits, world_glsl, world_vert}, rows);
    return *pass;
}

void EvaluationContext::useMixInput(FeedbackScope& scope, FeedbackPass& pass, const AnimationSet& set,
                                    const AnimationBuffers& buffers, const PosePalette::Chunk& chunk) const
{
    pass.use();
    pass.setTexture(scope, "keyframes", unitKeyframes, buffers.keyframes().texture());
    pass.setTexture(scope, "samples", unitSamples, chunk.samples.texture());
    pass.setTexture(scope, "masks", unitMasks, buffers.masks().texture());
    pass.setInt("maskStride", static_cast<int>(AnimationBuffers::texelsPerMask(set)));
    if (!chunk.uploadedPosed.empty())
    {
        pass.setTexture(scope, "posedKeyframes", unitPosed, chunk.posed.texture());
        pass.setInt("firstPosed", static_cast<int>(chunk.firstPosed));
        pass.setInt("trackCount", static_cast<int>(set.trackCount()));
    }
    pass.setInt("sampleStride", static_cast<int>(chunk.sampleStride));
    pass.setInt("instanceCount", static_cast<int>(chunk.width));
    pass.setInt("restTexel", static_cast<int>(buffers.restTexel()));
    pass.setInt("jointCount", static_cast<int>(set.skeleton().jointCount()));
}

void EvaluationContext::copy(const BufferTexture& from, const BufferTexture& to, std::size_t unitBytes,
                             const std::vector<UnitCopy>& copies) const
{
    if (copies.empty()) return;
    gl->glBindBuffer(GL_COPY_READ_BUFFER, from.buffer());
    gl->glBindBuffer(GL_COPY_WRITE_BUFFER, to.buffer());
    for (const UnitCopy& copy : copies)
        copyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, static_cast<GLintptr>(copy.from * unitBytes),
                          static_cast<GLintptr>(copy.to * unitBytes), static_cast<GLsizeiptr>(copy.count * unitBytes));
    gl->glBindBuffer(GL_COPY_READ_BUFFER, 0);
    gl->glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
}

void EvaluationContext::release()
{
    for (auto& [key, pass] : _passes)
        pass->release();
    for (BufferTexture* buffer : {&scratch, &mixedTracks, &solved, &corrections})
        buffer->release();
    vertexArrays.release();
    discard();
}

void EvaluationContext::discard()
{
    _passes.clear();
    for (BufferTexture* buffer : {&scratch, &mixedTracks, &solved, &corrections})
        buffer->discard();
    vertexArrays.discard();
}

} // namespace osgGpuAnimation
