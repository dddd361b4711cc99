// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/gpu/OffscreenContext.h>

#include <osgViewer/GraphicsWindow>

USE_GRAPHICSWINDOW()

namespace osgGpuAnimation
{

Result<osg::ref_ptr<osg::GraphicsContext>> createOffscreenContext(osg::GraphicsContext::Traits* traits)
{
    if (!traits || traits->width <= 0 || traits->height <= 0)
        return Error{"a context needs traits with a width and a height above 0"};
    traits->pbuffer = true;
    traits->doubleBuffer = false;
    traits->readDISPLAY();
    traits->setUndefinedScreenDetailsToDefaultScreen();
    osg::ref_ptr<osg::GraphicsContext> context = osg::GraphicsContext::createGraphicsContext(traits);
    if (!context || !context->valid())
        return Error{"OSG has no pbuffer of the traits asked for; it needs a display, since this osgGpuAnimation was "
                     "built without EGL"};
    return context;
}

} // namespace osgGpuAnimation
