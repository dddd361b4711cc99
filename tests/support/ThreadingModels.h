// SPDX-License-Identifier: MIT
#pragma once

#include <osgViewer/ViewerBase>

namespace osgGpuAnimation
{

/// All threading models of a viewer except AutomaticSelection, which selects one of them.
inline constexpr osgViewer::ViewerBase::ThreadingModel threadingModels[] = {
    osgViewer::ViewerBase::SingleThreaded, osgViewer::ViewerBase::CullDrawThreadPerContext,
    osgViewer::ViewerBase::DrawThreadPerContext, osgViewer::ViewerBase::CullThreadPerCameraDrawThreadPerContext};

} // namespace osgGpuAnimation
