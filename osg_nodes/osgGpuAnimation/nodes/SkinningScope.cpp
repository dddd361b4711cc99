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

} // namespace

SkinningScope::SkinningScope(osgUtil::CullVisitor& visitor, const SkinnedGeometry& mesh)
{
    const PaletteBinding* binding = bindingAbove(visitor);
    if (!binding) return;
    if (binding->isOfMany()) PoseStage::count(visitor, mesh, *binding);
    if (!mesh.mayBeSkinnedOnce()) return;
    osg::StateSet* state = PoseStage::reads(visitor).add(mesh, *binding);
    if (!state) return;
    visitor.pushStateSet(state);
    _visitor = &visitor;
}

SkinningScope::~SkinningScope()
{
    if (_visitor) _visitor->popStateSet();
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
