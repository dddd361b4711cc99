// SPDX-License-Identifier: MIT
#include "support/GLTest.h"
#include "tool/ToolRuns.h"

#include <osg/Math>
#include <osg/Vec3d>
#include <osgDB/ReadFile>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

// `render --look file` against glTF's formulas in double: a white wall in the XY plane, seen from +Z.

namespace osgGpuAnimation
{

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
