// SPDX-License-Identifier: MIT
#include "support/GLTest.h"
#include "support/Process.h"
#include "support/ScratchFolder.h"
#include "tool/SmallGltf.h"

#include <nlohmann/json.hpp>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{
namespace
{

using nlohmann::json;

class ToolGLTest : public GLTest
{
protected:
    ScratchFolder folder;
    std::string flag = folder.write("flag.gltf", swingingFlag());
};

osg::Vec4 colour(const osg::Image& image, unsigned int x, unsigned int y)
{
    return image.getColor(x, y);
}

/// The number of pixels that differ from the background, which has one colour per row.
int drawnPixels(const osg::Image& image)
{
    int count = 0;
    for (int y = 0; y < image.t(); ++y)
        for (int x = 0; x < image.s(); ++x)
            if ((image.getColor(x, y) - image.getColor(0, y)).length() > 0.05f) ++count;
    return count;
}

std::string bytesOf(const osg::Image& image)
{
    return {reinterpret_cast<const char*>(image.data()), image.getTotalSizeInBytes()};
}

double largestDifference(const json& a, const json& b)
{
    double largest = 0.0;
    for (std::size_t i = 0; i < 16; ++i)
        largest = std::max(largest, std::abs(a[i].get<double>() - b[i].get<double>()));
    return largest;
}

} // namespace

TEST_F(ToolGLTest, poseOnTheGpuIsPoseOnTheCpu)
{
    json poses[2];
    const char* const evaluators[] = {"gpu", "cpu"};
    for (int e = 0; e < 2; ++e)
    {
        const Process done = Process::run(OSGGPUANIM, {"pose", flag, "--time", "0.7", "--evaluator", evaluators[e]});
        ASSERT_EQ(done.status, 0) << done.err;
        poses[e] = json::parse(done.out)["frames"][0];
    }
    for (std::size_t node = 0; node < 2; ++node)
        EXPECT_LE(largestDifference(poses[0]["nodes"][node], poses[1]["nodes"][node]), 1e-6) << "node " << node;
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(poses[0]["bbox"][1][i].get<double>(), poses[1]["bbox"][1][i].get<double>(), 1e-6);
}

TEST_F(ToolGLTest, rendersTheFlagUprightAndRed)
{
    const std::string picture = folder.file("flag.png");
    const Process done = Process::run(OSGGPUANIM, {"render", flag, "--size", "160x120", "-o", picture});
    ASSERT_EQ(done.status, 0) << done.err;
    EXPECT_EQ(done.err, "");
    EXPECT_EQ(done.out.find("Keys of"), std::string::npos) << done.out;
    const osg::ref_ptr<osg::Image> image = osgDB::readRefImageFile(picture);
    ASSERT_TRUE(image);
    EXPECT_EQ(image->getPixelFormat(), GLenum(GL_RGB)); // what is blended leaves no holes
    EXPECT_EQ(image->s(), 160);
    EXPECT_EQ(image->t(), 120);
    EXPECT_GT(drawnPixels(*image), 160 * 120 / 20);
    EXPECT_LT(drawnPixels(*image), 160 * 120 * 9 / 10);
    int red = 0;
    for (int y = 0; y < image->t(); ++y)
        for (int x = 0; x < image->s(); ++x)
            if (colour(*image, x, y).r() > 2.0f * colour(*image, x, y).g()) ++red;
    EXPECT_GT(red, 160 * 120 / 20);
    // osg::Image's first row is the lowest; the background is lighter above.
    EXPECT_GT(colour(*image, 0, 119).r(), colour(*image, 0, 0).r());
}

/// The flag with a lamp and two cameras before it: one on the hinge, which follows it, one that stands still.
static std::string filmedFlag()
{
    json document = json::parse(swingingFlag());
    const auto add = [&](int parent, json node)
    {
        json& siblings =
            parent < 0 ? document["scenes"][0]["nodes"] : document["nodes"][std::size_t(parent)]["children"];
        siblings.push_back(document["nodes"].size());
        document["nodes"].push_back(std::move(node));
    };
    document["cameras"] = json::parse(R"([{"name":"film","type":"perspective","perspective":{"yfov":1,"znear":0.1}},
        {"name":"plan","type":"orthographic","orthographic":{"xmag":4,"ymag":4,"znear":0.1,"zfar":99}}])");
    document["extensionsUsed"] = {"KHR_lights_punctual"};
    document["extensions"]["KHR_lights_punctual"]["lights"] = json::parse(R"([{"name":"sun","type":"directional"}])");
    add(0, {{"camera", 0}, {"translation", {0, 1, 5}}});
    add(-1, {{"camera", 1}, {"translation", {0, 0, 5}}});
    add(-1, {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    return document.dump();
}

TEST_F(ToolGLTest, rendersThroughTheFilesCameras)
{
    const std::string filmed = folder.write("filmed.gltf", filmedFlag());
    const auto picture = [&](const char* camera, const char* time)
    {
        const std::string name = folder.file("seen.png");
        const Process done = Process::run(
            OSGGPUANIM, {"render", filmed, "--camera", camera, "--time", time, "--size", "80x60", "-o", name});
        EXPECT_EQ(done.status, 0) << done.err;
        return osgDB::readRefImageFile(name);
    };
    const auto isFlag = [](const osg::Image& image, unsigned int x, unsigned int y)
    { return colour(image, x, y).x() > 2.0f * colour(image, x, y).y(); };
    // Parallel, 8 units high: a unit is 7.5 pixels. The flag spans (-1, 0) to (1, 2), a quarter turn later (-2, -1) to
    // (0, 1).
    const osg::ref_ptr<osg::Image> upright = picture("plan", "0"), turned = picture("1", "1.999");
    for (const auto& [image, inside, outside] : {std::tuple(upright, osg::Vec2(0.8f, 1.8f), osg::Vec2(-1.5f, -0.5f)),
                                                 std::tuple(turned, osg::Vec2(-1.8f, -0.8f), osg::Vec2(0.5f, 1.5f))})
    {
        const auto pixel = [](float units, float middle) { return static_cast<unsigned int>(middle + 7.5f * units); };
        EXPECT_TRUE(isFlag(*image, pixel(inside.x(), 40.0f), pixel(inside.y(), 30.0f)));
        EXPECT_FALSE(isFlag(*image, pixel(outside.x(), 40.0f), pixel(outside.y(), 30.0f)));
    }
    // The camera that turns with the flag sees it in the middle at all times.
    for (const char* time : {"0", "0.9", "1.9"})
    {
        const osg::ref_ptr<osg::Image> image = picture("film", time);
        EXPECT_TRUE(isFlag(*image, 33, 23) && isFlag(*image, 47, 37)) << time;
        EXPECT_FALSE(isFlag(*image, 25, 30) || isFlag(*image, 40, 46)) << time;
    }
}

TEST_F(ToolGLTest, theFilesLightsShineInTheLookFileAlone)
{
    json dark = json::parse(filmedFlag());
    dark["extensions"]["KHR_lights_punctual"]["lights"][0]["intensity"] = 0.0;
    const std::string files[] = {folder.write("lit.gltf", filmedFlag()), folder.write("dark.gltf", dark.dump())};
    for (const char* look : {"studio", "sun", "furnace", "file"})
    {
        std::string bytes[2];
        for (int i = 0; i < 2; ++i)
        {
            const std::string picture = folder.file("look.png");
            const Process done =
                Process::run(OSGGPUANIM, {"render", files[i], "--look", look, "--size", "40x30", "-o", picture});
            ASSERT_EQ(done.status, 0) << done.err;
            EXPECT_EQ(done.err, "");
            const osg::ref_ptr<osg::Image> image = osgDB::readRefImageFile(picture);
            ASSERT_TRUE(image);
            bytes[i] = bytesOf(*image);
        }
        EXPECT_EQ(bytes[0] == bytes[1], look != std::string("file")) << look;
    }
    dark["extensions"].erase("KHR_lights_punctual");
    for (json& node : dark["nodes"])
        node.erase("extensions");
    const Process unlit = Process::run(OSGGPUANIM, {"render", folder.write("unlit.gltf", dark.dump()), "--look", "file",
                                                    "--size", "40x30", "-o", folder.file("unlit.png")});
    EXPECT_EQ(unlit.status, 0);
    EXPECT_NE(unlit.err.find("unlit.gltf: the file has no lights"), std::string::npos) << unlit.err;
}

TEST_F(ToolGLTest, renderPrintsTheFilesWarnings)
{
    json faulty = json::parse(filmedFlag());
    faulty["materials"] = json::parse(R"([{"emissiveTexture": {"index": 4}}])");
    const Process done = Process::run(OSGGPUANIM, {"render", folder.write("faulty.gltf", faulty.dump()), "--size",
                                                   "40x30", "-o", folder.file("faulty.png")});
    EXPECT_EQ(done.status, 0);
    EXPECT_NE(done.err.find("faulty.gltf: materials[0].emissiveTexture.index: expected an index below 0"),
              std::string::npos)
        << done.err;
}

TEST_F(ToolGLTest, inspectListsLightsAndCameras)
{
    const std::string filmed = folder.write("filmed.gltf", filmedFlag());
    const json report = json::parse(Process::run(OSGGPUANIM, {"inspect", filmed, "--json"}).out);
    EXPECT_EQ(report["lights"], json::parse(R"([{"index":0,"node":4,"number":7,"name":"sun","type":"directional"}])"));
    EXPECT_EQ(report["cameras"], json::parse(R"([{"index":0,"name":"film","node":2,"type":"perspective"},
                                                 {"index":1,"name":"plan","node":3,"type":"orthographic"}])"));
    const std::string text = Process::run(OSGGPUANIM, {"inspect", filmed}).out;
    for (const char* words : {"1: sun (directional, GL_LIGHT7)\n", "2: film (perspective), plan (orthographic)\n"})
        EXPECT_NE(text.find(words), std::string::npos) << text;
}

TEST_F(ToolGLTest, rendersInTheSurroundingsOfAPicture)
{
    const auto pictureIn = [this](const std::string& environment)
    {
        const std::string picture = folder.file("lit.png");
        const Process done =
            Process::run(OSGGPUANIM, {"render", flag, "--environment", environment, "--size", "40x30", "-o", picture});
        EXPECT_EQ(done.status, 0) << done.err;
        return osgDB::readRefImageFile(picture);
    };
    const auto grey = [this](unsigned char value) // sRGB
    {
        osg::ref_ptr<osg::Image> panorama = new osg::Image;
        panorama->allocateImage(8, 4, 1, GL_RGB, GL_UNSIGNED_BYTE, 1);
        std::fill_n(panorama->data(), panorama->getTotalSizeInBytes(), value);
        const std::string file = folder.file("grey.png");
        EXPECT_TRUE(osgDB::writeImageFile(*panorama, file));
        return file;
    };
    std::string hdr = "#?RADIANCE\n\n-Y 4 +X 8\n"; // radiance 0.5, which is 188 of sRGB
    for (int pixel = 0; pixel < 32; ++pixel)
        hdr += "\x80\x80\x80\x80";
    const osg::ref_ptr<osg::Image> dark = pictureIn(grey(90)), bright = pictureIn(grey(188));
    const osg::ref_ptr<osg::Image> radiance = pictureIn(folder.write("GREY.HDR", hdr));
    ASSERT_TRUE(dark && bright && radiance);
    EXPECT_GT(colour(*bright, 20, 15).r(), colour(*dark, 20, 15).r() + 0.2f);
    EXPECT_LT((colour(*bright, 20, 15) - colour(*radiance, 20, 15)).length(), 0.02f);
}

TEST_F(ToolGLTest, rendersFromADirectionAndAround)
{
    const auto pixelsOf = [this](const std::string& name)
    {
        const osg::ref_ptr<osg::Image> image = osgDB::readRefImageFile(folder.file(name));
        return image ? drawnPixels(*image) : -1;
    };
    const std::pair<const char*, bool> views[] = {{"0,0", true},     {"180,10", true}, {"90,0", false},
                                                  {"-90,20", false}, {"0,90", false},  {"0,-90", false}};
    for (const auto& [view, isWide] : views) // the flag stands upright and faces the front
    {
        const Process done = Process::run(
            OSGGPUANIM, {"render", flag, "--view", view, "--size", "64x64", "-o", folder.file("view.png")});
        ASSERT_EQ(done.status, 0) << done.err;
        EXPECT_EQ(pixelsOf("view.png") > 2000, isWide) << view << ' ' << pixelsOf("view.png");
        EXPECT_EQ(pixelsOf("view.png") < 200, !isWide) << view << ' ' << pixelsOf("view.png");
    }
    const Process around = Process::run(OSGGPUANIM, {"render", flag, "--view", "0,5", "--turntable", "4", "--size",
                                                     "64x64", "-o", folder.file("turn.png")});
    ASSERT_EQ(around.status, 0) << around.err;
    const int front = pixelsOf("turn.0001.png"), left = pixelsOf("turn.0002.png");
    EXPECT_GT(front, 1500);
    EXPECT_TRUE(left >= 0 && left < 200) << left;
    EXPECT_NEAR(pixelsOf("turn.0003.png"), front, 0.05 * front);
    EXPECT_NEAR(pixelsOf("turn.0004.png"), left, 64);
    EXPECT_FALSE(std::filesystem::exists(folder.file("turn.0005.png")));
    EXPECT_FALSE(std::filesystem::exists(folder.file("turn.png")));
}

/// A house whose left wall is green and whose right wall is blue.
static std::string colouredHouse()
{
    json house = json::parse(swingingFlag());
    for (const auto& [colour, side] : {std::pair(json{0, 0.8, 0, 1}, 1.0), std::pair(json{0, 0, 0.8, 1}, -1.0)})
    {
        json mesh = house["meshes"][0];
        mesh["primitives"][0]["material"] = house["materials"].size();
        house["nodes"].push_back({{"mesh", house["meshes"].size()},
                                  {"rotation", {0, std::sqrt(0.5), 0, std::sqrt(0.5)}},
                                  {"translation", {side, 1, 0}}});
        house["scenes"][0]["nodes"].push_back(house["nodes"].size() - 1);
        house["meshes"].push_back(mesh);
        house["materials"].push_back({{"pbrMetallicRoughness", {{"baseColorFactor", colour}}}, {"doubleSided", true}});
    }
    return house.dump();
}

TEST_F(ToolGLTest, theTurntableShowsTheLeftSideSecond)
{
    const std::string house = folder.write("house.gltf", colouredHouse());
    const Process around = Process::run(OSGGPUANIM, {"render", house, "--view", "0,10", "--turntable", "4", "--size",
                                                     "64x64", "-o", folder.file("turn.png")});
    ASSERT_EQ(around.status, 0) << around.err;
    const std::tuple<const char*, const char*, int> sides[] = {{"90,10", "turn.0002.png", 1},
                                                               {"270,10", "turn.0004.png", 2}};
    for (const auto& [view, turned, channel] : sides)
    {
        const Process seen = Process::run(
            OSGGPUANIM, {"render", house, "--view", view, "--size", "64x64", "-o", folder.file("view.png")});
        ASSERT_EQ(seen.status, 0) << seen.err;
        for (const std::string& name : {std::string("view.png"), std::string(turned)})
        {
            const osg::ref_ptr<osg::Image> image = osgDB::readRefImageFile(folder.file(name));
            ASSERT_TRUE(image);
            const osg::Vec4 middle = colour(*image, 32, 32);
            for (const int other : {0, 1, 2})
                EXPECT_TRUE(other == channel || middle[channel] > middle[other] + 0.2f) << view << ' ' << name;
        }
    }
}

TEST_F(ToolGLTest, rendersNumberedPicturesThatMove)
{
    const Process done = Process::run(OSGGPUANIM, {"render", flag, "--clip", "Swing", "--size", "64x64", "--frames",
                                                   "3", "--fps", "2", "-o", folder.file("swing.png")});
    ASSERT_EQ(done.status, 0) << done.err;
    osg::ref_ptr<osg::Image> pictures[3];
    for (int i = 0; i < 3; ++i)
    {
        pictures[i] = osgDB::readRefImageFile(folder.file("swing.000" + std::to_string(i + 1) + ".png"));
        ASSERT_TRUE(pictures[i]) << i;
        EXPECT_GT(drawnPixels(*pictures[i]), 100);
    }
    EXPECT_NE(bytesOf(*pictures[0]), bytesOf(*pictures[1]));
    EXPECT_FALSE(std::filesystem::exists(folder.file("swing.png")));
    EXPECT_FALSE(std::filesystem::exists(folder.file("swing.0004.png")));
}

TEST_F(ToolGLTest, timesOutsideTheClipLoopInPictures)
{
    std::vector<osg::ref_ptr<osg::Image>> pictures;
    for (const char* time : {"0.5", "-1.5", "4.5"}) // of a clip of 2 seconds
    {
        const std::string picture = folder.file("flag.png");
        const Process done = Process::run(
            OSGGPUANIM, {"render", flag, "--clip", "Swing", "--size", "64x64", "--time", time, "-o", picture});
        ASSERT_EQ(done.status, 0) << done.err;
        pictures.push_back(osgDB::readRefImageFile(picture));
        ASSERT_TRUE(pictures.back());
        EXPECT_GT(drawnPixels(*pictures.back()), 100);
        EXPECT_EQ(bytesOf(*pictures.back()), bytesOf(*pictures.front())) << time;
    }
}

TEST_F(ToolGLTest, rendersACrowdThatMoves)
{
    std::vector<osg::ref_ptr<osg::Image>> pictures;
    for (const char* time : {"0", "0.3"})
    {
        const std::string picture = folder.file(std::string("crowd") + time + ".png");
        const Process done =
            Process::run(OSGGPUANIM, {"render", flag + ".3x2.crowd", "--size", "96x64", "--time", time, "-o", picture});
        ASSERT_EQ(done.status, 0) << done.err;
        pictures.push_back(osgDB::readRefImageFile(picture));
        ASSERT_TRUE(pictures.back());
        EXPECT_GT(drawnPixels(*pictures.back()), 100);
    }
    EXPECT_NE(bytesOf(*pictures.front()), bytesOf(*pictures.back()));
}

} // namespace osgGpuAnimation
