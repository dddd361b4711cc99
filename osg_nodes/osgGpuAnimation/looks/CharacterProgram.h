// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Program>
#include <osg/StateSet>

namespace osgGpuAnimation
{

/// The program that draws SkinnedGeometry: skin.glsl, character.vert and character.frag, in permutations by the modes
/// of the state (ShaderPermutations). All users share one object. A ShaderHook above adds functions of the host.
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
/// Such a program also needs bindSkinAttributes(). Meshes that are no SkinnedGeometry stay as they are, so that the
/// program may be set above them, too. Set above characters with OVERRIDE it replaces characterProgram(). An attribute
/// of the type PROGRAM that is no osg::Program with this shader does so if its StateSet has the shader define
/// POSE_SKINNING_PROGRAM.
osg::ref_ptr<osg::Shader> skinShader();
/// The vertex shader of characterProgram() as a shader object for another program of characters. Such a program also
/// needs skinShader() and bindSkinAttributes(). It writes, for fragment shaders:
///
///     in vec3 viewPosition;      // in eye space
///     in vec3 viewNormal;        // in eye space, of any length; 0: unknown
///     in vec4 vertexColor;       // with the shader defines POSE_COLORED or POSE_TINTED
///     in vec2 textureCoordinate; // of the base colour
osg::ref_ptr<osg::Shader> surfaceVertexShader();
/// material.glsl as a fragment shader object for another program, whose fragment shader declares and calls
/// osgGpuAnimationMaterial(). It reads the inputs that surfaceVertexShader() writes.
osg::ref_ptr<osg::Shader> materialShader();
/// All of materialShader(), and the kit's light (light.glsl) as functions for another program, which links one of the
/// two:
///
///     vec3 osgGpuAnimationLight(vec3 baseColor, vec3 emission, vec3 metallicRoughnessOcclusion, vec3 normal);
///     vec3 osgGpuAnimationDisplay(vec3 color); // tone mapping, and encoding for the display
///     vec3 osgGpuAnimationFog(vec3 color);
///
/// The first gives the light that a surface at viewPosition sends to the eye: with the shader define MATERIAL_PBR of
/// applyPbrMaterial() linear radiance, else the colour of the fixed pipeline. The kit's own program reads the modes of
/// the state; another program has shader defines for them. isCore: for a core profile, with a headlight and without
/// fog.
///
/// | define            | value                                                                   | without it |
/// | ----------------- | ----------------------------------------------------------------------- | ---------- |
/// | DRAW_LIGHTS       | a bit for each GL_LIGHTi that shines                                    | 1          |
/// | DRAW_POINT_LIGHTS | a bit for each of them that has a position                              | 0          |
/// | DRAW_SHADOW_MAPS  | a bit for each texture unit, 1 to 7, with a map of osgShadow            | 0          |
/// | DRAW_FOG          | 1: LINEAR, 2: EXP, 3: EXP2                                              | 0          |
/// | DRAW_ENCODED      | 0 with GL_FRAMEBUFFER_SRGB                                              | 1          |
///
/// Shadow maps need an int uniform `shadowMaps` of 7 elements with the values 1 to 7, too. Lights of glTF files have no
/// range and OpenGL's cone.
osg::ref_ptr<osg::Shader> lightShader(bool isCore);
/// For a compatibility profile, or, with an OSG without the fixed pipeline, for a core profile.
osg::ref_ptr<osg::Shader> lightShader();
/// Binds the attributes of the two vertex shaders to the locations of layout.glsl.
void bindSkinAttributes(osg::Program& program);

/// Sets shader defines that remove unused parts of skin.glsl for the meshes of this state, which saves a third of a
/// draw's cost in llvmpipe. influences: the largest SkinnedGeometry::getInfluenceCount() of these meshes, in [1, 8].
/// hasMorphs: true if one of them has morph targets.
void applySkinDefines(osg::StateSet& stateSet, int influences, bool hasMorphs);

} // namespace osgGpuAnimation
