// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/PaletteUniforms.h>

#include <layout.glsl>

#include <osg/Program>
#include <osg/Texture>

namespace osgGpuAnimation
{

void bindPalette(osg::State& state, const PalettePlace& place, int influences, int rigidEntry)
{
    const osg::Program::PerContextProgram* program = state.getLastAppliedProgramObject();
    if (!program) return;
    static const unsigned int paletteName = osg::Uniform::getNameID("posePalette");
    static const unsigned int strideName = osg::Uniform::getNameID("poseStride");
    static const unsigned int instanceName = osg::Uniform::getNameID("poseInstance");
    static const unsigned int influencesName = osg::Uniform::getNameID("poseInfluences");
    static const unsigned int tintsName = osg::Uniform::getNameID("poseTints");
    static const unsigned int tintedName = osg::Uniform::getNameID("poseTinted");
    const osg::GLExtensions* gl = state.get<osg::GLExtensions>();
    state.setActiveTextureUnit(POSE_PALETTE_UNIT);
    glBindTexture(GL_TEXTURE_BUFFER, place.texture);
    gl->glUniform1i(program->getUniformLocation(paletteName), POSE_PALETTE_UNIT);
    gl->glUniform1i(program->getUniformLocation(strideName), place.stride);
    gl->glUniform1i(program->getUniformLocation(instanceName), place.instance);
    gl->glUniform1i(program->getUniformLocation(influencesName), influences);
    if (rigidEntry >= 0)
    {
        gl->glVertexAttrib4f(POSE_ENTRIES_0_LOCATION, static_cast<GLfloat>(rigidEntry), 0, 0, 0);
        gl->glVertexAttrib4f(POSE_WEIGHTS_0_LOCATION, 1, 0, 0, 0);
    }
    gl->glUniform1i(program->getUniformLocation(tintsName), POSE_TINT_UNIT);
    gl->glUniform1i(program->getUniformLocation(tintedName), place.tints != 0 ? 1 : 0);
    if (place.tints != 0)
    {
        state.setActiveTextureUnit(POSE_TINT_UNIT);
        glBindTexture(GL_TEXTURE_BUFFER, place.tints);
    }
}

} // namespace osgGpuAnimation
