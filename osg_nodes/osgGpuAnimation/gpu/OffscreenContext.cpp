// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/gpu/OffscreenContext.h>

#include <osgGpuAnimation/gpu/EglGraphicsContext.h>

namespace osgGpuAnimation
{

Result<osg::ref_ptr<osg::GraphicsContext>> createOffscreenContext(osg::GraphicsContext::Traits* traits)
{
    const Result<osg::ref_ptr<EglGraphicsContext>> made = EglGraphicsContext::create(traits);
    if (!made) return made.error();
    return osg::ref_ptr<osg::GraphicsContext>(made.value());
}

} // namespace osgGpuAnimation
