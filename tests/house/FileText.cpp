// SPDX-License-Identifier: MIT
#include "house/FileText.h"

#include <algorithm>
#include <fstream>
#include <sstream>

namespace osgGpuAnimation
{

std::filesystem::path sourceFolder()
{
    return OSGGPUANIMATION_SOURCE_FOLDER;
}

std::string fileText(const std::filesystem::path& path)
{
    std::ifstream file(path);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

std::vector<std::filesystem::path> guides()
{
    std::vector<std::filesystem::path> files = {sourceFolder() / "README.md"};
    for (const char* folder : {"osg_nodes/doc", "scenes", "tests/benchmark"})
        for (const auto& entry : std::filesystem::directory_iterator(sourceFolder() / folder))
            if (entry.path().extension() == ".md") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

std::vector<std::string> matches(const std::string& text, const std::regex& pattern)
{
    std::vector<std::string> found;
    for (std::sregex_iterator match(text.begin(), text.end(), pattern), end; match != end; ++match)
        found.push_back((*match)[1]);
    return found;
}

} // namespace osgGpuAnimation
