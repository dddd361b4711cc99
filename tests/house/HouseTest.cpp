// SPDX-License-Identifier: MIT
#include "house/FileText.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

// The house: which layer may include which, and how large rooms may be. A room is a header with its source. The order
// of the layers is the list in tests/house/layers.txt, lowest first. Within a layer, no rooms include each other in a
// circle.

namespace osgGpuAnimation
{

namespace
{

namespace fs = std::filesystem;

using Texts =
    std::map<std::string, std::string>; ///< by path below the repository's root, such as "plugin/gltf/Import.h"

constexpr std::size_t maxFileLines = 600;
constexpr std::size_t maxRoomLines = 650;
constexpr std::size_t minSourceLines = 30; ///< shorter sources belong to a neighbour's room, with few exceptions
constexpr std::size_t maxShortSources = 10;
constexpr std::size_t maxReadmeLines = 150;

/// Headers of other people that a folder must not include.
struct Libraries
{
    const char* folder;
    const char* forbidden;
};

const Libraries libraries[] = {
    {"osg_nodes/osgGpuAnimation/(math|animation|authoring)/",
     R"(^(osg|osg[A-Z]\w*|GL|EGL|OpenThreads|nlohmann)/|^tiny_gltf)"},
    {"osg_nodes/osgGpuAnimation/gpu/(?!without/)", R"(^tiny_gltf|^osg(Viewer|DB|GA)/)"},
    {"osg_nodes/osgGpuAnimation/(scene|looks|mesh|frame|nodes)/", R"(^tiny_gltf|^osgDB/)"},
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
std::string roomOfInclude(const std::string& include, const std::set<std::string>& rooms)
{
    for (const char* below : {"osg_nodes/", "plugin/"})
        if (const std::string room = below + roomOf(include); rooms.count(room) != 0) return room;
    return {};
}

std::set<std::string> roomsOf(const Texts& texts)
{
    std::set<std::string> rooms;
    for (const auto& [path, text] : texts)
        rooms.insert(roomOf(path));
    return rooms;
}

using Layers = std::vector<std::string>; ///< folders such as "plugin/gltf/", lowest first

Layers layersOf(const std::string& list)
{
    Layers layers;
    std::istringstream lines(list);
    for (std::string line; std::getline(lines, line);)
        if (!line.empty() && line[0] != '#') layers.push_back(line);
    return layers;
}

/// The number of the layer with the longest path; layers.size(): none.
std::size_t layerOf(const std::string& room, const Layers& layers)
{
    std::size_t found = layers.size();
    for (std::size_t i = 0; i < layers.size(); ++i)
        if (room.rfind(layers[i], 0) == 0 && (found == layers.size() || layers[i].size() > layers[found].size()))
            found = i;
    return found;
}

/// Includes of higher layers, quoted includes that name no room by its path, files below no layer, layers without a
/// file.
std::vector<std::string> faultsOfOrder(const Texts& texts, const Layers& layers)
{
    std::vector<std::string> faults;
    const std::set<std::string> rooms = roomsOf(texts);
    std::set<std::size_t> seen;
    for (const auto& [path, text] : texts)
    {
        const std::size_t own = layerOf(path, layers);
        if (own == layers.size()) faults.push_back(path + " is in no layer of the list");
        seen.insert(own);
        for (const std::string& include : includesOf(text))
        {
            const std::string other = roomOfInclude(include, rooms);
            if (!other.empty() && layerOf(other, layers) > own)
                faults.push_back(path + " includes " + other + ", which lies above it");
        }
        for (const std::string& include : includesOf(text, "\""))
            if (roomOfInclude(include, rooms).empty()) faults.push_back(path + " includes " + include + ", no room");
    }
    for (std::size_t layer = 0; layer < layers.size(); ++layer)
        if (seen.count(layer) == 0) faults.push_back(layers[layer] + " is on the list, but not in the tree");
    return faults;
}

/// The rooms that each room includes.
std::map<std::string, std::set<std::string>> includedRooms(const Texts& texts)
{
    const std::set<std::string> rooms = roomsOf(texts);
    std::map<std::string, std::set<std::string>> included;
    for (const auto& [path, text] : texts)
    {
        std::set<std::string>& others = included[roomOf(path)];
        for (const std::string& include : includesOf(text))
            if (const std::string other = roomOfInclude(include, rooms); !other.empty() && other != roomOf(path))
                others.insert(other);
    }
    return included;
}

/// One circle of rooms, if there is any.
std::vector<std::string> faultsOfCircles(const Texts& texts)
{
    std::map<std::string, std::set<std::string>> left = includedRooms(texts);
    const auto isLeft = [&](const std::string& room) { return left.count(room) != 0; };
    // Rooms that include no other room are taken away, then those that included only these, and so on.
    for (std::size_t before = 0; before != left.size();)
    {
        before = left.size();
        for (auto room = left.begin(); room != left.end();)
            room = std::any_of(room->second.begin(), room->second.end(), isLeft) ? std::next(room) : left.erase(room);
    }
    if (left.empty()) return {};
    // Each of the others includes one of them: following the includes ends in a circle.
    std::vector<std::string> way{left.begin()->first};
    while (std::count(way.begin(), way.end(), way.back()) == 1)
    {
        const std::set<std::string>& others = left.at(way.back());
        way.push_back(*std::find_if(others.begin(), others.end(), isLeft));
    }
    std::string circle = "a circle";
    for (auto room = std::find(way.begin(), way.end(), way.back()); room != way.end(); ++room)
        circle += (circle == "a circle" ? ": " : " includes ") + *room;
    return {circle};
}

bool isFace(const std::string& room)
{
    static const std::regex face(
        R"(^osg_nodes/osgGpuAnimation/((math|animation|authoring|gpu|scene|looks|mesh|frame|nodes)/)?\w+$)");
    return std::regex_match(room, face);
}

/// Headers of faces that include rooms which are not installed.
std::vector<std::string> faultsOfFaces(const Texts& texts)
{
    std::vector<std::string> faults;
    const std::set<std::string> rooms = roomsOf(texts);
    for (const auto& [path, text] : texts)
    {
        if (path.back() != 'h' || !isFace(roomOf(path))) continue;
        for (const std::string& include : includesOf(text))
        {
            const std::string other = roomOfInclude(include, rooms);
            const bool isPart = !other.empty() && !isFace(other);
            if (isPart || include == "layout.glsl") faults.push_back(path + " includes " + include);
        }
    }
    return faults;
}

std::vector<std::string> faultsOfLibraries(const Texts& texts)
{
    std::vector<std::string> faults;
    for (const auto& [path, text] : texts)
        for (const Libraries& those : libraries)
        {
            if (!std::regex_search(path, std::regex(std::string("^") + those.folder))) continue;
            const std::regex forbidden(those.forbidden);
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
    std::map<std::string, std::size_t> roomLines;
    std::vector<std::string> shortSources;
    for (const auto& [path, text] : texts)
    {
        const std::size_t lines = lineCount(text);
        roomLines[roomOf(path)] += lines;
        if (lines > maxFileLines) faults.push_back(path + " has " + std::to_string(lines) + " lines");
        if (path.back() == 'p' && lines < minSourceLines) shortSources.push_back(path);
    }
    for (const auto& [room, lines] : roomLines)
        if (lines > maxRoomLines) faults.push_back(room + " has " + std::to_string(lines) + " lines");
    if (shortSources.size() > maxShortSources)
        for (const std::string& path : shortSources)
            faults.push_back(path + " is one of " + std::to_string(shortSources.size()) + " short sources");
    return faults;
}

/// Every header and source of the kit and the plugins.
Texts readHouse()
{
    const fs::path root = sourceFolder();
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
    const Layers layers = layersOf(fileText(sourceFolder() / "tests/house/layers.txt"));
};

TEST_F(HouseTest, layersIncludeOnlyLowerLayers)
{
    EXPECT_GT(texts.size(), 100u) << "the check must have something to check";
    EXPECT_EQ(joined(faultsOfOrder(texts, layers)), "");
}

TEST_F(HouseTest, noRoomsIncludeEachOtherInACircle)
{
    EXPECT_EQ(joined(faultsOfCircles(texts)), "");
}

TEST_F(HouseTest, layersIncludeOnlyTheirOwnLibraries)
{
    EXPECT_EQ(joined(faultsOfLibraries(texts)), "");
}

TEST_F(HouseTest, headersOfFacesIncludeNothingButFaces)
{
    EXPECT_EQ(joined(faultsOfFaces(texts)), "");
}

TEST_F(HouseTest, roomsAreOfReadableSize)
{
    EXPECT_EQ(joined(faultsOfSizes(texts)), "");
}

TEST_F(HouseTest, readmeIsALandingPage)
{
    EXPECT_LE(lineCount(fileText(sourceFolder() / "README.md")), maxReadmeLines);
}

/// The packages of a script that no other release of Debian has under that name: libdraco7, clang-14.
std::vector<std::string> packagesWithVersions(const std::string& script)
{
    const std::regex version(R"([\s(]((lib[a-z0-9.+-]*|[a-z+-]+-)[0-9]+(t64)?)(?=[\s)]))");
    return matches(script, version);
}

TEST_F(HouseTest, setupNamesPackagesThatEveryDebianHas)
{
    const std::string setup = fileText(sourceFolder() / "tests/setup.sh");
    EXPECT_NE(setup.find("libdraco-dev"), std::string::npos) << "the check must have something to check";
    EXPECT_EQ(joined(packagesWithVersions(setup)), "");
}

// Each check is seen to fail on a planted fault.
TEST(PlantedPackageTest, versionsAreSeen)
{
    EXPECT_EQ(joined(packagesWithVersions("a=(g++ g++-12 libturbojpeg0-dev libdraco7\n libpng16-16t64 python3 file)")),
              "g++-12\nlibdraco7\nlibpng16-16t64\n");
}

const char plantedLayers[] = "# lowest first\n"
                             "osg_nodes/osgGpuAnimation/math/\n"
                             "osg_nodes/osgGpuAnimation/animation/\n"
                             "osg_nodes/osgGpuAnimation/authoring/\n"
                             "osg_nodes/osgGpuAnimation/gpu/\n"
                             "osg_nodes/osgGpuAnimation/nodes/\n"
                             "plugin/gltf/\n"
                             "plugin/\n";

/// Empty headers, at least one in each layer.
const char* const plantedHeaders[] = {"osg_nodes/osgGpuAnimation/math/Box.h",
                                      "osg_nodes/osgGpuAnimation/animation/Clip.h",
                                      "osg_nodes/osgGpuAnimation/animation/Pose.h",
                                      "osg_nodes/osgGpuAnimation/animation/bounds/MixBounds.h",
                                      "osg_nodes/osgGpuAnimation/authoring/ClipBuilder.h",
                                      "osg_nodes/osgGpuAnimation/gpu/PoseBatch.h",
                                      "osg_nodes/osgGpuAnimation/nodes/AnimatedCharacter.h",
                                      "plugin/gltf/Import.h",
                                      "plugin/ReaderWriterGltf.h"};

struct Planted
{
    const char* path;
    const char* text;
    const char* fault; ///< part of the message; empty: none
};

const Planted plantedIncludes[] = {
    {"osg_nodes/osgGpuAnimation/math/Box.cpp", "#include <osgGpuAnimation/animation/Clip.h>\n", "lies above it"},
    {"osg_nodes/osgGpuAnimation/animation/bounds/MixBounds.cpp", "#include <osgGpuAnimation/gpu/PoseBatch.h>\n",
     "lies above it"},
    {"osg_nodes/osgGpuAnimation/gpu/PoseBatch.cpp", "  #  include <osgGpuAnimation/nodes/AnimatedCharacter.h>\n",
     "lies above it"},
    {"osg_nodes/osgGpuAnimation/nodes/AnimatedCharacter.cpp", "#include \"gltf/Import.h\"\n", "lies above it"},
    {"plugin/gltf/Import.cpp", "#include \"ReaderWriterGltf.h\"\n", "lies above it"},
    {"plugin/gltf/Import.cpp", "#include \"Other.h\"\n", "no room"},
    {"osg_nodes/osgGpuAnimation/New.h", "\n", "is in no layer"},
    {"osg_nodes/osgGpuAnimation/animation/Clip.h", "#include <osgGpuAnimation/animation/bounds/MixBounds.h>\n",
     "Clip.h includes"},
    {"osg_nodes/osgGpuAnimation/math/Box.h", "#include <osg/Vec3>\n", "includes osg/Vec3"},
    {"osg_nodes/osgGpuAnimation/authoring/ClipBuilder.cpp", "#include <osg/Vec3>\n", "includes osg/Vec3"},
    {"osg_nodes/osgGpuAnimation/nodes/AnimatedCharacter.cpp", "#include <tiny_gltf.h>\n", "includes tiny_gltf.h"},
    {"osg_nodes/osgGpuAnimation/animation/Clip.cpp", "#include <osgGpuAnimation/math/Box.h>\n#include <glm/vec3.hpp>\n",
     ""},
    {"plugin/gltf/Import.cpp", "#include <osgGpuAnimation/nodes/AnimatedCharacter.h>\n", ""},
};

TEST(PlantedIncludeTest, isSeen)
{
    for (const Planted& planted : plantedIncludes)
    {
        Texts texts;
        for (const char* header : plantedHeaders)
            texts[header];
        texts[planted.path] = planted.text;
        const std::string faults = joined(faultsOfOrder(texts, layersOf(plantedLayers))) +
                                   joined(faultsOfCircles(texts)) + joined(faultsOfFaces(texts)) +
                                   joined(faultsOfLibraries(texts));
        EXPECT_NE(faults.find(planted.fault), std::string::npos) << planted.path << ": " << faults;
        EXPECT_EQ(faults.empty(), *planted.fault == '\0') << planted.path << ": " << faults;
    }
}

TEST(PlantedRoomTest, circlesAreSeen)
{
    Texts texts;
    texts["plugin/A.h"] = "#include \"B.h\"\n";
    texts["plugin/B.h"];
    texts["plugin/B.cpp"] = "#include \"B.h\"\n#include \"C.h\"\n";
    texts["plugin/C.h"];
    texts["plugin/0.cpp"] = "#include \"A.h\"\n"; // outside the circle
    EXPECT_TRUE(faultsOfCircles(texts).empty());
    texts["plugin/C.cpp"] = "#include \"A.h\"\n";
    EXPECT_EQ(joined(faultsOfCircles(texts)),
              "a circle: plugin/A includes plugin/B includes plugin/C includes plugin/A\n");
}

TEST(PlantedRoomTest, sizesAndEmptyLayersAreSeen)
{
    Texts texts;
    EXPECT_TRUE(faultsOfSizes(texts).empty());
    EXPECT_EQ(faultsOfOrder(texts, layersOf("plugin/gltf/\n")).size(), 1u) << "a layer without a file";
    texts["plugin/Long.cpp"] = std::string(maxFileLines + 1, '\n');
    EXPECT_EQ(faultsOfSizes(texts).size(), 1u);
    texts.clear();
    texts["plugin/Long.h"] = std::string(maxRoomLines / 2 + 1, '\n');
    EXPECT_TRUE(faultsOfSizes(texts).empty());
    texts["plugin/Long.cpp"] = std::string(maxRoomLines / 2, '\n');
    EXPECT_EQ(faultsOfSizes(texts).size(), 1u);
    texts.clear();
    for (std::size_t room = 0; room <= maxShortSources; ++room)
        texts["plugin/" + std::to_string(room) + "/Room.cpp"] = "\n";
    EXPECT_EQ(faultsOfSizes(texts).size(), maxShortSources + 1);
}

} // namespace

} // namespace osgGpuAnimation
