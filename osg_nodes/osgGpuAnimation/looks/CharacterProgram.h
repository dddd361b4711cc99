// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Program>
#include <osg/StateSet>

namespace osgGpuAnimation
{

/// The program that draws SkinnedGeometry: skin.glsl, character.vert and character.frag, in permutations by the modes
/// of the state (ShaderPermutations). All users share one object.
///
/// It reproduces the fixed pipeline: OSG's enabled lights with attenuation and spots, osg::LightModel's ambient colour,
/// osg::Material (diffuse times vertex colour is the base colour, lit or not), fog, clip planes, the texture of unit 0
/// with its matrix if GL_TEXTURE_2D is on, and the shadow maps of osgShadow's techniques. In a depth-only pass it only
/// skins. With applyPbrMaterial() it shades glTF's metallic-roughness material in linear light instead. Uniforms:
/// `float alphaCutoff` (fragments with less alpha are discarded; default 0), `bool unlit` (default false), `bool
/// flatNormals` (lights each face by its own posed normal; default false).
osg::ref_ptr<osg::Program> characterProgram();

/// Sets the program, its uniforms' defaults and, if unit 0 has no texture, a white texture in the state.
void applyCharacterProgram(osg::StateSet& stateSet);

/// The same program for an osg::Geometry that does not move. Any program above with OVERRIDE replaces it.
osg::ref_ptr<osg::Program> surfaceProgram();
/// Sets the surface program as applyCharacterProgram() does the other. colored: the geometry has colours of its own for
/// each vertex.
void applySurfaceProgram(osg::StateSet& stateSet, bool colored);

/// skin.glsl as a shader object for another program, whose vertex shader declares and calls
///
///     void osgGpuAnimationSkin(inout vec4 vertex, inout vec3 normal);
///
/// Such a program also needs bindSkinAttributes().
osg::ref_ptr<osg::Shader> skinShader();
/// The vertex shader of characterProgram(), with the inputs of materialShader(), as a shader object for another program
/// of characters. Such a program also needs skinShader() and bindSkinAttributes().
osg::ref_ptr<osg::Shader> surfaceVertexShader();
/// material.glsl as a fragment shader object for another program, whose fragment shader declares and calls
/// osgGpuAnimationMaterial().
osg::ref_ptr<osg::Shader> materialShader();
/// Binds the attributes of the two vertex shaders to the locations of layout.glsl.
void bindSkinAttributes(osg::Program& program);

/// Sets shader defines that remove unused parts of skin.glsl for the meshes of this state, which saves a third of a
/// draw's cost in llvmpipe. influences: the largest SkinnedGeometry::getInfluenceCount() of these meshes, in [1, 8].
/// hasMorphs: true if one of them has morph targets.
void applySkinDefines(osg::StateSet& stateSet, int influences, bool hasMorphs);

} // namespace osgGpuAnimation
