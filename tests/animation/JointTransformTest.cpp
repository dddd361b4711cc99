// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/math/JointTransform.h>
#include <osgGpuAnimation/math/Rotation.h>

#include "support/ReferencePose.h"

#include <osgGpuAnimation/animation/keyframes/TrackBlend.h>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace osgGpuAnimation
{

namespace
{

glm::vec4 turnAboutZ(double radians)
{
    return glm::vec4(0.0, 0.0, std::sin(radians / 2), std::cos(radians / 2));
}

glm::vec4 slerp(const glm::vec4& a, const glm::vec4& b, float alpha)
{
    return glm::vec4(Rotation::slerp(glm::dvec4(a), glm::dvec4(b), static_cast<double>(alpha)));
}

TEST(JointTransformTest, SlerpTakesTheShorterWay)
{
    struct Case
    {
        const char* name;
        glm::vec4 a, b;
        float alpha;
        glm::vec4 expected;
    };
    const Case cases[] = {
        {"at the start", turnAboutZ(0.5), turnAboutZ(1.5), 0.0f, turnAboutZ(0.5)},
        {"at the end", turnAboutZ(0.5), turnAboutZ(1.5), 1.0f, turnAboutZ(1.5)},
        {"a third", turnAboutZ(0.0), turnAboutZ(1.5), 1.0f / 3, turnAboutZ(0.5)},
        {"signs opposite", turnAboutZ(0.0), -turnAboutZ(1.5), 0.5f, turnAboutZ(0.75)},
        {"more than half a turn goes back", turnAboutZ(0.0), turnAboutZ(5.0), 0.5f, turnAboutZ((5.0 - 2 * M_PI) / 2)},
        {"half a turn by its signs", {0, 0, 0, 1}, {0, 1, 0, 0}, 0.5f, {0, std::sqrt(0.5f), 0, std::sqrt(0.5f)}},
        {"the same", turnAboutZ(1.0), turnAboutZ(1.0), 0.7f, turnAboutZ(1.0)},
        {"next to the same", turnAboutZ(0.0), turnAboutZ(1e-6), 0.5f, turnAboutZ(5e-7)},
        {"not unit", turnAboutZ(0.0) * 3.0f, turnAboutZ(1.0) * 0.1f, 0.5f, turnAboutZ(0.5)},
        {"no direction counts as identity", {0, 0, 0, 0}, turnAboutZ(1.0), 0.5f, turnAboutZ(0.5)},
    };
    for (const Case& c : cases)
        EXPECT_LE(glm::length(slerp(c.a, c.b, c.alpha) - c.expected), 2e-7f) << c.name;
}

TEST(JointTransformTest, TheMatrixIsTranslationTimesRotationTimesScale)
{
    const JointTransform transform{{1, -2, 3, 0}, {0.1f, -0.5f, 0.7f, 2.0f}, {2, -0.5, 3, 0}};
    const glm::dmat4 expected =
        reference::localMatrix({1, -2, 3}, reference::normalized({0.1, -0.5, 0.7, 2.0}), {2, -0.5, 3});
    const glm::dmat4 actual = transform.toMatrix().toColumns();
    for (int c = 0; c < 4; ++c)
        EXPECT_LE(glm::length(actual[c] - expected[c]), 1e-6) << "column " << c;
}

TEST(JointTransformTest, AQuaternionWithoutDirectionMakesNoNaN)
{
    const float infinite = std::numeric_limits<float>::infinity();
    for (const glm::vec4& rotation : {glm::vec4(0.0f), glm::vec4(infinite), glm::vec4(NAN)})
    {
        const JointTransform transform{{1, 2, 3, 0}, rotation, {1, 1, 1, 0}};
        EXPECT_TRUE(transform.toMatrix().isFinite());
        EXPECT_EQ(transform.toMatrix().rows[0], glm::vec4(1, 0, 0, 1));
    }
}

TEST(JointTransformTest, AtZeroTheSecondRotationPlaysNoPart)
{
    const float largest = std::numeric_limits<float>::max();
    for (const glm::vec4& b : {glm::vec4(largest), glm::vec4(0.0f), glm::vec4(NAN), -turnAboutZ(1)})
        EXPECT_EQ(slerp(turnAboutZ(1), b, 0.0f), turnAboutZ(1));
}

TEST(JointTransformTest, InterpolatesEachPropertyItsOwnWay)
{
    const JointTransform a{{0, 0, 0, 0}, turnAboutZ(0), {1, 1, 1, 0}};
    const JointTransform b{{4, 8, -2, 0}, turnAboutZ(2), {3, 1, 5, 0}};
    const MixedTrack middle = MixedTrack::between({&a, &b, 0.25, false}, 0, false);
    EXPECT_EQ(middle.translation, glm::dvec4(1, 2, -0.5, 0));
    EXPECT_EQ(middle.scale, glm::dvec4(1.5, 1, 2, 0));
    EXPECT_LE(glm::length(glm::vec4(middle.rotation) - turnAboutZ(0.5)), 2e-7f);
}

} // namespace
} // namespace osgGpuAnimation
