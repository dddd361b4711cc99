// SPDX-License-Identifier: MIT
#include "house/FileText.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

// Who may include whom: only downwards, animation <- gpu <- nodes <- plugin (see the README's table of folders).

namespace osgGpuAnimation
{

namespace
{

namespace fs = std::filesystem;

struct Layer
{
    const char* folder;    ///< under the repository's root
    const char* forbidden; ///< what an #include there must not name
};

void PrintTo(const Layer& layer, std::ostream* out)
{
    *out << layer.folder;
}

const Layer layers[] = {
    {"osg_nodes/osgGpuAnimation/animation",
     R"(^(osg|osg[A-Z]\w*|GL|EGL|OpenThreads)/|^tiny_gltf|^osgGpuAnimation/(gpu|nodes)/|^(gltf|tool)/)"},
    {"osg_nodes/osgGpuAnimation/gpu", R"(^osgGpuAnimation/nodes/|^tiny_gltf|^(gltf|tool)/|^osg(Viewer|DB|GA)/)"},
    {"osg_nodes/osgGpuAnimation/nodes", R"(^tiny_gltf|^(gltf|tool)/|^osgDB/)"},
    {"plugin/gltf", R"(^tool/|^osgViewer/)"},
};

/// The includes of a source text that its layer forbids. The kit's own folders count by their path alone.
std::vector<std::string> forbiddenIncludes(const std::string& text, const Layer& layer)
{
    static const std::regex include(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
    const std::regex forbidden(layer.forbidden);
    std::vector<std::string> found;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
    {
        std::smatch match;
        if (!std::regex_search(line, match, include)) continue;
        const std::string name = match[1];
        const bool isOwn = name.rfind("osgGpuAnimation/animation/", 0) == 0;
        if (!isOwn && std::regex_search(name, forbidden)) found.push_back(name);
    }
    return found;
}

class LayerTest : public ::testing::TestWithParam<Layer>
{
};

TEST_P(LayerTest, includesOnlyDownwards)
{
    const fs::path folder = fs::path(OSGGPUANIMATION_SOURCE_FOLDER) / GetParam().folder;
    std::size_t files = 0;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    {
        if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
        ++files;
        for (const std::string& name : forbiddenIncludes(fileText(entry.path()), GetParam()))
            ADD_FAILURE() << entry.path() << " includes " << name;
    }
    EXPECT_GT(files, 3u) << "the check must have something to check";
}

INSTANTIATE_TEST_SUITE_P(Folders, LayerTest, ::testing::ValuesIn(layers));

struct Planted
{
    const char* line;
    std::size_t layer;
    std::size_t faults;
};

TEST(LayerCheckTest, seesPlantedIncludes)
{
    const Planted planted[] = {
        {"#include <osg/Vec3>", 0, 1},
        {"#include <osgUtil/CullVisitor>", 0, 1},
        {"  #  include <GL/gl.h>", 0, 1},
        {"#include <osgGpuAnimation/gpu/PoseBatch.h>", 0, 1},
        {"#include <osgGpuAnimation/animation/Clip.h>", 0, 0},
        {"#include <glm/vec3.hpp>", 0, 0},
        {"#include <osgGpuAnimation/nodes/frame/PoseStage.h>", 1, 1},
        {"#include <osg/State>", 1, 0},
        {"#include <tiny_gltf.h>", 2, 1},
        {"#include \"gltf/Import.h\"", 2, 1},
        {"#include \"tool/PoseCommand.h\"", 3, 1},
    };
    for (const Planted& plant : planted)
        EXPECT_EQ(forbiddenIncludes(plant.line, layers[plant.layer]).size(), plant.faults) << plant.line;
}

} // namespace

} // namespace osgGpuAnimation
