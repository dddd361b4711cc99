// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

namespace osgGpuAnimation
{

/// All that is in a file; empty where there is none.
std::string fileText(const std::filesystem::path& path);

} // namespace osgGpuAnimation
