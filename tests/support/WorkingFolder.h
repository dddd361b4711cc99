// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace osgGpuAnimation
{

/// Sets the working folder while this object exists.
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
