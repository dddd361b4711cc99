// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <fstream>
#include <random>
#include <string>

namespace osgGpuAnimation
{

/// A folder of a test's own, removed with all its files at the end.
class ScratchFolder
{
public:
    ScratchFolder()
    {
        std::random_device random;
        do
            _path = std::filesystem::temp_directory_path() / ("osggpuanimation-" + std::to_string(random()));
        while (!std::filesystem::create_directory(_path));
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    ~ScratchFolder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(_path, ignored);
    }

    std::string file(const std::string& name) const { return (_path / name).string(); }
    /// Writes a file there and returns its path.
    std::string write(const std::string& name, const std::string& content) const
    {
        std::ofstream(_path / name, std::ios::binary) << content;
        return file(name);
    }

private:
    std::filesystem::path _path;
};

} // namespace osgGpuAnimation
