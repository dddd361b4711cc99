// SPDX-License-Identifier: MIT
#pragma once

#include <osgDB/Registry>

namespace osgGpuAnimation
{

/// From now on osgDB looks for plugins among those of the build first.
inline void usePluginsOfTheBuild()
{
    osgDB::FilePathList& paths = osgDB::Registry::instance()->getLibraryFilePathList();
    if (paths.empty() || paths.front() != OSGGPUANIMATION_PLUGIN_FOLDER)
        paths.push_front(OSGGPUANIMATION_PLUGIN_FOLDER);
}

} // namespace osgGpuAnimation
