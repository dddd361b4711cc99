// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/Result.h>

#include <osg/GraphicsContext>

namespace osgGpuAnimation
{

/// A graphics context without a window on the screen: an EglGraphicsContext, which needs no display, or, if the kit was
/// built without EGL, a pbuffer of OSG's windowing system, which needs one. traits: see EglGraphicsContext::create().
///
///     Result<osg::ref_ptr<osg::GraphicsContext>> made = createOffscreenContext(800, 600);
///
/// Errors: there is no such context, with the reason.
Result<osg::ref_ptr<osg::GraphicsContext>> createOffscreenContext(osg::GraphicsContext::Traits* traits);

/// The same with 24 depth bits, 8 stencil bits and no multisampling.
inline Result<osg::ref_ptr<osg::GraphicsContext>> createOffscreenContext(int width, int height)
{
    osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
    traits->width = width;
    traits->height = height;
    traits->depth = 24;
    traits->stencil = 8;
    return createOffscreenContext(traits.get());
}

} // namespace osgGpuAnimation
