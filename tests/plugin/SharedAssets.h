// SPDX-License-Identifier: MIT
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace osgGpuAnimation
{

/// A file of the folder with real characters and their poses (OSGGPUANIMATION_SHARED_ASSETS); empty if it does not
/// exist.
inline std::string sharedFile(const std::string& name)
{
    const std::string path = std::string(OSGGPUANIMATION_SHARED_ASSETS) + "/" + name;
    return std::filesystem::is_regular_file(path) ? path : "";
}

/// A file of our own scenes.
inline std::string ownScene(const std::string& name)
{
    return std::string(OSGGPUANIMATION_SCENES) + "/" + name;
}

/// A shared file where the name has folders, else one of our own scenes.
inline std::string modelFile(const std::string& name)
{
    return name.find('/') == std::string::npos ? ownScene(name) : sharedFile(name);
}

inline std::string readBytes(const std::string& path)
{
    std::ifstream stream(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(stream), {});
}

} // namespace osgGpuAnimation

/// Ends the test as skipped, with the reason, where the shared file is missing.
#define SKIP_WITHOUT_SHARED_FILE(name)                                                                                 \
    if (::osgGpuAnimation::sharedFile(name).empty())                                                                   \
    GTEST_SKIP() << "there is no " << (name) << " in " << OSGGPUANIMATION_SHARED_ASSETS
