// SPDX-License-Identifier: MIT
#include "WarningWatch.h"

#include <iostream>

namespace osgGpuAnimation::benchmark
{

void WarningWatch::notify(osg::NotifySeverity severity, const char* message)
{
    std::cerr << message << std::flush;
    if (severity <= osg::NOTICE) _warnings += message;
}

} // namespace osgGpuAnimation::benchmark
