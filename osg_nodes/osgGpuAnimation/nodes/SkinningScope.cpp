// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/SkinningScope.h>

#include <osgGpuAnimation/nodes/PoseStage.h>

namespace osgGpuAnimation
{

namespace
{

const PaletteBinding* bindingAbove(osgUtil::CullVisitor& visitor)
{
    for (const osgUtil::StateGraph* graph = visitor.getCurrentStateGraph(); graph; graph = graph->_parent)
    {
        const osg::StateSet* stateSet = graph->getStateSet();
        if (!stateSet) continue;
        const osg::StateAttribute* binding = stateSet->getAttribute(PaletteBinding::bindingType);
        if (binding) return static_cast<const PaletteBinding*>(binding);
    }
    return nullptr;
}

osg::ref_ptr<osg::StateSet> makeColoredState(const std::string& colors)
{
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    state->setDefine("POSE_COLORED", colors);
    return state;
}

osg::StateSet& coloredState(SkinnedGeometry::Colors colors)
{
    static const osg::ref_ptr<osg::StateSet> ofArray = makeColoredState("1"), ofTargets = makeColoredState("2");
    return colors == SkinnedGeometry::Colors::Array ? *ofArray : *ofTargets;
}

} // namespace

SkinningScope::SkinningScope(osgUtil::CullVisitor& visitor, const SkinnedGeometry& mesh) : _visitor(visitor)
{
    const PaletteBinding* binding = bindingAbove(visitor);
    if (!binding) return;
    if (binding->isOfMany()) PoseStage::count(visitor, mesh, *binding);
    const SkinnedGeometry::Colors colors = mesh.colors();
    if (colors != SkinnedGeometry::Colors::White) push(coloredState(colors));
    if (!mesh.mayBeSkinnedOnce()) return;
    if (osg::StateSet* state = PoseStage::reads(visitor).add(mesh, *binding)) push(*state);
}

SkinningScope::~SkinningScope()
{
    while (_pushed-- > 0)
        _visitor.popStateSet();
}

void SkinningScope::push(osg::StateSet& stateSet)
{
    _visitor.pushStateSet(&stateSet);
    ++_pushed;
}

void addMeshAndDepth(osgUtil::CullVisitor& visitor, SkinnedGeometry& mesh, osg::RefMatrix* toEye, float depth)
{
    const SkinningScope skinning(visitor, mesh);
    osg::StateSet* stateSet = mesh.getStateSet();
    if (stateSet) visitor.pushStateSet(stateSet);
    visitor.addDrawableAndDepth(&mesh, toEye, depth);
    if (stateSet) visitor.popStateSet();
}

} // namespace osgGpuAnimation
