// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/looks/shading/PunctualLight.h>

#include <gtest/gtest.h>
#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgGpuAnimation
{

namespace
{

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

osg::ref_ptr<PunctualLight> spot(float inner, float outer)
{
    osg::ref_ptr<PunctualLight> light = new PunctualLight(PunctualLight::Kind::Spot, 1);
    EXPECT_TRUE(light->setCone(inner, outer));
    return light;
}

/// The extension's falloff at that angle from the axis (degrees), from its text: the share between the two cones,
/// squared.
double falloff(double inner, double outer, double angle)
{
    const auto cosine = [](double degrees) { return std::cos(osg::DegreesToRadians(degrees)); };
    const double share = (cosine(angle) - cosine(outer)) / std::max(0.001, cosine(inner) - cosine(outer));
    return std::pow(std::clamp(share, 0.0, 1.0), 2.0);
}

} // namespace

TEST(PunctualLightTest, aConeFallsOffAsTheExtensionSaysAndTheFixedPipelinePassesTheSameLight)
{
    const std::pair<float, float> cones[] = {{0.0f, 45.0f}, {20.0f, 30.0f}, {29.0f, 30.0f}, {10.0f, 80.0f}};
    for (const auto& [inner, outer] : cones)
    {
        const osg::ref_ptr<PunctualLight> light = spot(inner, outer);
        const osg::Vec4 numbers = light->coneAndRange();
        double wanted = 0.0, passed = 0.0;
        const int steps = 20000;
        for (int step = 0; step < steps; ++step)
        {
            const double angle = (step + 0.5) * 90.0 / steps, along = std::cos(osg::DegreesToRadians(angle));
            const double cone = std::clamp(along * double(numbers.x()) + double(numbers.y()), 0.0, 1.0);
            ASSERT_NEAR(cone * cone, falloff(inner, outer, angle), 2e-4) << inner << " " << outer << " at " << angle;
            if (angle > double(outer)) continue;
            const double sine = std::sin(osg::DegreesToRadians(angle));
            wanted += falloff(inner, outer, angle) * sine;
            passed += std::pow(along, double(light->getSpotExponent())) * sine;
        }
        EXPECT_NEAR(passed / wanted, 1.0, 3e-3) << inner << " " << outer;
    }
    const osg::Vec4 sharp = spot(29.999f, 30.0f)->coneAndRange();
    EXPECT_TRUE(std::isfinite(sharp.x()) && sharp.x() <= 1001.0f) << sharp.x();
}

TEST(PunctualLightTest, aRangeIsItsInverseSquareAndAnIntensityIsDividedByPi)
{
    const osg::ref_ptr<PunctualLight> light = new PunctualLight(PunctualLight::Kind::Point, 3);
    EXPECT_EQ(light->coneAndRange(), osg::Vec4(0, 1, 0, 0));
    EXPECT_TRUE(light->setRange(4.0f));
    EXPECT_EQ(light->coneAndRange(), osg::Vec4(0, 1, 1.0f / 16.0f, 0));
    EXPECT_TRUE(light->setRange(1e-30f));
    EXPECT_TRUE(std::isfinite(light->coneAndRange().z()));
    EXPECT_TRUE(light->setIntensity(osg::Vec3(1.0f, 0.5f, 0.0f), 2.0f));
    const float radiance = 2.0f / static_cast<float>(osg::PI);
    EXPECT_NEAR((light->getDiffuse() - osg::Vec4(radiance, 0.5f * radiance, 0.0f, 1.0f)).length(), 0.0f, 1e-6f);
    EXPECT_EQ(light->getSpecular(), light->getDiffuse());
    EXPECT_EQ(light->getAmbient(), osg::Vec4(0, 0, 0, 1));
    EXPECT_EQ(light->getLightNum(), 3);
    EXPECT_EQ(light->getQuadraticAttenuation(), 1.0f);
    EXPECT_EQ(light->getConstantAttenuation(), 0.0f);
}

TEST(PunctualLightTest, valuesThatAreNoneAreRefusedAndChangeNothing)
{
    const osg::ref_ptr<PunctualLight> light = spot(10.0f, 20.0f);
    const osg::ref_ptr<PunctualLight> before = new PunctualLight(*light);
    const std::pair<float, float> cones[] = {{-1, 20}, {20, 20}, {30, 20}, {10, 90.1f}, {nan, 20}, {10, nan}};
    for (const auto& [inner, outer] : cones)
        EXPECT_FALSE(light->setCone(inner, outer)) << inner << " " << outer;
    for (const float range : {-1.0f, infinite, nan})
        EXPECT_FALSE(light->setRange(range)) << range;
    const std::pair<osg::Vec3, float> intensities[] = {{{1, 1, 1}, -1.0f}, {{1, 1, 1}, nan},    {{1, 1, 1}, infinite},
                                                       {{1, -1, 1}, 1.0f}, {{1, nan, 1}, 1.0f}, {{1e30f, 1, 1}, 1e30f}};
    for (const auto& [color, intensity] : intensities)
        EXPECT_FALSE(light->setIntensity(color, intensity)) << intensity;
    EXPECT_EQ(light->compare(*before), 0);
}

TEST(PunctualLightTest, copiesAreEqualUntilOneChanges)
{
    const osg::ref_ptr<PunctualLight> light = spot(10.0f, 20.0f);
    ASSERT_TRUE(light->setRange(5.0f));
    void (*const changes[])(PunctualLight&) = {
        [](PunctualLight&) {},
        [](PunctualLight& changed) { EXPECT_TRUE(changed.setRange(6.0f)); },
        [](PunctualLight& changed)
        {
            const float exponent = changed.getSpotExponent();
            EXPECT_TRUE(changed.setCone(11.0f, 20.0f));
            changed.setSpotExponent(exponent);
        },
    };
    for (const auto& change : changes)
    {
        const osg::ref_ptr<PunctualLight> changed = osg::clone(light.get(), osg::CopyOp::DEEP_COPY_ALL);
        change(*changed);
        EXPECT_EQ(changed->compare(*light) == 0, &change == changes);
        EXPECT_EQ(changed->compare(*light), -light->compare(*changed));
    }
    EXPECT_NE(light->compare(*osg::ref_ptr<osg::Light>(new osg::Light(1))), 0);
}

} // namespace osgGpuAnimation
