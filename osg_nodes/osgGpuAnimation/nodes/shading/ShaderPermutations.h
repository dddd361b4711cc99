// SPDX-License-Identifier: MIT
#pragma once

#include <osg/observer_ptr>
#include <osg/Program>
#include <osg/State>
#include <osg/Texture2D>

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <tuple>

namespace osgGpuAnimation
{

/// What the character's shaders are compiled for: of OSG's modes and attributes above and at a mesh, those that the
/// fixed pipeline would act on and a shader has to act on itself. Each combination is a program of its own, since some
/// drivers (llvmpipe) run both sides of every branch.
struct ShaderKey
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
    static ShaderKey of(osg::State& state);

    /// GLSL: DRAW_COLOR, DRAW_ALPHA, DRAW_LIGHTING … with a number each, as the shaders take them.
    std::string defines() const;

    bool operator<(const ShaderKey& other) const { return key() < other.key(); }

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

/// An object that all users share, made by the first. It lives as long as some scene has it: OSG releases the GL
/// objects of what is in scenes when a context is closed, and an object that outlives them would keep stale ones.
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

/// The attribute behind characterProgram(): a program for each ShaderKey there is, made when it is first met. It
/// reads the state each time that a StateSet with it is applied. Every permutation links the skinning shader and has the
/// attribute locations of this program.
///
/// It is meant to be set PROTECTED, so that programs that override from above (osgShadow's casting cameras, osgFX)
/// do not draw the bind pose. One that overrides and links skin.glsl itself is given way to.
class ShaderPermutations : public osg::Program
{
public:
    /// skin: skin.glsl. It is no shader of this program itself: OSG would compile a program that has shaders.
    explicit ShaderPermutations(osg::Shader* skin = nullptr) : _skin(skin) {}
    /// Shares the shader; programs are made anew.
    ShaderPermutations(const ShaderPermutations& other, const osg::CopyOp& copyop = osg::CopyOp::SHALLOW_COPY);

    /// osg::State's default for the type of attribute: no program.
    osg::Object* cloneType() const override { return new osg::Program; }
    osg::Object* clone(const osg::CopyOp& copyop) const override { return new ShaderPermutations(*this, copyop); }
    bool isSameKindAs(const osg::Object* object) const override
    {
        return dynamic_cast<const ShaderPermutations*>(object) != nullptr;
    }
    const char* libraryName() const override { return "osgGpuAnimation"; }
    const char* className() const override { return "SurfaceProgram"; }

    void apply(osg::State& state) const override;
    void compileGLObjects(osg::State& state) const override;
    void setThreadSafeRefUnref(bool threadSafe) override;
    void resizeGLObjectBuffers(unsigned int maxSize) override;
    void releaseGLObjects(osg::State* state = nullptr) const override;

    /// The program for such a state.
    osg::ref_ptr<osg::Program> variant(const ShaderKey& surface) const;

protected:
    ~ShaderPermutations() override = default;

private:
    bool sharesSkin(const osg::Program& other) const;
    const osg::Program* overriding(osg::State& state) const;

    osg::ref_ptr<osg::Shader> _skin;
    mutable std::mutex _mutex; ///< draw threads of several contexts make variants
    mutable std::map<ShaderKey, osg::ref_ptr<osg::Program>> _variants;
};

/// One white texel, shared by all: for meshes without a texture where another program samples unit 0.
osg::ref_ptr<osg::Texture2D> whiteTexture();

} // namespace osgGpuAnimation
