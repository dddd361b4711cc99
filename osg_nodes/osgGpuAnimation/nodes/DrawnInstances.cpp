// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/DrawnInstances.h>

#include <osgUtil/Statistics>

namespace osgGpuAnimation
{

DrawnInstances::DrawnInstances()
{
    setName("osgGpuAnimation DrawnInstances");
    setUseDisplayList(false);
    setCullingActive(false); // it has no place
}

void DrawnInstances::accept(osg::PrimitiveFunctor& functor) const
{
    if (auto* statistics = dynamic_cast<osgUtil::Statistics*>(&functor)) --statistics->numDrawables;
    for (const Draw& draw : _draws)
        for (std::size_t instance = 1; instance < draw.binding->drawnCount(); ++instance)
            draw.mesh->accept(functor);
}

} // namespace osgGpuAnimation
