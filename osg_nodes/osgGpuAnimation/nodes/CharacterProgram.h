// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Program>
#include <osg/StateSet>

namespace osgGpuAnimation
{

/// What characterProgram() is. It has a class of its own so that files name it instead of holding its shaders: they are
/// made anew by the library that reads them.
class CharacterProgram : public osg::Program
{
public:
    CharacterProgram();
    CharacterProgram(const CharacterProgram& other, const osg::CopyOp& copyop = osg::CopyOp::SHALLOW_COPY);
    META_StateAttribute(osgGpuAnimation, CharacterProgram, PROGRAM)

        protected : ~CharacterProgram() override = default;
};

/// The program that draws SkinnedGeometry: skin.glsl, character.vert and character.frag. All users share one object.
///
/// It lights by OSG's light 0 as the fixed pipeline does, with the osg::Material of the state (diffuse times vertex
/// colour is the base colour), and always samples a base colour texture on unit 0.
/// Uniforms: `float alphaCutoff` (fragments of less alpha are dropped; default 0), `bool unlit` (default false).
osg::ref_ptr<osg::Program> characterProgram();

/// Puts the program, its uniforms' defaults and a white texture on unit 0 (where there is none) into the state.
void applyCharacterProgram(osg::StateSet& stateSet);

/// skin.glsl as a shader object, to be added to a program of one's own, whose vertex shader declares and calls
///
///     void osgGpuAnimationSkin(inout vec4 vertex, inout vec3 normal);
///
/// Such a program needs bindSkinAttributes() too.
osg::ref_ptr<osg::Shader> skinShader();
void bindSkinAttributes(osg::Program& program);

/// Tells skin.glsl, by shader defines of the state its meshes are drawn with, what it can leave out: a third of the
/// cost of a draw in llvmpipe. influences: what a vertex of these meshes has at most
/// (SkinnedGeometry::influenceCount()), 1 to 8. hasMorphs: some of them has morph targets.
void applySkinDefines(osg::StateSet& stateSet, int influences, bool hasMorphs);

} // namespace osgGpuAnimation
