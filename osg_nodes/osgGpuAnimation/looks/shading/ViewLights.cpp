// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/looks/shading/ViewLights.h>

#include <osgGpuAnimation/gpu/detail/FixedPipeline.h>

#include <osg/Fog>
#include <osg/GraphicsContext>
#include <osg/LightModel>
#include <osg/Material>
#include <osg/observer_ptr>

#include <array>
#include <cmath>
#include <optional>

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

// Vectors of coreState in light.glsl.
constexpr std::size_t sceneVectors = 4, lightVectors = 6;

void setLight(osg::Vec4* numbers, const osg::Light& light, const osg::Matrixd& toEye)
{
    const osg::Vec3 direction(osg::Matrixd::transform3x3(osg::Vec3d(light.getDirection()), toEye));
    numbers[0] = light.getAmbient();
    numbers[1] = light.getDiffuse();
    numbers[2] = light.getSpecular();
    numbers[2].w() = static_cast<float>(std::cos(osg::DegreesToRadians(light.getSpotCutoff())));
    numbers[3] = osg::Vec4(osg::Vec4d(light.getPosition()) * toEye);
    numbers[4] = osg::Vec4(direction, light.getSpotExponent());
    numbers[5] = osg::Vec4(light.getSpotCutoff(), light.getConstantAttenuation(), light.getLinearAttenuation(),
                           light.getQuadraticAttenuation());
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
    static const unsigned int name = osg::Uniform::getNameID("coreState");
    const osg::Program::PerContextProgram* program = state.getLastAppliedProgramObject();
    const GLint location = program ? program->getUniformLocation(name) : -1;
    if (location < 0) return;
    const auto* model = applied<osg::LightModel>(state, osg::StateAttribute::LIGHTMODEL);
    const auto* material = applied<osg::Material>(state, osg::StateAttribute::MATERIAL);
    osg::Vec4 shine = material ? material->getSpecular(osg::Material::FRONT) : osg::Vec4();
    shine.w() = material ? material->getShininess(osg::Material::FRONT) : 0.0f;
    std::array<osg::Vec4, sceneVectors + lightVectors * ViewLights::lightCount> numbers{
        model ? model->getAmbientIntensity() : osg::Vec4(0.2f, 0.2f, 0.2f, 1.0f), shine};
    if (const auto* fog = applied<osg::Fog>(state, osg::StateAttribute::FOG))
    {
        numbers[2] = fog->getColor();
        numbers[3] =
            osg::Vec4(fog->getDensity(), fog->getStart(), fog->getEnd(), 1.0f / (fog->getEnd() - fog->getStart()));
    }
    std::size_t count = sceneVectors;
    const LightList placed = lights != 0 ? ViewLights::of(state) : LightList();
    for (std::size_t i = 0; lights >> i != 0; ++i, count += lightVectors)
        if (placed[i].light && (lights & (1u << i)) != 0) setLight(&numbers[count], *placed[i].light, placed[i].toEye);
    state.get<osg::GLExtensions>()->glUniform4fv(location, static_cast<GLsizei>(count), numbers[0].ptr());
}

} // namespace osgGpuAnimation
