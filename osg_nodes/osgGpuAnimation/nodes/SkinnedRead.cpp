// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/SkinnedRead.h>

#include <osgGpuAnimation/gpu/PosePalette.h>
#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

#include <layout.glsl>

#include <osg/Program>
#include <osg/Texture>

#include <limits>

namespace osgGpuAnimation
{

namespace
{

unsigned int skinnedName()
{
    static const unsigned int name = osg::Uniform::getNameID("poseSkinned");
    return name;
}

} // namespace

SkinnedRead::SkinnedRead(osg::State& state, const SkinnedGeometry& mesh, const PaletteBinding& binding)
    : _state(state), _subject{mesh.number(), binding.animationSet(), binding.slot()},
      _vertexCount(static_cast<GLint>(mesh.vertexCount()))
{
    const osg::Program::PerContextProgram* program = state.getLastAppliedProgramObject();
    _isNeeded = program && program->getUniformLocation(skinnedName()) >= 0;
}

bool SkinnedRead::find(std::size_t instance)
{
    _place = _isNeeded ? SkinnedVertices::of(_state).place(_subject, instance)
                       : SkinnedVertices::Place{0, 0, std::numeric_limits<std::size_t>::max()};
    return !_isNeeded || _place.texture != 0;
}

void SkinnedRead::bind(const PalettePlace& palette) const
{
    if (!_isNeeded) return;
    static const unsigned int placeName = osg::Uniform::getNameID("poseSkinnedPlace");
    const osg::Program::PerContextProgram& program = *_state.getLastAppliedProgramObject();
    const osg::GLExtensions& gl = *_state.get<osg::GLExtensions>();
    _state.setActiveTextureUnit(POSE_SKINNED_UNIT);
    glBindTexture(GL_TEXTURE_BUFFER, _place.texture);
    gl.glUniform1i(program.getUniformLocation(skinnedName()), POSE_SKINNED_UNIT);
    gl.glUniform2i(program.getUniformLocation(placeName), static_cast<GLint>(_place.first - palette.chunkBegin),
                   _vertexCount);
}

} // namespace osgGpuAnimation
