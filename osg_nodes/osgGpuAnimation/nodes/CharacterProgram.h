// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Program>
#include <osg/StateSet>

namespace osgGpuAnimation
{

/// The program that draws SkinnedGeometry: skin.glsl, character.vert and character.frag, in variants
/// (ShaderPermutations) by the modes of the state. All users share one object.
///
/// It does what the fixed pipeline would: OSG's lights that are on, with attenuation and spots, osg::LightModel's
/// ambient, osg::Material (diffuse times vertex colour is the base colour, lit or not), fog, clip planes, the texture
/// of unit 0 with its matrix where GL_TEXTURE_2D is on, and the shadow maps of osgShadow's techniques. In a pass that
/// writes depth alone it does nothing but skin. Uniforms: `float alphaCutoff` (fragments of less alpha are dropped;
/// default 0), `bool unlit` (default false), `bool flatNormals` (lit, each face by its own normal, of the pose; default
/// false).
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
/// (SkinnedGeometry::getInfluenceCount()), 1 to 8. hasMorphs: some of them has morph targets.
void applySkinDefines(osg::StateSet& stateSet, int influences, bool hasMorphs);

} // namespace osgGpuAnimation
