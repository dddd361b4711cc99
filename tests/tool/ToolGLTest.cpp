// SPDX-License-Identifier: MIT
#include "support/GLTest.h"
#include "tool/ToolRuns.h"

#include <osg/Math>
#include <osg/Vec3d>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

using nlohmann::json;

class ToolGLTest : public ToolRuns<GLTest>
{
protected:
    osg::ref_ptr<osg::Image> pictureIn(const std::string& name) const
    {
        osg::ref_ptr<osg::Image> image = osgDB::readRefImageFile(folder.file(name));
        if (!image) throw std::runtime_error("there is no " + name);
        return image;
    }

    osg::ref_ptr<osg::Image> rendered(Arguments arguments, const char* size = "64x64") const
    {
        arguments.insert(arguments.begin(), "render");
        arguments.insert(arguments.end(), {"--size", size, "-o", folder.file("picture.png")});
        outputOf(arguments);
        return pictureIn("picture.png");
    }
};

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

/// Of the pixel; r, g or b, whichever exceeds the two others clearly, or none: '-'.
char colorOf(const osg::Image& image, int x, int y)
{
    const osg::Vec4 color = image.getColor(x, y);
    for (const int channel : {0, 1, 2})
        if (color[channel] > 1.5f * std::max(color[(channel + 1) % 3], color[(channel + 2) % 3])) return "rgb"[channel];
    return '-';
}

double largestDifference(const json& a, const json& b)
{
    double largest = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        largest = std::max(largest, std::abs(a[i].get<double>() - b[i].get<double>()));
    return largest;
}

} // namespace

TEST_F(ToolGLTest, poseOnTheGpuIsPoseOnTheCpu)
{
    json gpu = documentOf({"pose", "FLAG", "--time", "0.7", "--evaluator", "gpu"})["frames"][0];
    json cpu = documentOf({"pose", "FLAG", "--time", "0.7", "--evaluator", "cpu"})["frames"][0];
    for (std::size_t node = 0; node < 2; ++node)
        EXPECT_LE(largestDifference(gpu["nodes"][node], cpu["nodes"][node]), 1e-6) << "node " << node;
    EXPECT_LE(largestDifference(gpu["bbox"][1], cpu["bbox"][1]), 1e-6);
}

TEST_F(ToolGLTest, rendersTheFlagUprightAndRed)
{
    const osg::ref_ptr<osg::Image> image = rendered({"FLAG"}, "160x120");
    EXPECT_EQ(image->getPixelFormat(), GLenum(GL_RGB)); // what is blended leaves no holes
    EXPECT_EQ(image->s(), 160);
    EXPECT_EQ(image->t(), 120);
    EXPECT_LT(drawnPixels(*image), 160 * 120 * 9 / 10);
    int red = 0;
    for (int y = 0; y < image->t(); ++y)
        for (int x = 0; x < image->s(); ++x)
            red += colorOf(*image, x, y) == 'r';
    EXPECT_GT(red, 160 * 120 / 20);
    // osg::Image's first row is the lowest; the background is lighter above.
    EXPECT_GT(image->getColor(0, 119).r(), image->getColor(0, 0).r());
}

TEST_F(ToolGLTest, rendersThroughTheFilesCameras)
{
    const std::string filmed = folder.write("filmed.gltf", filmedFlag());
    const auto picture = [&](const char* camera, const char* time) {
        return rendered({filmed, "--camera", camera, "--time", time}, "80x60");
    };
    // Parallel, 8 units high: a unit is 7.5 pixels. The flag spans (-1, 0) to (1, 2), a quarter turn later (-2, -1) to
    // (0, 1).
    const osg::ref_ptr<osg::Image> upright = picture("plan", "0"), turned = picture("1", "1.999");
    for (const auto& [image, inside, outside] : {std::tuple(upright, osg::Vec2(0.8f, 1.8f), osg::Vec2(-1.5f, -0.5f)),
                                                 std::tuple(turned, osg::Vec2(-1.8f, -0.8f), osg::Vec2(0.5f, 1.5f))})
    {
        const auto pixel = [](float units, float middle) { return static_cast<int>(middle + 7.5f * units); };
        EXPECT_EQ(colorOf(*image, pixel(inside.x(), 40.0f), pixel(inside.y(), 30.0f)), 'r');
        EXPECT_EQ(colorOf(*image, pixel(outside.x(), 40.0f), pixel(outside.y(), 30.0f)), '-');
    }
    // The camera that turns with the flag sees it in the middle at all times.
    for (const char* time : {"0", "0.9", "1.9"})
    {
        const osg::ref_ptr<osg::Image> image = picture("film", time);
        EXPECT_TRUE(colorOf(*image, 33, 23) == 'r' && colorOf(*image, 47, 37) == 'r') << time;
        EXPECT_TRUE(colorOf(*image, 25, 30) == '-' && colorOf(*image, 40, 46) == '-') << time;
    }
}

TEST_F(ToolGLTest, theFilesLightsShineInTheLookFileAlone)
{
    json dark = json::parse(filmedFlag());
    dark["extensions"]["KHR_lights_punctual"]["lights"][0]["intensity"] = 0.0;
    const std::string lit = folder.write("lit.gltf", filmedFlag()), unlit = folder.write("dark.gltf", dark.dump());
    for (const std::string look : {"studio", "sun", "furnace", "file"})
        EXPECT_EQ(bytesOf(*rendered({lit, "--look", look})) == bytesOf(*rendered({unlit, "--look", look})),
                  look != "file")
            << look;
}

TEST_F(ToolGLTest, renderPrintsWarnings)
{
    json faulty = json::parse(swingingFlag());
    faulty["materials"] = json::parse(R"([{"emissiveTexture": {"index": 4}}])");
    const std::string file = folder.write("faulty.gltf", faulty.dump());
    const Process done = run({"render", file, "--look", "file", "--size", "8x8", "-o", folder.file("faulty.png")});
    EXPECT_EQ(done.status, 0);
    for (const char* warning : {"faulty.gltf: materials[0].emissiveTexture.index: expected an index below 0",
                                "faulty.gltf: the file has no lights"})
        EXPECT_NE(done.err.find(warning), std::string::npos) << done.err;
}

TEST_F(ToolGLTest, rendersInTheSurroundingsOfAPicture)
{
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
    const auto middleIn = [&](const std::string& environment) {
        return rendered({"FLAG", "--environment", environment})->getColor(32, 32);
    };
    const osg::Vec4 dark = middleIn(grey(90)), bright = middleIn(grey(188));
    EXPECT_GT(bright.r(), dark.r() + 0.2f);
    EXPECT_LT((bright - middleIn(folder.write("GREY.HDR", hdr))).length(), 0.02f);
}

/// A house whose front and back walls are the red flag; its left wall is green and its right wall is blue.
static std::string coloredHouse()
{
    json house = json::parse(swingingFlag());
    for (const auto& [color, side] : {std::pair(json{0, 0.8, 0, 1}, 1.0), std::pair(json{0, 0, 0.8, 1}, -1.0)})
    {
        json mesh = house["meshes"][0];
        mesh["primitives"][0]["material"] = house["materials"].size();
        house["nodes"].push_back({{"mesh", house["meshes"].size()},
                                  {"rotation", {0, std::sqrt(0.5), 0, std::sqrt(0.5)}},
                                  {"translation", {side, 1, 0}}});
        house["scenes"][0]["nodes"].push_back(house["nodes"].size() - 1);
        house["meshes"].push_back(mesh);
        house["materials"].push_back({{"pbrMetallicRoughness", {{"baseColorFactor", color}}}, {"doubleSided", true}});
    }
    return house.dump();
}

TEST_F(ToolGLTest, rendersFromADirectionAndAround)
{
    const std::string house = folder.write("house.gltf", coloredHouse());
    for (const auto& [view, color] : {std::pair("0,0", 'r'), std::pair("180,10", 'r'), std::pair("90,0", 'g'),
                                      std::pair("-90,20", 'b'), std::pair("270,10", 'b')})
        EXPECT_EQ(colorOf(*rendered({house, "--view", view}), 32, 32), color) << view;
    for (const char* view : {"0,90", "0,-90"}) // the flag stands upright
        EXPECT_LT(drawnPixels(*rendered({"FLAG", "--view", view})), 200) << view;
    outputOf({"render", house, "--view", "0,10", "--turntable", "4", "--size", "64x64", "-o", folder.file("turn.png")});
    const char sides[] = {'r', 'g', 'r', 'b'}; // the left side second
    for (int picture = 0; picture < 4; ++picture)
        EXPECT_EQ(colorOf(*pictureIn("turn.000" + std::to_string(picture + 1) + ".png"), 32, 32), sides[picture]);
    EXPECT_FALSE(std::filesystem::exists(folder.file("turn.0005.png")));
    EXPECT_FALSE(std::filesystem::exists(folder.file("turn.png")));
}

TEST_F(ToolGLTest, rendersNumberedPicturesThatMoveAndLoop)
{
    outputOf({"render", "FLAG", "--clip", "Swing", "--size", "64x64", "--frames", "5", "--fps", "2", "-o",
              folder.file("swing.png")});
    std::vector<std::string> pictures;
    for (int i = 1; i <= 5; ++i)
    {
        const osg::ref_ptr<osg::Image> image = pictureIn("swing.000" + std::to_string(i) + ".png");
        EXPECT_GT(drawnPixels(*image), 100);
        pictures.push_back(bytesOf(*image));
    }
    EXPECT_EQ(std::set<std::string>(pictures.begin(), pictures.end()).size(), 4u);
    EXPECT_EQ(pictures[4], pictures[0]) << "after 2 seconds";
    EXPECT_FALSE(std::filesystem::exists(folder.file("swing.png")));
    EXPECT_FALSE(std::filesystem::exists(folder.file("swing.0006.png")));
    const std::string expected = bytesOf(*rendered({"FLAG", "--clip", "Swing", "--time", "0.5"}));
    for (const char* time : {"-1.5", "4.5"})
        EXPECT_EQ(bytesOf(*rendered({"FLAG", "--clip", "Swing", "--time", time})), expected) << time;
}

TEST_F(ToolGLTest, rendersACrowdThatMoves)
{
    const osg::ref_ptr<osg::Image> first = rendered({flag + ".3x2.crowd", "--time", "0"}),
                                   second = rendered({flag + ".3x2.crowd", "--time", "0.3"});
    EXPECT_GT(drawnPixels(*first), 100);
    EXPECT_NE(bytesOf(*first), bytesOf(*second));
}

// `render --look file` against glTF's formulas in double: a white wall in the XY plane, seen from +Z.

namespace
{

using nlohmann::json;

constexpr double eyeDistance = 10.0; ///< of the camera from the wall
constexpr double seen = 3.0;         ///< half the side of what the picture shows of the wall
constexpr int side = 96;             ///< pixels
constexpr double surrounding = 0.05; ///< radiance, white

/// A light of the file. Its node stands at `place` and is turned about +X.
struct LightCase
{
    const char* name;
    const char* light; ///< as in KHR_lights_punctual
    osg::Vec3d place;
    double turn = 0.0;      ///< radians
    double roughness = 1.0; ///< the wall's
};

const LightCase cases[] = {
    {"Directional", R"({"type":"directional","intensity":2.0,"color":[1.0,0.5,0.25]})", {90, 0, 0}, -0.6},
    {"DirectionalAtADefault", R"({"type":"directional"})", {0, 0, 0}, 0.3},
    {"Point", R"({"type":"point","intensity":8.0})", {0.5, -0.5, 2.0}},
    {"PointWithRange", R"({"type":"point","intensity":8.0,"range":3.0})", {-0.5, 0.5, 2.0}},
    {"Spot",
     R"({"type":"spot","intensity":20.0,"spot":{"innerConeAngle":0.2,"outerConeAngle":0.6}})",
     {0.2, -1.5, 3.0},
     0.5},
    {"SpotAtItsDefaults", R"({"type":"spot","intensity":20.0,"color":[0.2,1.0,0.6],"spot":{}})", {0.0, 0.0, 3.0}},
    {"SpotWithRange",
     R"({"type":"spot","intensity":30.0,"range":4.0,"spot":{"innerConeAngle":0.5,"outerConeAngle":0.8}})",
     {0.5, 0.5, 3.0}},
    {"PointOnASmootherWall", R"({"type":"point","intensity":3.0})", {0.3, 0.2, 2.0}, 0.0, 0.4},
};

constexpr const char* secondLight =
    R"({"type":"spot","intensity":0.5,"color":[0.1,0.3,0.2],"range":7.0,"spot":{"outerConeAngle":0.4}})";

json fileOf(const LightCase& each)
{
    json file = json::parse(R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1,2]}],
        "nodes":[{"mesh":0},{"camera":0},{"children":[3],"extensions":{"KHR_lights_punctual":{"light":0}}},
                 {"extensions":{"KHR_lights_punctual":{"light":1}}}],
        "cameras":[{"name":"eye","type":"perspective","perspective":{"znear":0.1,"aspectRatio":1.0}}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1},"mode":5,"material":0}]}],
        "materials":[{"pbrMetallicRoughness":{"metallicFactor":0.0}}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[-5,-5,0],"max":[5,5,0]},
                     {"bufferView":1,"componentType":5126,"count":4,"type":"VEC3"}],
        "bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":48}],
        "buffers":[{"byteLength":96,"uri":"wall.bin"}],"extensionsUsed":["KHR_lights_punctual"]})");
    file["nodes"][1]["translation"] = {0.0, 0.0, eyeDistance};
    file["cameras"][0]["perspective"]["yfov"] = 2.0 * std::atan(seen / eyeDistance);
    file["nodes"][2]["translation"] = {each.place.x(), each.place.y(), each.place.z()};
    file["nodes"][2]["rotation"] = {std::sin(each.turn / 2.0), 0.0, 0.0, std::cos(each.turn / 2.0)};
    file["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = each.roughness;
    // And another one beside it, of its own number, cone and range.
    file["extensions"]["KHR_lights_punctual"]["lights"] = {json::parse(each.light), json::parse(secondLight)};
    return file;
}

/// What arrives of a light: the direction to it, and its illuminance in lux on a surface that faces it, without its
/// colour (KHR_lights_punctual).
struct Arriving
{
    osg::Vec3d toLight;
    double illuminance;
};

Arriving arriving(const LightCase& each, const json& light, const osg::Vec3d& point)
{
    const osg::Vec3d shinesTo(0.0, std::sin(each.turn), -std::cos(each.turn)); // -Z, turned
    const double intensity = light.value("intensity", 1.0);
    if (light["type"] == "directional") return {-shinesTo, intensity};
    osg::Vec3d way = each.place - point;
    const double distance = way.normalize();
    double share = 1.0;
    if (light.contains("range"))
        share = std::clamp(1.0 - std::pow(distance / light["range"].get<double>(), 4.0), 0.0, 1.0);
    if (light["type"] == "spot")
    {
        const json& cone = light["spot"];
        const double inner = std::cos(cone.value("innerConeAngle", 0.0));
        const double outer = std::cos(cone.value("outerConeAngle", osg::PI_4));
        const double along = std::clamp((-way * shinesTo - outer) / std::max(0.001, inner - outer), 0.0, 1.0);
        share *= along * along;
    }
    return {way, intensity * share / (distance * distance)};
}

/// The BRDF of a white dielectric (glTF 2.0, appendix B.3) times the cosine of the light.
double reflected(const osg::Vec3d& toLight, const osg::Vec3d& toEye, double roughness)
{
    const double cosLight = toLight.z(), cosEye = toEye.z();
    if (cosLight <= 0.0) return 0.0;
    osg::Vec3d halfway = toLight + toEye;
    halfway.normalize();
    const double alpha = roughness * roughness, squared = alpha * alpha;
    const double spread = halfway.z() * halfway.z() * (squared - 1.0) + 1.0;
    const double distribution = squared / (osg::PI * spread * spread);
    const double visibility = 0.5 / (cosLight * std::sqrt(cosEye * cosEye * (1.0 - squared) + squared) +
                                     cosEye * std::sqrt(cosLight * cosLight * (1.0 - squared) + squared));
    const double fresnel = 0.04 + 0.96 * std::pow(1.0 - toEye * halfway, 5.0);
    return cosLight * ((1.0 - fresnel) / osg::PI + fresnel * distribution * visibility);
}

/// sRGB (IEC 61966-2-1).
double encoded(double linear)
{
    const double clamped = std::clamp(linear, 0.0, 1.0);
    return clamped <= 0.0031308 ? 12.92 * clamped : 1.055 * std::pow(clamped, 1.0 / 2.4) - 0.055;
}

void PrintTo(const LightCase& each, std::ostream* out)
{
    *out << each.light;
}

class FileLightsGLTest : public ToolRuns<GLTest>, public ::testing::WithParamInterface<LightCase>
{
protected:
    osg::ref_ptr<osg::Image> rendered(const json& file) const
    {
        const float numbers[] = {-5, -5, 0, 5, -5, 0, -5, 5, 0, 5, 5, 0, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
        folder.write("wall.bin", std::string(reinterpret_cast<const char*>(numbers), sizeof numbers));
        const std::string picture = folder.file("wall.png"), size = std::to_string(side);
        outputOf({"render", folder.write("wall.gltf", file.dump()), "--look", "file", "--camera", "eye", "--size",
                  size + "x" + size, "-o", picture});
        return osgDB::readRefImageFile(picture);
    }
};

TEST_P(FileLightsGLTest, aWhiteWallHasTheRadianceOfTheFormula)
{
    const json file = fileOf(GetParam());
    const osg::ref_ptr<osg::Image> image = rendered(file);
    ASSERT_TRUE(image);
    double least = 1.0, most = 0.0, worst = 0.0;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
        {
            const osg::Vec3d point(seen * ((x + 0.5) * 2.0 / side - 1.0), seen * ((y + 0.5) * 2.0 / side - 1.0), 0.0);
            osg::Vec3d toEye = osg::Vec3d(0.0, 0.0, eyeDistance) - point,
                       radiance(surrounding, surrounding, surrounding);
            toEye.normalize();
            for (const json& light : file["extensions"]["KHR_lights_punctual"]["lights"])
            {
                const Arriving from = arriving(GetParam(), light, point);
                const std::vector<double> color = light.value("color", std::vector<double>{1.0, 1.0, 1.0});
                radiance += osg::Vec3d(color[0], color[1], color[2]) * from.illuminance *
                            reflected(from.toLight, toEye, GetParam().roughness);
            }
            const osg::Vec4 found = image->getColor(x, y);
            for (int channel = 0; channel < 3; ++channel)
            {
                const double expected = encoded(radiance[channel]);
                worst = std::max(worst, std::abs(expected - static_cast<double>(found[channel])));
                least = std::min(least, expected);
                most = std::max(most, expected);
            }
        }
    // Half a step of 8 bits, what the surrounding misses of white, and the antialiasing of a cone's edge.
    EXPECT_LE(worst, 1.5 / 255.0);
    EXPECT_LT(most, 1.0) << "the case must not be overexposed";
    EXPECT_GT(most, 0.5);
    EXPECT_GE(least, encoded(surrounding));
}

INSTANTIATE_TEST_SUITE_P(Lights, FileLightsGLTest, ::testing::ValuesIn(cases),
                         [](const auto& info) { return std::string(info.param.name); });

} // namespace

} // namespace osgGpuAnimation
