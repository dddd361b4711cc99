// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/looks/shading/ViewLights.h>

#include <osg/Fog>
#include <osg/LightModel>
#include <osg/Material>

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
        lights[static_cast<std::size_t>(light->getLightNum())] = {light, matrix ? *matrix * after : after};
    }
}

/// Sets uniforms of the applied program by name.
class Uniforms
{
public:
    explicit Uniforms(osg::State& state)
        : _program(state.getLastAppliedProgramObject()), _gl(*state.get<osg::GLExtensions>())
    {
    }
    void set(const std::string& name, const osg::Vec4& value) const
    {
        if (const GLint location = find(name); location >= 0) _gl.glUniform4fv(location, 1, value.ptr());
    }
    void set(const std::string& name, const osg::Vec3& value) const
    {
        if (const GLint location = find(name); location >= 0) _gl.glUniform3fv(location, 1, value.ptr());
    }
    void set(const std::string& name, float value) const
    {
        if (const GLint location = find(name); location >= 0) _gl.glUniform1f(location, value);
    }

private:
    GLint find(const std::string& name) const
    {
        return _program ? _program->getUniformLocation(osg::Uniform::getNameID(name)) : -1;
    }

    const osg::Program::PerContextProgram* _program;
    const osg::GLExtensions& _gl;
};

void setLight(const Uniforms& uniforms, const std::string& name, const ViewLights::Placed& placed)
{
    const osg::Light& light = *placed.light;
    uniforms.set(name + ".ambient", light.getAmbient());
    uniforms.set(name + ".diffuse", light.getDiffuse());
    uniforms.set(name + ".specular", light.getSpecular());
    uniforms.set(name + ".position", osg::Vec4(osg::Vec4d(light.getPosition()) * placed.toEye));
    uniforms.set(name + ".spotDirection",
                 osg::Vec3(osg::Matrixd::transform3x3(osg::Vec3d(light.getDirection()), placed.toEye)));
    uniforms.set(name + ".spotExponent", light.getSpotExponent());
    uniforms.set(name + ".spotCutoff", light.getSpotCutoff());
    uniforms.set(name + ".spotCosCutoff", static_cast<float>(std::cos(osg::DegreesToRadians(light.getSpotCutoff()))));
    uniforms.set(name + ".constantAttenuation", light.getConstantAttenuation());
    uniforms.set(name + ".linearAttenuation", light.getLinearAttenuation());
    uniforms.set(name + ".quadraticAttenuation", light.getQuadraticAttenuation());
}

template <typename Attribute>
const Attribute* appliedTo(const osg::State& state, osg::StateAttribute::Type type)
{
    return static_cast<const Attribute*>(state.getLastAppliedAttribute(type));
}

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
    : _visitor(visitor.getState() && hasOwnLights(*visitor.getState()) ? &visitor : nullptr)
{
    if (!_visitor) return;
    osgUtil::RenderStage* stage = visitor.getCurrentRenderBin() ? visitor.getCurrentRenderBin()->getStage() : nullptr;
    if (!stage) stage = visitor.getRenderStage();
    // One state for all that the stage draws in its life.
    osgUtil::PositionalStateContainer& container = *stage->getPositionalStateContainer();
    osg::ref_ptr<osg::StateSet> state = dynamic_cast<osg::StateSet*>(container.getUserData());
    if (!state)
    {
        state = new osg::StateSet;
        state->setAttribute(new ViewLights(*stage));
        container.setUserData(state);
    }
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

void setFixedState(osg::State& state, unsigned int lights)
{
    const Uniforms uniforms(state);
    const LightList placed = ViewLights::of(state);
    for (std::size_t i = 0; i < placed.size(); ++i)
        if ((lights & (1u << i)) != 0 && placed[i].light)
            setLight(uniforms, "lightSource[" + std::to_string(i) + "]", placed[i]);
    const auto* model = appliedTo<osg::LightModel>(state, osg::StateAttribute::LIGHTMODEL);
    uniforms.set("lightModelAmbient", model ? model->getAmbientIntensity() : osg::Vec4(0.2f, 0.2f, 0.2f, 1.0f));
    const auto* material = appliedTo<osg::Material>(state, osg::StateAttribute::MATERIAL);
    osg::Vec4 shine = material ? material->getSpecular(osg::Material::FRONT) : osg::Vec4();
    shine.w() = material ? material->getShininess(osg::Material::FRONT) : 0.0f;
    uniforms.set("materialShine", shine);
    const auto* fog = appliedTo<osg::Fog>(state, osg::StateAttribute::FOG);
    if (!fog) return;
    uniforms.set("fogColor", fog->getColor());
    uniforms.set("fogRange", osg::Vec4(fog->getDensity(), fog->getStart(), fog->getEnd(),
                                       1.0f / (fog->getEnd() - fog->getStart())));
}

} // namespace osgGpuAnimation
