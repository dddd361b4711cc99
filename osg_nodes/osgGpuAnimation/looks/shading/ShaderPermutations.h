// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/looks/ShaderHook.h>

#include <osg/observer_ptr>
#include <osg/Program>
#include <osg/State>
#include <osg/Texture2D>

#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <tuple>

namespace osgGpuAnimation
{

/// The key of a shader permutation: the modes and attributes of OSG's state that the fixed pipeline would apply and a
/// shader must apply itself. Each combination is a separate program, because some drivers (llvmpipe) run both sides of
/// every branch.
struct ShaderKey
{
    enum class Fog
    {
        None,
        Linear,
        Exp,
        Exp2
    };

    bool isCore = false;         ///< a core profile: GL keeps no lights, materials, fog and texture matrices
    bool isDepthOnly = false;    ///< no colour is written: ColorMask or POSE_DEPTH_ONLY (see DepthPass)
    bool isAlphaNeeded = false;  ///< alphaCutoff or blending hides parts of the surface
    bool isLit = true;           ///< GL_LIGHTING, and no uniform `unlit`
    bool hasFlatNormals = false; ///< lit, and the uniform `flatNormals` is set
    bool hasSpecular = false;    ///< lit, and the osg::Material's specular is not black
    bool isTextured = true;      ///< GL_TEXTURE_2D on unit 0, and not just the white texture of applyCharacterProgram()
    bool hasTextureMatrix = false;   ///< an osg::TexMat on unit 0
    bool hasClipPlanes = false;      ///< any GL_CLIP_PLANEi
    std::uint8_t lights = 1;         ///< a bit for each enabled GL_LIGHTi
    std::uint8_t pointLights = 0;    ///< the lights with a position: attenuated, possibly spots
    std::uint8_t punctualLights = 0; ///< the point lights that are a PunctualLight: with glTF's cones and ranges
    std::uint8_t shadowMaps = 0;     ///< a bit for each texture unit, 1 to 7, with a depth map on generated coordinates
    bool hasShadowBias = false;      ///< osgShadow::ShadowMap: its uniform osgShadow_ambientBias exists
    bool hasShadowSplits = false;    ///< osgShadow::ParallelSplitShadowMap: its uniform zShadow0 exists
    bool isEncoded = true;           ///< no GL_FRAMEBUFFER_SRGB: the shader encodes linear light for the display
    Fog fog = Fog::None;             ///< GL_FOG, and the osg::Fog's mode
    /// By ShaderHook::Place; null: no hook.
    std::array<osg::Shader*, ShaderHook::placeCount> hooks{};

    /// The key of the present state. Call it while attributes are applied, after the modes.
    static ShaderKey of(osg::State& state);

    /// GLSL definitions of DRAW_COLOR, DRAW_ALPHA, DRAW_LIGHTING and so on, as numbers, and of HOOK_... for each hook.
    std::string defines() const;

    auto key() const
    {
        return std::tie(isCore, isDepthOnly, isAlphaNeeded, isLit, hasFlatNormals, hasSpecular, isTextured,
                        hasTextureMatrix, hasClipPlanes, lights, pointLights, punctualLights, shadowMaps, hasShadowBias,
                        hasShadowSplits, isEncoded, fog, hooks);
    }
    bool operator<(const ShaderKey& other) const { return key() < other.key(); }
};

/// True for whiteTexture() and, by the name, for copies of it, also from files: shaders skip such a texture.
bool isWhiteTexture(const osg::StateAttribute* texture);
/// The name of whiteTexture(). Copies and files keep it, and draw threads compare it without a lock.
constexpr const char* whiteTextureName = "osgGpuAnimation white";

/// An object that all users share. The first user creates it, and it exists as long as a scene refers to it: when a
/// context closes, OSG releases the GL objects in scenes, and an object outside them would keep stale ones.
template <typename Object>
class SharedObject
{
public:
    template <typename Make>
    osg::ref_ptr<Object> get(Make make)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        osg::ref_ptr<Object> object;
        if (_object.lock(object)) return object;
        object = make();
        _object = object.get();
        return object;
    }

private:
    std::mutex _mutex;
    osg::observer_ptr<Object> _object;
};

/// The shader define of a StateSet whose attribute of the type PROGRAM, of any class, skins: it calls skin.glsl.
constexpr const char* skinningDefine = "POSE_SKINNING_PROGRAM";

/// The attribute behind characterProgram() and surfaceProgram(): one program per ShaderKey, created on demand. It reads
/// the state whenever a StateSet with it is applied. Every permutation links the skinning shader and has the attribute
/// locations of this program. OSG's shader defines add the maps of a material, see shaders/material.glsl.
///
/// Set it PROTECTED, so that overriding programs from above (osgShadow's casting cameras, osgFX) do not draw the bind
/// pose. An overriding program that skins is applied instead, see skinningDefine.
class ShaderPermutations : public osg::Program
{
public:
    /// skin: skin.glsl; null: the program draws meshes that do not move. It is not in this program's own list of
    /// shaders: OSG compiles a program that has shaders.
    explicit ShaderPermutations(osg::Shader* skin = nullptr);
    /// Shares the shader; the copy creates its own programs.
    ShaderPermutations(const ShaderPermutations& other, const osg::CopyOp& copyop = osg::CopyOp::SHALLOW_COPY);

    /// The default that osg::State uses for this attribute type: no program.
    osg::Object* cloneType() const override { return new osg::Program; }
    osg::Object* clone(const osg::CopyOp& copyop) const override { return new ShaderPermutations(*this, copyop); }
    bool isSameKindAs(const osg::Object* object) const override
    {
        return dynamic_cast<const ShaderPermutations*>(object) != nullptr;
    }
    const char* libraryName() const override { return "osgGpuAnimation"; }
    const char* className() const override { return _skin ? "SurfaceProgram" : "StillSurfaceProgram"; }

    void apply(osg::State& state) const override;
    void compileGLObjects(osg::State& state) const override;
    void setThreadSafeRefUnref(bool threadSafe) override;
    void resizeGLObjectBuffers(unsigned int maxSize) override;
    void releaseGLObjects(osg::State* state = nullptr) const override;

    /// The program for a key.
    osg::ref_ptr<osg::Program> variant(const ShaderKey& surface) const;

protected:
    ~ShaderPermutations() override = default;

private:
    bool skins(const osg::StateAttribute* program, const osg::StateSet& stateSet) const;
    const osg::StateAttribute* overriding(osg::State& state) const;

    osg::ref_ptr<osg::Shader> _skin;
    mutable std::mutex _mutex; ///< draw threads of several contexts create variants
    mutable std::map<ShaderKey, osg::ref_ptr<osg::Program>> _variants;
};

/// One shared white texel, for meshes without a texture in programs that sample unit 0.
osg::ref_ptr<osg::Texture2D> whiteTexture();

} // namespace osgGpuAnimation
