// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Shader>
#include <osg/StateAttribute>

#include <string>

namespace osgGpuAnimation
{

/// A GLSL function of the host application that the kit's programs call, so that characters, crowds and the still
/// meshes of a file have the host's depth, fog or sky. As an attribute of a StateSet it counts for everything below; a
/// nearer hook of the same place replaces it, by OSG's rules of OVERRIDE and PROTECTED. It counts in depth and shadow
/// passes, too.
///
///     scene->getOrCreateStateSet()->setAttribute(new ShaderHook(ShaderHook::Place::FinalColor, R"(
///         in vec3 viewPosition;
///         void hostFinalColor(inout vec4 color) { color.rgb *= exp(0.01 * viewPosition.z); })"));
///
/// Hooks with the same text share one shader, and each combination of hooks compiles once.
class ShaderHook : public osg::StateAttribute
{
public:
    /// Where the function is called, and its declaration.
    enum class Place
    {
        /// void hostEyeVertex(inout vec4 vertex, inout vec3 normal): the posed vertex and its normal (of any length) in
        /// eye space.
        EyeVertex,
        /// void hostClipVertex(inout vec4 position, vec4 vertex): gl_Position, and the vertex in eye space.
        ClipVertex,
        /// void hostMaterial(inout vec4 baseColor, inout vec3 emission, inout vec3 metallicRoughnessOcclusion,
        /// inout vec3 normal): the values of osgGpuAnimationMaterial() before the lighting, see materialShader().
        /// Without lighting the base colour alone counts.
        Material,
        /// void hostLitColor(inout vec4 color): after the lighting, before tone mapping. Linear with a PbrMaterial.
        LitColor,
        /// void hostFinalColor(inout vec4 color): as displayed, after fog. Passes without colour call it, too, since it
        /// may set gl_FragDepth.
        FinalColor,
    };
    static constexpr unsigned int placeCount = 5; ///< the number of Place values

    /// No function: the kit's programs are as without a hook.
    explicit ShaderHook(Place place = Place::EyeVertex) : _place(place) {}
    /// See set().
    ShaderHook(Place place, const std::string& text) { set(place, text); }
    /// Shares the shader.
    ShaderHook(const ShaderHook& other, const osg::CopyOp& copyop = osg::CopyOp::SHALLOW_COPY);
    /// OSG applies it before any program, since VERTEXPROGRAM, whose other members nobody uses, precedes PROGRAM.
    META_StateAttribute(osgGpuAnimation, ShaderHook, VERTEXPROGRAM)

    unsigned int getMember() const override { return firstMember + static_cast<unsigned int>(_place); }
    int compare(const osg::StateAttribute& other) const override;

    /// Before a StateSet has the hook. text: GLSL that defines the place's function, with a `#version` of its own or
    /// for GLSL 1.40; empty: no function. A text without the function's name is a warning and no function. It may have
    /// uniforms, import_defines, and inputs or outputs: `viewPosition` and `viewNormal` of surfaceVertexShader(), or
    /// any that a hook of another place writes.
    void set(Place place, const std::string& text);
    Place getPlace() const { return _place; }            ///< see set()
    const std::string& getText() const { return _text; } ///< as given
    /// Null: no function.
    osg::Shader* getShader() const { return _shader.get(); }
    /// False: no hook with a text has been created yet.
    static bool exists();
    /// The hook that applies in the present state; null: no function.
    static osg::Shader* applied(const osg::State& state, Place place);

protected:
    ~ShaderHook() override = default;

private:
    static constexpr unsigned int firstMember = 64;

    Place _place = Place::EyeVertex;
    std::string _text;
    osg::ref_ptr<osg::Shader> _shader;
};

} // namespace osgGpuAnimation
