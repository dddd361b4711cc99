// SPDX-License-Identifier: MIT
#include "house/FileText.h"

#include <algorithm>
#include <fstream>
#include <sstream>

namespace osgGpuAnimation
{

std::string fileText(const std::filesystem::path& path)
{
    std::ifstream file(path);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

std::vector<std::filesystem::path> guides()
{
    const std::filesystem::path root = OSGGPUANIMATION_SOURCE_FOLDER;
    std::vector<std::filesystem::path> files = {root / "README.md"};
    for (const char* folder : {"osg_nodes/doc", "scenes", "tests/benchmark"})
        for (const auto& entry : std::filesystem::directory_iterator(root / folder))
            if (entry.path().extension() == ".md") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

} // namespace osgGpuAnimation
