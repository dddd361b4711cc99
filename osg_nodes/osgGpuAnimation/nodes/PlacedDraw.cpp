// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/PlacedDraw.h>

#include <osgGpuAnimation/nodes/OsgMatrix.h>

#include <layout.glsl>

#include <osg/GLExtensions>

#include <algorithm>
#include <iterator>

namespace osgGpuAnimation
{

namespace
{

constexpr unsigned int attributeLocations[] = {POSE_PLACEMENT_ROW_0_LOCATION, POSE_PLACEMENT_ROW_1_LOCATION,
                                               POSE_PLACEMENT_ROW_2_LOCATION, POSE_PLACED_POSE_LOCATION};

std::size_t poseOf(const Placement& placement)
{
    return static_cast<std::size_t>(placement.pose);
}

} // namespace

PlacedDraw::PlacedDraw(osg::State& state, const PaletteBinding& binding) : _state(state), _binding(binding)
{
    const osg::Program::PerContextProgram* program = state.getLastAppliedProgramObject();
    if (!program || program->getAttribLocation("posePlacedPose") != POSE_PLACED_POSE_LOCATION) return;
    _placements = &PlacementBuffers::of(state).buffer(binding.serial(), binding.placements());
}

PlacedDraw::~PlacedDraw()
{
    if (_placements)
    {
        const osg::GLExtensions& gl = *_state.get<osg::GLExtensions>();
        for (const unsigned int location : attributeLocations)
        {
            gl.glDisableVertexAttribArray(location);
            gl.glVertexAttribDivisor(location, 0);
        }
        return;
    }
    _state.applyModelViewMatrix(new osg::RefMatrix);
    _state.applyModelViewAndProjectionUniformsIfRequired();
}

PlacedDraw::Run PlacedDraw::run(const PosePipeline& pipeline, std::size_t first) const
{
    const std::vector<Placement>& placements = _binding.placements();
    Run run{pipeline.place(*_binding.animationSet(), _binding.slot(), poseOf(placements[first])), 1};
    if (!_placements || run.place.texture == 0) return run;
    const auto isInChunk = [&](std::size_t pose) { return pose >= run.place.chunkBegin && pose < run.place.chunkEnd; };
    while (first + run.count < placements.size() && isInChunk(poseOf(placements[first + run.count])))
        ++run.count;
    run.place.instance = -static_cast<int>(run.place.chunkBegin);
    return run;
}

void PlacedDraw::use(std::size_t first) const
{
    if (_placements)
    {
        // What is bound below is not what OSG knows to be bound.
        _state.getCurrentVertexArrayState()->unbindVertexBufferObject();
        std::size_t offset = first * sizeof(Placement);
        for (const unsigned int location : attributeLocations)
        {
            _placements->bindAttributes(location, 1, sizeof(Placement), offset, 1);
            offset += BufferTexture::texelBytes;
        }
        return;
    }
    _state.applyModelViewMatrix(new osg::RefMatrix(toOsg(_binding.placements()[first].toEye)));
    _state.applyModelViewAndProjectionUniformsIfRequired();
}

bool PlacedDraw::isRefusedBy(const osg::Geometry& mesh)
{
    // Contexts may alias numbered attributes with texture coordinates and secondary colours.
    return mesh.getNumTexCoordArrays() > 1 || mesh.getSecondaryColorArray() ||
           std::any_of(std::begin(attributeLocations), std::end(attributeLocations),
                       [&](unsigned int location) { return mesh.getVertexAttribArray(location) != nullptr; });
}

} // namespace osgGpuAnimation
