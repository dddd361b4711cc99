// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/SurfaceProgram.h>

#include <ShaderSources.h>

#include <osg/GLExtensions>
#include <osg/Material>

#include <array>
#include <string>

namespace osgGpuAnimation
{

namespace
{

osg::Shader* makeShader(osg::Shader::Type type, const SurfaceState& surface, const char* source)
{
    return new osg::Shader(type, "#version 140\n" + surface.defines() + source);
}

void setShadowUnits(osg::State& state)
{
    static const unsigned int mapsName = osg::Uniform::getNameID("shadowMaps");
    static constexpr std::array<GLint, 7> units{1, 2, 3, 4, 5, 6, 7};
    const osg::Program::PerContextProgram* applied = state.getLastAppliedProgramObject();
    if (!applied) return;
    state.get<osg::GLExtensions>()->glUniform1iv(applied->getUniformLocation(mapsName),
                                                 static_cast<GLsizei>(units.size()), units.data());
}

bool givesWayToColors(const osg::Material& material)
{
    return material.getColorMode() == osg::Material::DIFFUSE ||
           material.getColorMode() == osg::Material::AMBIENT_AND_DIFFUSE;
}

/// What shaders of the compatibility profile cannot rely on, and those of the core profile do not have.
void setMaterial(osg::State& state)
{
    static const unsigned int diffuseName = osg::Uniform::getNameID("materialDiffuse");
    static const unsigned int emissionName = osg::Uniform::getNameID("materialEmission");
    const osg::Program::PerContextProgram* applied = state.getLastAppliedProgramObject();
    if (!applied) return;
    const auto* material =
        dynamic_cast<const osg::Material*>(state.getLastAppliedAttribute(osg::StateAttribute::MATERIAL));
    const bool isOwn = material && !givesWayToColors(*material);
    const osg::Vec4 diffuse = isOwn ? material->getDiffuse(osg::Material::FRONT) : osg::Vec4(1, 1, 1, 1);
    const osg::Vec4 emission = material ? material->getEmission(osg::Material::FRONT) : osg::Vec4(0, 0, 0, 1);
    const osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    gl.glUniform4fv(applied->getUniformLocation(diffuseName), 1, diffuse.ptr());
    gl.glUniform4fv(applied->getUniformLocation(emissionName), 1, emission.ptr());
}

osg::ref_ptr<osg::Texture2D> makeWhiteTexture()
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(1, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    image->setColor(osg::Vec4(1, 1, 1, 1), 0, 0);
    osg::ref_ptr<osg::Texture2D> white = new osg::Texture2D(image);
    white->setName(whiteTextureName);
    // OSG's default, GL_CLAMP, mixes in the black border.
    white->setWrap(osg::Texture::WRAP_S, osg::Texture::REPEAT);
    white->setWrap(osg::Texture::WRAP_T, osg::Texture::REPEAT);
    return white;
}

} // namespace

osg::ref_ptr<osg::Texture2D> whiteTexture()
{
    static SharedObject<osg::Texture2D> shared;
    return shared.get(makeWhiteTexture);
}

SurfaceProgram::SurfaceProgram(const SurfaceProgram& other, const osg::CopyOp& copyop) : osg::Program(other, copyop) {}

osg::ref_ptr<osg::Program> SurfaceProgram::variant(const SurfaceState& surface) const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    osg::ref_ptr<osg::Program>& program = _variants[surface];
    if (program) return program;
    program = new osg::Program;
    program->setName("osgGpuAnimation character");
    for (unsigned int i = 0; i < getNumShaders(); ++i)
        program->addShader(const_cast<osg::Shader*>(getShader(i)));
    for (const auto& [name, location] : getAttribBindingList())
        program->addBindAttribLocation(name, location);
    program->addShader(makeShader(osg::Shader::VERTEX, surface, shaders::character_vert));
    program->addShader(makeShader(osg::Shader::FRAGMENT, surface, shaders::character_frag));
    return program;
}

bool SurfaceProgram::sharesSkin(const osg::Program& other) const
{
    for (unsigned int i = 0; i < other.getNumShaders(); ++i)
        if (other.getShader(i) == getShader(0)) return true;
    return false;
}

/// The outermost program above that overrides and can skin; null: there is none.
const osg::Program* SurfaceProgram::overriding(osg::State& state) const
{
    for (const auto& [attribute, value] : state.getAttributeVec(this))
    {
        const auto* other = dynamic_cast<const osg::Program*>(attribute);
        if ((value & osg::StateAttribute::OVERRIDE) && other && other != this && sharesSkin(*other)) return other;
    }
    return nullptr;
}

void SurfaceProgram::apply(osg::State& state) const
{
    if (const osg::Program* other = overriding(state))
        other->apply(state);
    else
    {
        const SurfaceState surface = SurfaceState::of(state);
        variant(surface)->apply(state);
        if (surface.shadowMaps != 0) setShadowUnits(state);
        setMaterial(state);
    }
    // The next StateSet may have other modes and the same program, which OSG would take for applied.
    state.haveAppliedAttribute(osg::StateAttribute::PROGRAM);
}

void SurfaceProgram::compileGLObjects(osg::State& state) const
{
    variant(SurfaceState())->compileGLObjects(state);
}

void SurfaceProgram::setThreadSafeRefUnref(bool threadSafe)
{
    osg::Program::setThreadSafeRefUnref(threadSafe);
    const std::lock_guard<std::mutex> lock(_mutex);
    for (const auto& [surface, program] : _variants)
        program->setThreadSafeRefUnref(threadSafe);
}

void SurfaceProgram::resizeGLObjectBuffers(unsigned int maxSize)
{
    osg::Program::resizeGLObjectBuffers(maxSize);
    const std::lock_guard<std::mutex> lock(_mutex);
    for (const auto& [surface, program] : _variants)
        program->resizeGLObjectBuffers(maxSize);
}

void SurfaceProgram::releaseGLObjects(osg::State* state) const
{
    osg::Program::releaseGLObjects(state);
    const std::lock_guard<std::mutex> lock(_mutex);
    for (const auto& [surface, program] : _variants)
        program->releaseGLObjects(state);
}

} // namespace osgGpuAnimation
