// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/PlacedDraw.h>

#include <layout.glsl>

#include <osg/GLExtensions>

namespace osgGpuAnimation
{

namespace
{

std::size_t poseOf(const Placement& placement)
{
    return static_cast<std::size_t>(placement.pose);
}

osg::ref_ptr<osg::RefMatrix> toMatrix(const AffineMatrix& affine)
{
    osg::ref_ptr<osg::RefMatrix> matrix = new osg::RefMatrix;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
            (*matrix)(column, row) = static_cast<double>(affine.rows[static_cast<std::size_t>(row)][column]);
    return matrix;
}

} // namespace

PlacedDraw::PlacedDraw(osg::State& state, const PaletteBinding& binding) : _state(state), _binding(binding)
{
    static const unsigned int placementsName = osg::Uniform::getNameID("posePlacements");
    static const unsigned int firstName = osg::Uniform::getNameID("posePlacement");
    const osg::Program::PerContextProgram* program = state.getLastAppliedProgramObject();
    const GLint placements = program ? program->getUniformLocation(placementsName) : -1;
    if (placements < 0) return;
    _firstLocation = program->getUniformLocation(firstName);
    const GLuint texture = PlacementBuffers::of(state).texture(binding.serial(), binding.placements());
    state.setActiveTextureUnit(POSE_PLACEMENT_UNIT);
    glBindTexture(GL_TEXTURE_BUFFER, texture);
    state.get<osg::GLExtensions>()->glUniform1i(placements, POSE_PLACEMENT_UNIT);
}

PlacedDraw::~PlacedDraw()
{
    if (_firstLocation >= 0) return;
    _state.applyModelViewMatrix(new osg::RefMatrix);
    _state.applyModelViewAndProjectionUniformsIfRequired();
}

PlacedDraw::Run PlacedDraw::run(const PosePipeline& pipeline, std::size_t first) const
{
    const std::vector<Placement>& placements = _binding.placements();
    const std::size_t pose = poseOf(placements[first]);
    Run run{pipeline.place(*_binding.animationSet(), _binding.slot(), pose), 1};
    if (_firstLocation < 0 || run.place.texture == 0) return run;
    const std::size_t chunkBegin = pose - static_cast<std::size_t>(run.place.instance);
    const std::size_t chunkEnd = chunkBegin + static_cast<std::size_t>(run.place.stride);
    const auto isInChunk = [&](std::size_t other) { return other >= chunkBegin && other < chunkEnd; };
    while (first + run.count < placements.size() && isInChunk(poseOf(placements[first + run.count])))
        ++run.count;
    run.place.instance = -static_cast<int>(chunkBegin);
    return run;
}

void PlacedDraw::use(std::size_t first) const
{
    if (_firstLocation >= 0)
    {
        _state.get<osg::GLExtensions>()->glUniform1i(_firstLocation, static_cast<GLint>(first));
        return;
    }
    _state.applyModelViewMatrix(toMatrix(_binding.placements()[first].toEye));
    _state.applyModelViewAndProjectionUniformsIfRequired();
}

} // namespace osgGpuAnimation
