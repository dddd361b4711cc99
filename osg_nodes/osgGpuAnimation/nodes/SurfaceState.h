// SPDX-License-Identifier: MIT
#pragma once

#include <osg/State>

#include <cstdint>
#include <string>
#include <tuple>

namespace osgGpuAnimation
{

/// What the character's shaders are compiled for: of OSG's modes and attributes above and at a mesh, those that the
/// fixed pipeline would act on and a shader has to act on itself. Each combination is a program of its own, since some
/// drivers (llvmpipe) run both sides of every branch.
struct SurfaceState
{
    enum class Fog
    {
        None,
        Linear,
        Exp,
        Exp2
    };

    bool isDepthOnly = false;    ///< no colour is written: by ColorMask, or POSE_DEPTH_ONLY (see DepthPass)
    bool isAlphaNeeded = false;  ///< alphaCutoff or blending leave parts of the surface out
    bool isLit = true;           ///< GL_LIGHTING, and no uniform `unlit`
    bool hasFlatNormals = false; ///< lit, by the uniform `flatNormals`: each face by its own normal, of the pose
    bool hasSpecular = false;    ///< lit, and the osg::Material's specular is not black
    bool isTextured = true;      ///< GL_TEXTURE_2D on unit 0, and not just the white texture of applyCharacterProgram()
    bool hasTextureMatrix = false; ///< an osg::TexMat on unit 0
    bool hasClipPlanes = false;    ///< any GL_CLIP_PLANEi
    std::uint8_t lights = 1;       ///< a bit for each GL_LIGHTi that is on
    std::uint8_t pointLights = 0;  ///< of those, the ones that have a place: with attenuation, maybe spots
    std::uint8_t shadowMaps = 0;   ///< a bit for each texture unit, 1 to 7, with a depth map on generated coordinates
    bool hasShadowBias = false;    ///< osgShadow::ShadowMap's way of darkening: by its uniform osgShadow_ambientBias
    bool hasShadowSplits = false;  ///< osgShadow::ParallelSplitShadowMap's: by its uniform zShadow0
    Fog fog = Fog::None;           ///< GL_FOG, and the osg::Fog's mode

    /// As the state is now; to be asked while its attributes are applied, the modes already being so.
    static SurfaceState of(osg::State& state);

    /// GLSL: DRAW_COLOR, DRAW_ALPHA, DRAW_LIGHTING … with a number each, as the shaders take them.
    std::string defines() const;

    bool operator<(const SurfaceState& other) const { return key() < other.key(); }

private:
    std::tuple<bool, bool, bool, bool, bool, bool, bool, bool, bool, bool, unsigned, unsigned, unsigned, Fog>
    key() const
    {
        return {
            isDepthOnly,   isAlphaNeeded, isLit,           hasFlatNormals, hasSpecular, isTextured, hasTextureMatrix,
            hasClipPlanes, hasShadowBias, hasShadowSplits, lights,         pointLights, shadowMaps, fog};
    }
};

/// Whether it is whiteTexture() or, by its name, a copy of it, from a file too: shaders leave the texture out.
bool isWhiteTexture(const osg::StateAttribute* texture);
/// The name of whiteTexture(): copies and files keep it, and draw threads need no lock to compare it.
constexpr const char* whiteTextureName = "osgGpuAnimation white";

} // namespace osgGpuAnimation
