// SPDX-License-Identifier: MIT
#include "house/FileText.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

// The house: which room may include which, and how large rooms and folders may be. A room is a header with its source.
// The order is the list in tests/house/rooms.txt, lowest first: a room includes only rooms above its own line.

namespace osgGpuAnimation
{

namespace
{

namespace fs = std::filesystem;

using Texts =
    std::map<std::string, std::string>; ///< by path below the repository's root, such as "plugin/gltf/Import.h"

constexpr std::size_t maxRoomsInFolder = 14;
constexpr std::size_t maxFileLines = 600;
constexpr std::size_t minSourceLines = 30; ///< shorter sources belong to a neighbour's room, with few exceptions
constexpr std::size_t maxShortSources = 10;
constexpr std::size_t maxReadmeLines = 150;

/// Headers of other people that a folder must not include.
struct Layer
{
    const char* folder;
    const char* forbidden;
};

const Layer layers[] = {
    {"osg_nodes/osgGpuAnimation/animation/", R"(^(osg|osg[A-Z]\w*|GL|EGL|OpenThreads)/|^tiny_gltf)"},
    {"osg_nodes/osgGpuAnimation/gpu/", R"(^tiny_gltf|^osg(Viewer|DB|GA)/)"},
    {"osg_nodes/osgGpuAnimation/nodes/", R"(^tiny_gltf|^osgDB/)"},
    {"plugin/gltf/", R"(^osgViewer/)"},
};

std::vector<std::string> includesOf(const std::string& text, const char* delimiters = "[<\"]")
{
    const std::regex include(std::string(R"(^\s*#\s*include\s*)") + delimiters + R"(([^>"]+)[>"])");
    std::vector<std::string> found;
    std::istringstream lines(text);
    std::smatch match;
    for (std::string line; std::getline(lines, line);)
        if (std::regex_search(line, match, include)) found.push_back(match[1]);
    return found;
}

/// "plugin/gltf/Import.cpp" and "plugin/gltf/Import.h": "plugin/gltf/Import".
std::string roomOf(const std::string& path)
{
    return path.substr(0, path.rfind('.'));
}

/// The room that an include names, whichever of the include paths it is below; empty: none of ours.
std::string roomOfInclude(const std::string& include, const std::map<std::string, std::size_t>& order)
{
    for (const char* below : {"osg_nodes/", "plugin/"})
        if (const std::string room = below + roomOf(include); order.count(room) != 0) return room;
    return {};
}

std::map<std::string, std::size_t> orderOf(const std::string& list)
{
    std::map<std::string, std::size_t> order;
    std::istringstream lines(list);
    for (std::string line; std::getline(lines, line);)
        if (!line.empty() && line[0] != '#') order.emplace(line, order.size());
    return order;
}

/// Includes against the order, quoted includes that name no room by its path, rooms that the list does not have,
/// entries of the list without a room.
std::vector<std::string> faultsOfOrder(const Texts& texts, const std::map<std::string, std::size_t>& order)
{
    std::vector<std::string> faults;
    std::set<std::string> seen;
    for (const auto& [path, text] : texts)
    {
        const auto own = order.find(roomOf(path));
        if (own == order.end())
        {
            faults.push_back(path + " is no room of the list");
            continue;
        }
        seen.insert(own->first);
        for (const std::string& include : includesOf(text))
        {
            const std::string other = roomOfInclude(include, order);
            if (!other.empty() && order.at(other) > own->second)
                faults.push_back(path + " includes " + other + ", which lies above it");
        }
        for (const std::string& include : includesOf(text, "\""))
            if (roomOfInclude(include, order).empty()) faults.push_back(path + " includes " + include + ", no room");
    }
    for (const auto& [room, place] : order)
        if (seen.count(room) == 0) faults.push_back(room + " is on the list, but not in the tree");
    return faults;
}

bool isFace(const std::string& room)
{
    static const std::regex face(R"(^osg_nodes/osgGpuAnimation/((animation|gpu|nodes)/)?\w+$)");
    return std::regex_match(room, face);
}

/// Headers of faces that include rooms which are not installed.
std::vector<std::string> faultsOfFaces(const Texts& texts, const std::map<std::string, std::size_t>& order)
{
    std::vector<std::string> faults;
    for (const auto& [path, text] : texts)
    {
        if (path.back() != 'h' || !isFace(roomOf(path))) continue;
        for (const std::string& include : includesOf(text))
        {
            const std::string other = roomOfInclude(include, order);
            const bool isPart = !other.empty() && !isFace(other);
            if (isPart || include == "layout.glsl") faults.push_back(path + " includes " + include);
        }
    }
    return faults;
}

std::vector<std::string> faultsOfLayers(const Texts& texts)
{
    std::vector<std::string> faults;
    for (const auto& [path, text] : texts)
        for (const Layer& layer : layers)
        {
            if (path.rfind(layer.folder, 0) != 0) continue;
            const std::regex forbidden(layer.forbidden);
            for (const std::string& include : includesOf(text))
                if (include.rfind("osgGpuAnimation/", 0) != 0 && std::regex_search(include, forbidden))
                    faults.push_back(path + " includes " + include);
        }
    return faults;
}

std::size_t lineCount(const std::string& text)
{
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

std::vector<std::string> faultsOfSizes(const Texts& texts)
{
    std::vector<std::string> faults;
    std::map<std::string, std::set<std::string>> folders;
    std::vector<std::string> shortSources;
    for (const auto& [path, text] : texts)
    {
        folders[path.substr(0, path.rfind('/'))].insert(roomOf(path));
        const std::size_t lines = lineCount(text);
        if (lines > maxFileLines) faults.push_back(path + " has " + std::to_string(lines) + " lines");
        if (path.back() == 'p' && lines < minSourceLines) shortSources.push_back(path);
    }
    for (const auto& [folder, rooms] : folders)
        if (rooms.size() > maxRoomsInFolder)
            faults.push_back(folder + " has " + std::to_string(rooms.size()) + " rooms");
    if (shortSources.size() > maxShortSources)
        for (const std::string& path : shortSources)
            faults.push_back(path + " is one of " + std::to_string(shortSources.size()) + " short sources");
    return faults;
}

/// Every header and source of the kit and the plugins.
Texts readHouse()
{
    const fs::path root = OSGGPUANIMATION_SOURCE_FOLDER;
    Texts texts;
    for (const char* folder : {"osg_nodes", "plugin"})
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder))
            if (entry.path().extension() == ".h" || entry.path().extension() == ".cpp")
                texts[fs::relative(entry.path(), root).generic_string()] = fileText(entry.path());
    return texts;
}

std::string joined(const std::vector<std::string>& faults)
{
    std::string text;
    for (const std::string& fault : faults)
        text += fault + '\n';
    return text;
}

class HouseTest : public ::testing::Test
{
protected:
    const Texts texts = readHouse();
    const std::map<std::string, std::size_t> order =
        orderOf(fileText(fs::path(OSGGPUANIMATION_SOURCE_FOLDER) / "tests/house/rooms.txt"));
};

TEST_F(HouseTest, roomsIncludeOnlyLowerRooms)
{
    EXPECT_GT(texts.size(), 100u) << "the check must have something to check";
    EXPECT_EQ(joined(faultsOfOrder(texts, order)), "");
}

TEST_F(HouseTest, layersIncludeOnlyTheirOwnLibraries)
{
    EXPECT_EQ(joined(faultsOfLayers(texts)), "");
}

TEST_F(HouseTest, headersOfFacesIncludeNothingButFaces)
{
    EXPECT_EQ(joined(faultsOfFaces(texts, order)), "");
}

TEST_F(HouseTest, roomsAndFoldersAreOfReadableSize)
{
    EXPECT_EQ(joined(faultsOfSizes(texts)), "");
}

TEST_F(HouseTest, readmeIsALandingPage)
{
    EXPECT_LE(lineCount(fileText(fs::path(OSGGPUANIMATION_SOURCE_FOLDER) / "README.md")), maxReadmeLines);
}

/// The packages of a script that no other release of Debian has under that name: libdraco7, clang-14.
std::vector<std::string> packagesWithVersions(const std::string& script)
{
    const std::regex version(R"([\s(]((lib[a-z0-9.+-]*|[a-z+-]+-)[0-9]+(t64)?)(?=[\s)]))");
    std::vector<std::string> found;
    for (std::sregex_iterator match(script.begin(), script.end(), version), end; match != end; ++match)
        found.push_back((*match)[1]);
    return found;
}

TEST_F(HouseTest, setupNamesPackagesThatEveryDebianHas)
{
    const std::string setup = fileText(fs::path(OSGGPUANIMATION_SOURCE_FOLDER) / "tests/setup.sh");
    EXPECT_NE(setup.find("libdraco-dev"), std::string::npos) << "the check must have something to check";
    EXPECT_EQ(joined(packagesWithVersions(setup)), "");
}

// Each check is seen to fail on a planted fault.

TEST(PlantedPackageTest, versionsAreSeen)
{
    EXPECT_EQ(joined(packagesWithVersions("a=(g++ g++-12 libturbojpeg0-dev libdraco7\n libpng16-16t64 python3 file)")),
              "g++-12\nlibdraco7\nlibpng16-16t64\n");
}

const char plantedOrder[] = "# lowest first\n"
                            "osg_nodes/osgGpuAnimation/animation/math/Aabb3d\n"
                            "osg_nodes/osgGpuAnimation/animation/Clip\n"
                            "osg_nodes/osgGpuAnimation/nodes/AnimatedCharacter\n"
                            "plugin/gltf/Import\n";

struct Planted
{
    const char* path;
    const char* text;
    const char* fault; ///< part of the message; empty: none
};

class PlantedIncludeTest : public ::testing::TestWithParam<Planted>
{
};

TEST_P(PlantedIncludeTest, isSeen)
{
    const std::map<std::string, std::size_t> order = orderOf(plantedOrder);
    Texts texts;
    for (const auto& [room, place] : order)
        texts[room + ".h"];
    texts[GetParam().path] = GetParam().text;
    std::vector<std::string> faults = faultsOfOrder(texts, order);
    for (const std::vector<std::string>& more : {faultsOfFaces(texts, order), faultsOfLayers(texts)})
        faults.insert(faults.end(), more.begin(), more.end());
    if (*GetParam().fault == '\0')
        EXPECT_EQ(joined(faults), "");
    else
        EXPECT_NE(joined(faults).find(GetParam().fault), std::string::npos) << joined(faults);
}

INSTANTIATE_TEST_SUITE_P(
    Planted, PlantedIncludeTest,
    ::testing::Values(Planted{"osg_nodes/osgGpuAnimation/animation/math/Aabb3d.cpp",
                              "#include <osgGpuAnimation/animation/Clip.h>\n", "lies above it"},
                      Planted{"osg_nodes/osgGpuAnimation/animation/Clip.cpp",
                              "  #  include <osgGpuAnimation/nodes/AnimatedCharacter.h>\n", "lies above it"},
                      Planted{"osg_nodes/osgGpuAnimation/nodes/AnimatedCharacter.cpp", "#include \"gltf/Import.h\"\n",
                              "lies above it"},
                      Planted{"plugin/gltf/Import.cpp", "#include \"Other.h\"\n", "no room"},
                      Planted{"osg_nodes/osgGpuAnimation/animation/New.cpp", "", "is no room of the list"},
                      Planted{"osg_nodes/osgGpuAnimation/animation/Clip.h",
                              "#include <osgGpuAnimation/animation/math/Aabb3d.h>\n", "Clip.h includes"},
                      Planted{"osg_nodes/osgGpuAnimation/animation/Clip.cpp", "#include <osg/Vec3>\n",
                              "includes osg/Vec3"},
                      Planted{"osg_nodes/osgGpuAnimation/nodes/AnimatedCharacter.cpp", "#include <tiny_gltf.h>\n",
                              "includes tiny_gltf.h"},
                      Planted{"osg_nodes/osgGpuAnimation/animation/Clip.cpp",
                              "#include <osgGpuAnimation/animation/math/Aabb3d.h>\n#include <glm/vec3.hpp>\n", ""},
                      Planted{"plugin/gltf/Import.cpp", "#include <osgGpuAnimation/nodes/AnimatedCharacter.h>\n", ""}));

TEST(PlantedRoomTest, missingRoomIsSeen)
{
    EXPECT_EQ(faultsOfOrder({}, orderOf("plugin/gltf/Import\n")).size(), 1u);
}

TEST(PlantedRoomTest, sizesAreSeen)
{
    Texts texts;
    EXPECT_TRUE(faultsOfSizes(texts).empty());
    texts["plugin/Long.cpp"] = std::string(maxFileLines + 1, '\n');
    EXPECT_EQ(faultsOfSizes(texts).size(), 1u);
    texts.clear();
    for (std::size_t room = 0; room <= maxRoomsInFolder; ++room)
        texts["plugin/Room" + std::to_string(room) + ".h"] = "\n";
    EXPECT_EQ(faultsOfSizes(texts).size(), 1u);
    texts.clear();
    for (std::size_t room = 0; room <= maxShortSources; ++room)
        texts["plugin/" + std::to_string(room) + "/Room.cpp"] = "\n";
    EXPECT_EQ(faultsOfSizes(texts).size(), maxShortSources + 1);
}

} // namespace

} // namespace osgGpuAnimation
