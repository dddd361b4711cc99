// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/looks/shading/ViewLights.h>

#include <osgGpuAnimation/gpu/detail/FixedPipeline.h>

#include <osg/Fog>
#include <osg/GLExtensions>
#include <osg/GraphicsContext>
#include <osg/LightModel>
#include <osg/Material>
#include <osg/observer_ptr>

#include <cmath>
#include <optional>
#include <string>

namespace osgGpuAnimation
{

namespace
{

using LightList = std::array<ViewLights::Placed, ViewLights::lightCount>;

void addLights(osgUtil::PositionalStateContainer& container, const osg::Matrixd& after, LightList& lights)
{
    for (const auto& [attribute, matrix] : container.getAttrMatrixList())
    {
        const auto* light = dynamic_cast<const osg::Light*>(attribute.get());
        if (!light || light->getLightNum() < 0 || light->getLightNum() >= static_cast<int>(ViewLights::lightCount))
            continue;
        lights[static_cast<std::size_t>(light->getLightNum())] = {light,
                                                                  matrix ? osg::Matrixd(*matrix) * after : after};
    }
}

/// A uniform's number in osg::Program's list of locations.
unsigned int nameId(const std::string& name)
{
    return osg::Uniform::getNameID(name);
}

struct LightNames
{
    explicit LightNames(std::size_t number) : light("coreLights[" + std::to_string(number) + "].") {}

    std::string light;
    unsigned int ambient = nameId(light + "ambient");
    unsigned int diffuse = nameId(light + "diffuse");
    unsigned int specular = nameId(light + "specular");
    unsigned int position = nameId(light + "position");
    unsigned int spotDirection = nameId(light + "spotDirection");
    unsigned int spotExponent = nameId(light + "spotExponent");
    unsigned int spotCutoff = nameId(light + "spotCutoff");
    unsigned int spotCosCutoff = nameId(light + "spotCosCutoff");
    unsigned int constantAttenuation = nameId(light + "constantAttenuation");
    unsigned int linearAttenuation = nameId(light + "linearAttenuation");
    unsigned int quadraticAttenuation = nameId(light + "quadraticAttenuation");
};

/// Sets uniforms of the applied program.
class Uniforms
{
public:
    explicit Uniforms(osg::State& state)
        : _program(state.getLastAppliedProgramObject()), _gl(*state.get<osg::GLExtensions>())
    {
    }
    void set(unsigned int name, const osg::Vec4& value) const
    {
        if (const GLint location = find(name); location >= 0) _gl.glUniform4fv(location, 1, value.ptr());
    }
    void set(unsigned int name, const osg::Vec3& value) const
    {
        if (const GLint location = find(name); location >= 0) _gl.glUniform3fv(location, 1, value.ptr());
    }
    void set(unsigned int name, float value) const
    {
        if (const GLint location = find(name); location >= 0) _gl.glUniform1f(location, value);
    }

private:
    GLint find(unsigned int name) const { return _program ? _program->getUniformLocation(name) : -1; }

    const osg::Program::PerContextProgram* _program;
    const osg::GLExtensions& _gl;
};

void setLight(const Uniforms& uniforms, const LightNames& names, const ViewLights::Placed& placed)
{
    const osg::Light& light = *placed.light;
    uniforms.set(names.ambient, light.getAmbient());
    uniforms.set(names.diffuse, light.getDiffuse());
    uniforms.set(names.specular, light.getSpecular());
    uniforms.set(names.position, osg::Vec4(osg::Vec4d(light.getPosition()) * placed.toEye));
    uniforms.set(names.spotDirection,
                 osg::Vec3(osg::Matrixd::transform3x3(osg::Vec3d(light.getDirection()), placed.toEye)));
    uniforms.set(names.spotExponent, light.getSpotExponent());
    uniforms.set(names.spotCutoff, light.getSpotCutoff());
    uniforms.set(names.spotCosCutoff, static_cast<float>(std::cos(osg::DegreesToRadians(light.getSpotCutoff()))));
    uniforms.set(names.constantAttenuation, light.getConstantAttenuation());
    uniforms.set(names.linearAttenuation, light.getLinearAttenuation());
    uniforms.set(names.quadraticAttenuation, light.getQuadraticAttenuation());
}

/// Of a render stage, kept in its list of lights.
struct StageState : public osg::StateSet
{
    explicit StageState(osgUtil::RenderStage& ofStage) : stage(&ofStage) { setAttribute(new ViewLights(ofStage)); }
    osgUtil::RenderStage* stage;
};

} // namespace

int ViewLights::compare(const osg::StateAttribute& other) const
{
    COMPARE_StateAttribute_Types(ViewLights, other);
    COMPARE_StateAttribute_Parameter(_stage);
    return 0;
}

std::array<ViewLights::Placed, ViewLights::lightCount> ViewLights::of(const osg::State& state)
{
    std::array<Placed, lightCount> lights;
    const auto* view = static_cast<const ViewLights*>(state.getLastAppliedAttribute(VERTEXPROGRAM, member));
    if (!view || !view->_stage) return lights;
    osgUtil::RenderStage& stage = *view->_stage;
    if (auto* inherited = stage.getInheritedPositionalStateContainer())
        addLights(*inherited, stage.getInheritedPositionalStateContainerMatrix(), lights);
    addLights(*stage.getPositionalStateContainer(), osg::Matrixd(), lights);
    return lights;
}

ViewLightsScope::ViewLightsScope(osgUtil::CullVisitor& visitor)
    : _visitor(visitor.getState() && visitor.getState()->getUseModelViewAndProjectionUniforms() ? &visitor : nullptr)
{
    if (!_visitor) return;
    osgUtil::RenderStage& stage = *visitor.getCurrentRenderStage();
    // One state for all that the stage draws in its life.
    osgUtil::PositionalStateContainer& container = *stage.getPositionalStateContainer();
    auto* known = dynamic_cast<StageState*>(container.getUserData());
    osg::ref_ptr<StageState> state = known && known->stage == &stage ? known : new StageState(stage);
    container.setUserData(state);
    visitor.pushStateSet(state);
}

ViewLightsScope::~ViewLightsScope()
{
    if (_visitor) _visitor->popStateSet();
}

void ViewLightsCallback::operator()(osg::Node* node, osg::NodeVisitor* visitor)
{
    std::optional<ViewLightsScope> scope;
    if (osgUtil::CullVisitor* cull = visitor->asCullVisitor()) scope.emplace(*cull);
    traverse(node, visitor);
}

bool isCoreProfile(const osg::State& state)
{
    if (!hasFixedPipeline) return true;
    if (!state.getUseModelViewAndProjectionUniforms()) return false;
    // OSG keeps what it knows of a context by its number, which the next context may have, too.
    thread_local osg::observer_ptr<const osg::GraphicsContext> known;
    thread_local bool isKnownCore = false;
    const osg::GraphicsContext* context = state.getGraphicsContext();
    if (context && known.get() == context) return isKnownCore;
    constexpr GLenum profileMask = 0x9126; // GL_CONTEXT_PROFILE_MASK
    GLint profile = 0;
    if (state.get<osg::GLExtensions>()->glVersion >= 3.2f) glGetIntegerv(profileMask, &profile);
    isKnownCore = (profile & 1) != 0;
    known = context;
    return isKnownCore;
}

void setFixedPipelineUniforms(osg::State& state, unsigned int lights)
{
    static const unsigned int ambient = nameId("coreAmbient"), shine = nameId("coreShine"),
                              fogColor = nameId("coreFogColor"), fogRange = nameId("coreFogRange");
    static const LightNames names[ViewLights::lightCount] = {LightNames(0), LightNames(1), LightNames(2),
                                                             LightNames(3), LightNames(4), LightNames(5),
                                                             LightNames(6), LightNames(7)};
    const Uniforms uniforms(state);
    const LightList placed = lights != 0 ? ViewLights::of(state) : LightList();
    for (std::size_t i = 0; i < placed.size(); ++i)
        if ((lights & (1u << i)) != 0 && placed[i].light) setLight(uniforms, names[i], placed[i]);
    const auto* model = applied<osg::LightModel>(state, osg::StateAttribute::LIGHTMODEL);
    uniforms.set(ambient, model ? model->getAmbientIntensity() : osg::Vec4(0.2f, 0.2f, 0.2f, 1.0f));
    const auto* material = applied<osg::Material>(state, osg::StateAttribute::MATERIAL);
    osg::Vec4 specular = material ? material->getSpecular(osg::Material::FRONT) : osg::Vec4();
    specular.w() = material ? material->getShininess(osg::Material::FRONT) : 0.0f;
    uniforms.set(shine, specular);
    const auto* fog = applied<osg::Fog>(state, osg::StateAttribute::FOG);
    if (!fog) return;
    uniforms.set(fogColor, fog->getColor());
    uniforms.set(fogRange, osg::Vec4(fog->getDensity(), fog->getStart(), fog->getEnd(),
                                     1.0f / (fog->getEnd() - fog->getStart())));
}

} // namespace osgGpuAnimation
