// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/looks/shading/ShaderPermutations.h>

#include <osgGpuAnimation/gpu/detail/FixedPipeline.h>
#include <osgGpuAnimation/looks/PbrMaterial.h>
#include <osgGpuAnimation/looks/shading/HookPlaces.h>
#include <osgGpuAnimation/looks/shading/PunctualLight.h>
#include <osgGpuAnimation/looks/shading/ViewLights.h>
#include <osgGpuAnimation/scene/traversal/CullScopes.h>

#include <osg/ClipPlane>
#include <osg/ColorMask>
#include <osg/Fog>
#include <osg/GLExtensions>
#include <osg/Light>
#include <osg/Material>
#include <osg/TexGen>
#include <osg/Texture>
#include <ShaderSources.h>

#include <algorithm>
#include <initializer_list>

namespace osgGpuAnimation
{

namespace
{

constexpr unsigned int generatedUnits = 8; ///< texture units with coordinate generation in OpenGL 2

/// The value of a mode in the stack of state sets. In the core profile OSG does not switch the fixed pipeline's modes,
/// but users still set them.
template <typename ModeOf>
bool isSetOn(osg::State& state, ModeOf modeOf)
{
    osg::StateAttribute::GLModeValue value = osg::StateAttribute::OFF;
    for (const osg::StateSet* stateSet : state.getStateSetStack())
    {
        const osg::StateAttribute::GLModeValue here =
            stateSet ? modeOf(*stateSet) : osg::StateAttribute::GLModeValue(osg::StateAttribute::INHERIT);
        if (here & osg::StateAttribute::INHERIT) continue;
        if ((value & osg::StateAttribute::OVERRIDE) && !(here & osg::StateAttribute::PROTECTED)) continue;
        value = here;
    }
    return (value & osg::StateAttribute::ON) != 0;
}

bool isModeOn(osg::State& state, osg::StateAttribute::GLMode mode)
{
    if (!state.getUseModelViewAndProjectionUniforms()) return state.getLastAppliedMode(mode);
    return isSetOn(state, [mode](const osg::StateSet& stateSet) { return stateSet.getMode(mode); });
}

bool isTexturingOn(osg::State& state)
{
    if (isWhiteTexture(state.getLastAppliedTextureAttribute(0, osg::StateAttribute::TEXTURE))) return false;
    if (!state.getUseModelViewAndProjectionUniforms()) return state.getLastAppliedTextureMode(0, GL_TEXTURE_2D);
    return isSetOn(state,
                   [](const osg::StateSet& stateSet)
                   {
                       osg::StateAttribute::GLModeValue mode = stateSet.getTextureMode(0, GL_TEXTURE_2D);
                       // To an OSG without the fixed pipeline a texture has no mode.
                       if (!hasFixedPipeline && mode == osg::StateAttribute::INHERIT &&
                           stateSet.getTextureAttribute(0, osg::StateAttribute::TEXTURE))
                           mode = osg::StateAttribute::ON;
                       return mode;
                   });
}

bool isColorMasked(const osg::State& state)
{
    const auto* mask = applied<osg::ColorMask>(state, osg::StateAttribute::COLORMASK);
    return mask && !mask->getRedMask() && !mask->getGreenMask() && !mask->getBlueMask() && !mask->getAlphaMask();
}

/// True if blending or an alpha cutoff is set near the program in the stack of state sets.
bool leavesPartsOut(osg::State& state)
{
    const osg::State::StateSetStack& way = state.getStateSetStack();
    for (auto stateSet = way.rbegin(); stateSet != way.rend(); ++stateSet)
    {
        if (!*stateSet) continue;
        float cutoff = 0.0f;
        const osg::Uniform* uniform = (*stateSet)->getUniform("alphaCutoff");
        if ((*stateSet)->getMode(GL_BLEND) & osg::StateAttribute::ON) return true;
        if (uniform && uniform->get(cutoff)) return cutoff > 0.0f;
    }
    return false;
}

/// The uniform that the program will use, from the state set being applied or those above; null: none.
const osg::Uniform* uniformOf(osg::State& state, const std::string& name)
{
    const auto known = state.getUniformMap().find(name);
    const bool hasAbove = known != state.getUniformMap().end() && !known->second.uniformVec.empty();
    const osg::State::StateSetStack& way = state.getStateSetStack();
    const osg::StateSet::RefUniformPair* own = way.empty() || !way.back() ? nullptr : way.back()->getUniformPair(name);
    if (!hasAbove) return own ? own->first.get() : nullptr;
    const auto& [above, value] = known->second.uniformVec.back();
    const bool isOverridden =
        (value & osg::StateAttribute::OVERRIDE) && !(own && (own->second & osg::StateAttribute::PROTECTED));
    return own && !isOverridden ? own->first.get() : above;
}

bool isOn(osg::State& state, const std::string& name)
{
    const osg::Uniform* uniform = uniformOf(state, name);
    if (!uniform) return false;
    const auto isSet = [](const auto* numbers) { return numbers && !numbers->empty() && numbers->front() != 0; };
    return isSet(uniform->getIntArray()) || isSet(uniform->getUIntArray()) || isSet(uniform->getFloatArray());
}

bool isShiny(const osg::State& state)
{
    const auto* material = applied<osg::Material>(state, osg::StateAttribute::MATERIAL);
    if (!material) return false; // OpenGL's default specular colour is black
    const osg::Vec4& specular = material->getSpecular(osg::Material::FRONT);
    return material->getColorMode() == osg::Material::SPECULAR || specular.x() != 0.0f || specular.y() != 0.0f ||
           specular.z() != 0.0f;
}

/// By number; null: none.
std::array<const osg::Light*, ViewLights::lightCount> lightsOf(const osg::State& state, bool isCore)
{
    std::array<const osg::Light*, ViewLights::lightCount> lights{};
    const auto placed = isCore ? ViewLights::of(state) : std::array<ViewLights::Placed, ViewLights::lightCount>();
    for (unsigned int index = 0; index < ViewLights::lightCount; ++index)
        lights[index] = isCore ? placed[index].light : applied<osg::Light>(state, osg::StateAttribute::LIGHT, index);
    return lights;
}

bool isShadowMap(const osg::State& state, unsigned int unit)
{
    if (!state.getLastAppliedTextureMode(unit, GL_TEXTURE_GEN_S)) return false;
    if (!state.getLastAppliedTextureMode(unit, GL_TEXTURE_2D)) return false;
    const auto* texture =
        dynamic_cast<const osg::Texture*>(state.getLastAppliedTextureAttribute(unit, osg::StateAttribute::TEXTURE));
    return texture && texture->getShadowComparison() && texture->getTextureTarget() == GL_TEXTURE_2D;
}

bool hasUniform(const osg::State& state, const char* name)
{
    const auto known = state.getUniformMap().find(name);
    return known != state.getUniformMap().end() && !known->second.uniformVec.empty();
}

ShaderKey::Fog fogOf(osg::State& state)
{
    const auto* fog = applied<osg::Fog>(state, osg::StateAttribute::FOG);
    if (!fog || !isModeOn(state, GL_FOG)) return ShaderKey::Fog::None;
    if (fog->getMode() == osg::Fog::LINEAR) return ShaderKey::Fog::Linear;
    return fog->getMode() == osg::Fog::EXP ? ShaderKey::Fog::Exp : ShaderKey::Fog::Exp2;
}

void readLights(osg::State& state, ShaderKey& surface)
{
    const auto lights = lightsOf(state, surface.isCore);
    for (unsigned int index = 0; index < lights.size(); ++index)
    {
        const osg::Light* light = lights[index];
        if ((surface.isCore && !light) || !isModeOn(state, GL_LIGHT0 + index)) continue;
        const auto bit = static_cast<std::uint8_t>(1u << index);
        surface.lights |= bit;
        if (!light || light->getPosition().w() == 0.0f) continue;
        surface.pointLights |= bit;
        if (dynamic_cast<const PunctualLight*>(light)) surface.punctualLights |= bit;
    }
    if (surface.isCore) return; // which lacks the generated coordinates of osgShadow's maps
    for (unsigned int unit = 1; unit < generatedUnits; ++unit)
        if (isShadowMap(state, unit)) surface.shadowMaps |= static_cast<std::uint8_t>(1u << unit);
    surface.hasShadowBias = surface.shadowMaps != 0 && hasUniform(state, "osgShadow_ambientBias");
    surface.hasShadowSplits = surface.shadowMaps != 0 && hasUniform(state, "zShadow0");
}

/// The hooks that the pass calls.
void readHooks(const osg::State& state, ShaderKey& surface)
{
    if (!ShaderHook::exists()) return;
    using Place = ShaderHook::Place;
    for (unsigned int number = 0; number < ShaderHook::placeCount; ++number)
    {
        const auto place = static_cast<Place>(number);
        if (place == Place::Material && surface.isDepthOnly && !surface.isAlphaNeeded) continue;
        if (place == Place::LitColor && surface.isDepthOnly) continue;
        surface.hooks[number] = ShaderHook::applied(state, place);
    }
}

osg::Shader* makeShader(osg::Shader::Type type, const std::string& defines, std::initializer_list<const char*> sources)
{
    std::string text = shaders::version_glsl + defines;
    for (const char* source : sources)
        text += source;
    return new osg::Shader(type, text);
}

void setShadowUnits(osg::State& state)
{
    static const unsigned int mapsName = osg::Uniform::getNameID("shadowMaps");
    static constexpr std::array<GLint, 7> units{1, 2, 3, 4, 5, 6, 7};
    const osg::Program::PerContextProgram* program = state.getLastAppliedProgramObject();
    if (!program) return;
    state.get<osg::GLExtensions>()->glUniform1iv(program->getUniformLocation(mapsName),
                                                 static_cast<GLsizei>(units.size()), units.data());
}

void setPunctualLights(osg::State& state, const ShaderKey& surface)
{
    static const unsigned int name = osg::Uniform::getNameID("punctualLights");
    const osg::Program::PerContextProgram* program = state.getLastAppliedProgramObject();
    if (!program) return;
    std::array<osg::Vec4, ViewLights::lightCount> numbers;
    const auto known = lightsOf(state, surface.isCore);
    for (unsigned int index = 0; index < known.size(); ++index)
        if (const auto* light = dynamic_cast<const PunctualLight*>(known[index]);
            light && (surface.punctualLights & (1u << index)))
            numbers[index] = light->coneAndRange();
    state.get<osg::GLExtensions>()->glUniform4fv(program->getUniformLocation(name),
                                                 static_cast<GLsizei>(numbers.size()), numbers[0].ptr());
}

bool givesWayToColors(const osg::Material& material)
{
    return material.getColorMode() == osg::Material::DIFFUSE ||
           material.getColorMode() == osg::Material::AMBIENT_AND_DIFFUSE;
}

/// gl_FrontMaterial is unreliable in the compatibility profile and missing in the core profile.
void setMaterial(osg::State& state)
{
    static const unsigned int diffuseName = osg::Uniform::getNameID("materialDiffuse");
    static const unsigned int emissionName = osg::Uniform::getNameID("materialEmission");
    const osg::Program::PerContextProgram* program = state.getLastAppliedProgramObject();
    if (!program) return;
    const auto* material = applied<osg::Material>(state, osg::StateAttribute::MATERIAL);
    const bool isOwn = material && !givesWayToColors(*material);
    osg::Vec4 diffuse = isOwn ? material->getDiffuse(osg::Material::FRONT) : osg::Vec4(1, 1, 1, 1);
    osg::Vec4 emission = material ? material->getEmission(osg::Material::FRONT) : osg::Vec4(0, 0, 0, 1);
    if (isDefined(state, "MATERIAL_PBR"))
    {
        diffuse = linearColor(diffuse);
        emission = linearColor(emission);
    }
    const osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    gl.glUniform4fv(program->getUniformLocation(diffuseName), 1, diffuse.ptr());
    gl.glUniform3fv(program->getUniformLocation(emissionName), 1, emission.ptr());
}

} // namespace

ShaderKey ShaderKey::of(osg::State& state)
{
    ShaderKey surface;
    surface.isCore = isCoreProfile(state);
    surface.lights = 0;
    surface.isDepthOnly = isDefined(state, "POSE_DEPTH_ONLY") || isColorMasked(state);
    surface.isAlphaNeeded = surface.isDepthOnly && leavesPartsOut(state);
    surface.isLit = !surface.isDepthOnly && isModeOn(state, GL_LIGHTING) && !isOn(state, "unlit");
    surface.hasFlatNormals = surface.isLit && isOn(state, "flatNormals");
    surface.hasSpecular = surface.isLit && isShiny(state);
    surface.isTextured = (!surface.isDepthOnly || surface.isAlphaNeeded) && isTexturingOn(state);
    surface.hasTextureMatrix = surface.isTextured && !surface.isCore &&
                               state.getLastAppliedTextureAttribute(0, osg::StateAttribute::TEXMAT) != nullptr;
    for (unsigned int plane = 0; plane < 6 && !surface.isCore; ++plane)
        surface.hasClipPlanes = surface.hasClipPlanes || state.getLastAppliedMode(GL_CLIP_PLANE0 + plane);
    if (surface.isLit) readLights(state, surface);
    if (!surface.isDepthOnly) surface.fog = fogOf(state);
    surface.isEncoded = !state.getLastAppliedMode(GL_FRAMEBUFFER_SRGB);
    readHooks(state, surface);
    return surface;
}

std::string ShaderKey::defines() const
{
    const auto line = [](const char* name, unsigned int value)
    { return std::string("#define ") + name + " " + std::to_string(value) + "\n"; };
    std::string ofHooks;
    for (std::size_t place = 0; place < hooks.size(); ++place)
        if (hooks[place]) ofHooks += hookPlaces[place].defines;
    return line("DRAW_FIXED_PIPELINE", !isCore) + line("DRAW_COLOR", !isDepthOnly) + line("DRAW_ALPHA", isAlphaNeeded) +
           line("DRAW_LIGHTING", isLit) + line("DRAW_FLAT_NORMALS", hasFlatNormals) +
           line("DRAW_SPECULAR", hasSpecular) + line("DRAW_TEXTURE", isTextured) +
           line("DRAW_TEXTURE_MATRIX", hasTextureMatrix) + line("DRAW_CLIP_PLANES", hasClipPlanes) +
           line("DRAW_LIGHTS", lights) + line("DRAW_POINT_LIGHTS", pointLights) +
           line("DRAW_PUNCTUAL_LIGHTS", punctualLights) + line("DRAW_SHADOW_MAPS", shadowMaps) +
           line("DRAW_SHADOW_BIAS", hasShadowBias) + line("DRAW_SHADOW_SPLITS", hasShadowSplits) +
           line("DRAW_ENCODED", isEncoded) + line("DRAW_FOG", static_cast<unsigned int>(fog)) + ofHooks;
}

bool isWhiteTexture(const osg::StateAttribute* texture)
{
    return texture && texture->getName() == whiteTextureName;
}

osg::ref_ptr<osg::Texture2D> whiteTexture()
{
    static SharedObject<osg::Texture2D> shared;
    const auto make = []
    {
        osg::ref_ptr<osg::Image> image = new osg::Image;
        image->allocateImage(1, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE);
        image->setColor(osg::Vec4(1, 1, 1, 1), 0, 0);
        osg::ref_ptr<osg::Texture2D> white = new osg::Texture2D(image);
        white->setName(whiteTextureName);
        // OSG's default, GL_CLAMP, blends with the black border.
        white->setWrap(osg::Texture::WRAP_S, osg::Texture::REPEAT);
        white->setWrap(osg::Texture::WRAP_T, osg::Texture::REPEAT);
        return white;
    };
    return shared.get(make);
}

ShaderPermutations::ShaderPermutations(osg::Shader* skin) : _skin(skin)
{
    if (hasFixedPipeline) return;
    // Such an OSG makes the program itself current in a compile traversal, even if it has no shaders.
    addShader(new osg::Shader(osg::Shader::VERTEX, "#version 140\nvoid main() { gl_Position = vec4(0.0); }\n"));
    addShader(new osg::Shader(osg::Shader::FRAGMENT, "#version 140\nvoid main() {}\n"));
}

ShaderPermutations::ShaderPermutations(const ShaderPermutations& other, const osg::CopyOp& copyop)
    : osg::Program(other, copyop), _skin(other._skin)
{
}

osg::ref_ptr<osg::Program> ShaderPermutations::variant(const ShaderKey& surface) const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    osg::ref_ptr<osg::Program>& program = _variants[surface];
    if (program) return program;
    program = new osg::Program;
    program->setName("osgGpuAnimation character");
    if (_skin) program->addShader(_skin);
    for (const auto& [name, location] : getAttribBindingList())
        program->addBindAttribLocation(name, location);
    const std::string defines = surface.defines() + "#define DRAW_SKINNED " + (_skin ? "1\n" : "0\n");
    program->addShader(makeShader(osg::Shader::VERTEX, defines, {shaders::color_glsl, shaders::character_vert}));
    program->addShader(makeShader(osg::Shader::FRAGMENT, defines,
                                  {shaders::color_glsl, shaders::material_glsl, shaders::pbr_glsl,
                                   shaders::environment_glsl, shaders::light_glsl, shaders::character_frag}));
    for (osg::Shader* hook : surface.hooks)
        if (hook) program->addShader(hook);
    return program;
}

bool ShaderPermutations::skins(const osg::StateAttribute* program, const osg::StateSet& stateSet) const
{
    const auto* known = dynamic_cast<const osg::Program*>(program);
    for (unsigned int i = 0; known && i < known->getNumShaders(); ++i)
        if (known->getShader(i) == _skin) return true;
    const auto found = stateSet.getDefineList().find(skinningDefine);
    return found != stateSet.getDefineList().end() && (found->second.second & osg::StateAttribute::ON);
}

/// The program from above that replaces this one, or null: OSG's rule of OVERRIDE and PROTECTED among those that skin.
const osg::StateAttribute* ShaderPermutations::overriding(osg::State& state) const
{
    const osg::State::AttributeVec& above = state.getAttributeVec(this);
    const auto overrides = [](const auto& each) { return (each.second & osg::StateAttribute::OVERRIDE) != 0; };
    if (std::none_of(above.begin(), above.end(), overrides)) return nullptr;
    const osg::StateSet::RefAttributePair* winner = nullptr;
    for (const osg::StateSet* stateSet : state.getStateSetStack())
    {
        const osg::StateSet::RefAttributePair* each =
            stateSet ? stateSet->getAttributePair(osg::StateAttribute::PROGRAM) : nullptr;
        if (!each || each->first == this || !skins(each->first, *stateSet)) continue;
        if (winner && overrides(*winner) && !(each->second & osg::StateAttribute::PROTECTED)) continue;
        winner = each;
    }
    return winner && overrides(*winner) ? winner->first.get() : nullptr;
}

void ShaderPermutations::apply(osg::State& state) const
{
    if (const osg::StateAttribute* other = overriding(state))
        other->apply(state);
    else
    {
        const ShaderKey surface = ShaderKey::of(state);
        variant(surface)->apply(state);
        if (surface.shadowMaps != 0) setShadowUnits(state);
        if (surface.punctualLights != 0) setPunctualLights(state, surface);
        setMaterial(state);
        if (!surface.isDepthOnly && surface.isCore) setFixedPipelineUniforms(state, surface.lights);
    }
    // The next StateSet may have other modes with the same program, which OSG would consider applied.
    state.haveAppliedAttribute(osg::StateAttribute::PROGRAM);
}

// A compile traversal applies no defines, and every mesh that moves has some: prepareFirstDraw() compiles its programs.
void ShaderPermutations::compileGLObjects(osg::State& state) const
{
    if (!hasFixedPipeline) osg::Program::compileGLObjects(state);
    if (_skin) return;
    ShaderKey surface;
    surface.isCore = isCoreProfile(state);
    variant(surface)->compileGLObjects(state);
}

void ShaderPermutations::setThreadSafeRefUnref(bool threadSafe)
{
    osg::Program::setThreadSafeRefUnref(threadSafe);
    const std::lock_guard<std::mutex> lock(_mutex);
    for (const auto& [surface, program] : _variants)
        program->setThreadSafeRefUnref(threadSafe);
}

void ShaderPermutations::resizeGLObjectBuffers(unsigned int maxSize)
{
    osg::Program::resizeGLObjectBuffers(maxSize);
    const std::lock_guard<std::mutex> lock(_mutex);
    for (const auto& [surface, program] : _variants)
        program->resizeGLObjectBuffers(maxSize);
}

void ShaderPermutations::releaseGLObjects(osg::State* state) const
{
    osg::Program::releaseGLObjects(state);
    const std::lock_guard<std::mutex> lock(_mutex);
    for (const auto& [surface, program] : _variants)
        program->releaseGLObjects(state);
}

} // namespace osgGpuAnimation
