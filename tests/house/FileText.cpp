// SPDX-License-Identifier: MIT
#include "house/FileText.h"

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

} // namespace osgGpuAnimation
