// SPDX-License-Identifier: MIT
#include "house/FileText.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <set>
#include <string>
#include <vector>

// The guides name the public headers and other files. The table of headers in application.md is complete, the umbrella
// header includes the same headers, and each path in a guide exists.

namespace osgGpuAnimation
{

namespace
{

namespace fs = std::filesystem;

const fs::path root = OSGGPUANIMATION_SOURCE_FOLDER;
const fs::path kit = root / "osg_nodes/osgGpuAnimation";

/// The first group of all matches.
std::vector<std::string> matches(const std::string& text, const std::regex& pattern)
{
    std::vector<std::string> found;
    for (std::sregex_iterator match(text.begin(), text.end(), pattern), end; match != end; ++match)
        found.push_back((*match)[1]);
    return found;
}

std::set<std::string> publicHeaders()
{
    std::set<std::string> headers;
    for (const char* folder : {"math", "animation", "authoring", "gpu", "scene", "looks", "mesh", "frame", "nodes"})
        for (const auto& entry : fs::directory_iterator(kit / folder))
            if (entry.path().extension() == ".h")
                headers.insert(std::string(folder) + "/" + entry.path().filename().string());
    return headers;
}

std::set<std::string> setOf(const std::vector<std::string>& names)
{
    return std::set<std::string>(names.begin(), names.end());
}

/// Paths between backticks: `tests/run.sh`, `animation/Pose` (a header with its source), `nodes/frame`.
std::vector<std::string> namedPaths(const std::string& markdown)
{
    static const std::regex path(
        R"(`((?:math|animation|authoring|gpu|scene|looks|mesh|frame|nodes|plugin|shaders|tests|scenes|osg_nodes)/[\w./-]*)`)");
    return matches(markdown, path);
}

bool isPath(const std::string& path)
{
    for (const fs::path& folder : {root, kit})
        if (fs::exists(folder / path) || fs::exists(folder / (path + ".h")) || fs::exists(folder / (path + ".cpp")))
            return true;
    return false;
}

} // namespace

TEST(FaceTest, theTableOfHeadersIsComplete)
{
    static const std::regex row(R"(\| `((?:math|animation|authoring|gpu|scene|looks|mesh|frame|nodes)/\w+\.h)` \|)");
    EXPECT_EQ(setOf(matches(fileText(root / "osg_nodes/doc/application.md"), row)), publicHeaders());
}

TEST(FaceTest, theUmbrellaHeaderIncludesAllPublicHeaders)
{
    static const std::regex include(R"(#include <osgGpuAnimation/([^>]+)>)");
    EXPECT_EQ(setOf(matches(fileText(kit / "osgGpuAnimation.h"), include)), publicHeaders());
}

TEST(FaceTest, everyPathInTheGuidesExists)
{
    std::size_t count = 0;
    for (const fs::path& guide : guides())
        for (const std::string& path : namedPaths(fileText(guide)))
        {
            // Examples of new files: tests/FOLDER/NameTest.cpp, plugin/ReaderWriterName.cpp, plugin/name/.
            const bool isExample = std::regex_search(path, std::regex("FOLDER|Name|/name"));
            EXPECT_TRUE(isExample || isPath(path)) << guide << ": " << path;
            ++count;
        }
    EXPECT_GE(count, 30u);
}

} // namespace osgGpuAnimation
