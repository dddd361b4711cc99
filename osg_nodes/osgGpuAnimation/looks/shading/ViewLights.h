// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Light>
#include <osg/Matrix>
#include <osg/StateAttribute>
#include <osgUtil/CullVisitor>
#include <osgUtil/RenderStage>

#include <array>

namespace osgGpuAnimation
{

/// The lights of a render stage for shaders of a core profile, where GL keeps no lights: OSG's list of what has a
/// place, which is complete when the stage is drawn.
class ViewLights : public osg::StateAttribute
{
public:
    static constexpr unsigned int lightCount = 8;
    /// A light and the matrix from its space to eye space; null: none of this number.
    struct Placed
    {
        const osg::Light* light = nullptr;
        osg::Matrixd toEye;
    };

    ViewLights() = default;
    explicit ViewLights(osgUtil::RenderStage& stage) : _stage(&stage) {}
    ViewLights(const ViewLights& other, const osg::CopyOp& copyop = osg::CopyOp::SHALLOW_COPY)
        : osg::StateAttribute(other, copyop), _stage(other._stage)
    {
    }
    /// Before PROGRAM, see ShaderHook.
    META_StateAttribute(osgGpuAnimation, ViewLights, VERTEXPROGRAM)

    unsigned int getMember() const override { return member; }
    int compare(const osg::StateAttribute& other) const override;
    void apply(osg::State&) const override {}

    /// By number. Without a ViewLights in the present state there are none.
    static std::array<Placed, lightCount> of(const osg::State& state);

protected:
    ~ViewLights() override = default;

private:
    static constexpr unsigned int member = 128;

    osgUtil::RenderStage* _stage = nullptr; ///< it outlives the state graph that has this attribute
};

/// RAII: what is culled has the ViewLights of its render stage. Without OSG's matrix uniforms it does nothing.
class ViewLightsScope
{
public:
    explicit ViewLightsScope(osgUtil::CullVisitor& visitor);
    ~ViewLightsScope();
    ViewLightsScope(const ViewLightsScope&) = delete;
    ViewLightsScope& operator=(const ViewLightsScope&) = delete;

private:
    osgUtil::CullVisitor* _visitor; ///< null: nothing to do
};

/// A cull callback for the meshes that do not move below a node: a ViewLightsScope.
class ViewLightsCallback : public osg::NodeCallback
{
public:
    ViewLightsCallback() = default;
    ViewLightsCallback(const ViewLightsCallback& other, const osg::CopyOp& copyop = osg::CopyOp::SHALLOW_COPY)
        : osg::Object(other, copyop), osg::Callback(other, copyop), osg::NodeCallback(other, copyop)
    {
    }
    META_Object(osgGpuAnimation, ViewLightsCallback)
    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override;

protected:
    ~ViewLightsCallback() override = default;
};

/// The attribute of that type in the present state; null: none.
template <typename Attribute>
const Attribute* applied(const osg::State& state, osg::StateAttribute::Type type, unsigned int member = 0)
{
    return static_cast<const Attribute*>(state.getLastAppliedAttribute(type, member));
}

/// True if the context has a core profile, where OSG draws with its matrix uniforms, or OSG was built without the fixed
/// pipeline. On the draw side only.
bool isCoreProfile(const osg::State& state);

/// Sets the uniforms of light.glsl for the core profile in the applied program: lights (a bit for each number), the
/// ambient light of LightModel, the shine of Material, and Fog.
void setFixedPipelineUniforms(osg::State& state, unsigned int lights);

} // namespace osgGpuAnimation
