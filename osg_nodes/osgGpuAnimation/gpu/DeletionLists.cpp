// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/gpu/DeletionLists.h>

#include <osg/ContextData>
#include <osg/Program>
#include <osg/VertexArrayState>

namespace osgGpuAnimation
{

void DeletionLists::make(osg::State& state)
{
    const unsigned int contextId = state.getContextID();
    DeletionLists& lists = *osg::get<DeletionLists>(contextId);
    if (lists._areMade) return;
    lists._areMade = true;
    // There is no other way to a list than to drop something.
    const osg::ref_ptr<osg::Shader> shader = new osg::Shader(osg::Shader::VERTEX);
    const osg::ref_ptr<osg::Program> program = new osg::Program;
    const osg::ref_ptr<osg::Referenced> ofShader = new osg::Shader::PerContextShader(shader, contextId);
    const osg::ref_ptr<osg::Referenced> ofProgram = new osg::Program::PerContextProgram(program, contextId);
    const osg::ref_ptr<osg::VertexArrayState> arrays = new osg::VertexArrayState(&state);
    arrays->release();
}

} // namespace osgGpuAnimation
