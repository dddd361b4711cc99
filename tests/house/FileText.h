// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <regex>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// The root of the repository.
std::filesystem::path sourceFolder();

/// The content of a file; empty if the file does not exist.
std::string fileText(const std::filesystem::path& path);

/// README.md, the guides in osg_nodes/doc, and the .md files of scenes/ and tests/benchmark/.
std::vector<std::filesystem::path> guides();

/// The first group of all matches.
std::vector<std::string> matches(const std::string& text, const std::regex& pattern);

} // namespace osgGpuAnimation
