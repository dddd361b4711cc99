// SPDX-License-Identifier: MIT
#pragma once

#include <osg/GLExtensions>

namespace osgGpuAnimation
{

/// The bits of the current context's clock (GL_ARB_timer_query); 0: no time stamps. Some drivers have the queries but
/// no clock.
inline GLint timeStampBits(const osg::GLExtensions& gl)
{
    GLint bits = 0;
    if (gl.isARBTimerQuerySupported) gl.glGetQueryiv(GL_TIMESTAMP, GL_QUERY_COUNTER_BITS, &bits);
    return bits;
}

} // namespace osgGpuAnimation
