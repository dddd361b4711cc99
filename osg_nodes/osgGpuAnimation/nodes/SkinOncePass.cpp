// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/SkinOncePass.h>

#include <osgGpuAnimation/nodes/CharacterProgram.h>

#include <ShaderSources.h>

#include <osg/observer_ptr>
#include <osg/Program>

#include <string>

#ifndef GL_RASTERIZER_DISCARD
#define GL_RASTERIZER_DISCARD 0x8C89
#endif

namespace osgGpuAnimation
{

namespace
{

osg::ref_ptr<osg::Program> makeOnceProgram(bool hasNormals)
{
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->setName("osgGpuAnimation skin once");
    program->addShader(skinShader());
    program->addShader(new osg::Shader(osg::Shader::VERTEX, std::string("#version 140\n#define ONCE_NORMALS ") +
                                                                (hasNormals ? "1\n" : "0\n") + shaders::once_vert));
    bindSkinAttributes(*program);
    program->setTransformFeedBackMode(GL_INTERLEAVED_ATTRIBS);
    program->addTransformFeedBackVarying("skinnedPosition");
    if (hasNormals) program->addTransformFeedBackVarying("skinnedNormal");
    return program;
}

} // namespace

SkinOncePass::SkinOncePass() : _programs{makeOnceProgram(false), makeOnceProgram(true)} {}

osg::ref_ptr<SkinOncePass> SkinOncePass::shared()
{
    static std::mutex mutex;
    static osg::observer_ptr<SkinOncePass> known;
    const std::lock_guard<std::mutex> lock(mutex);
    osg::ref_ptr<SkinOncePass> pass;
    if (known.lock(pass)) return pass;
    pass = new SkinOncePass;
    known = pass.get();
    return pass;
}

osg::StateSet* SkinOncePass::state(const Variant& variant)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    osg::ref_ptr<osg::StateSet>& stateSet = _states[variant];
    if (stateSet) return stateSet;
    stateSet = new osg::StateSet;
    stateSet->setAttributeAndModes(_programs[variant.hasNormals],
                                   osg::StateAttribute::ON | osg::StateAttribute::PROTECTED);
    stateSet->setMode(GL_RASTERIZER_DISCARD, osg::StateAttribute::ON | osg::StateAttribute::PROTECTED);
    applySkinDefines(*stateSet, variant.influences, variant.hasMorphs);
    return stateSet;
}

bool SkinOncePass::works(osg::State& state, const Variant& variant)
{
    state.pushStateSet(this->state(variant));
    state.apply();
    const osg::Program::PerContextProgram* program = state.getLastAppliedProgramObject();
    const bool isLinked = program && program->isLinked() && program->getProgram() == _programs[variant.hasNormals];
    state.popStateSet();
    state.apply();
    return isLinked;
}

void SkinOncePass::releaseGLObjects(osg::State* state)
{
    for (const osg::ref_ptr<osg::Program>& program : _programs)
        program->releaseGLObjects(state);
}

void SkinOncePass::resizeGLObjectBuffers(unsigned int maxSize)
{
    for (const osg::ref_ptr<osg::Program>& program : _programs)
        program->resizeGLObjectBuffers(maxSize);
}

} // namespace osgGpuAnimation
