// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace osgGpuAnimation
{

/// Where relative paths begin, for as long as this lives.
class WorkingFolder
{
public:
    explicit WorkingFolder(const std::filesystem::path& folder) : _before(std::filesystem::current_path())
    {
        std::filesystem::current_path(folder);
    }
    WorkingFolder(const WorkingFolder&) = delete;
    WorkingFolder& operator=(const WorkingFolder&) = delete;
    ~WorkingFolder() { std::filesystem::current_path(_before); }

private:
    std::filesystem::path _before;
};

} // namespace osgGpuAnimation
