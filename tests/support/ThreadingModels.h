// SPDX-License-Identifier: MIT
#pragma once

#include <osgViewer/ViewerBase>

namespace osgGpuAnimation
{

/// All threading models that a viewer has, but for AutomaticSelection, which picks one of them.
inline constexpr osgViewer::ViewerBase::ThreadingModel threadingModels[] = {
    osgViewer::ViewerBase::SingleThreaded, osgViewer::ViewerBase::CullDrawThreadPerContext,
    osgViewer::ViewerBase::DrawThreadPerContext, osgViewer::ViewerBase::CullThreadPerCameraDrawThreadPerContext};

} // namespace osgGpuAnimation
