// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/math/JointTransform.h>
#include <osgGpuAnimation/math/Result.h>
#include <osgGpuAnimation/math/Rotation.h>

#include "support/ReferencePose.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <string>

namespace osgGpuAnimation
{

namespace
{

glm::dmat4 someColumns()
{
    return glm::dmat4(glm::dvec4(1, 2, 3, 0), glm::dvec4(-4, 5, 0.5, 0), glm::dvec4(0.25, 8, -9, 0),
                      glm::dvec4(10, 11, -12, 1));
}

TEST(AffineMatrixTest, keepsTheUpperThreeRowsOfAColumnMajorMatrix)
{
    const AffineMatrix matrix = AffineMatrix::fromColumns(someColumns());
    EXPECT_EQ(matrix.rows[0], glm::vec4(1, -4, 0.25, 10));
    EXPECT_EQ(matrix.rows[2], glm::vec4(3, 0.5, -9, -12));
    EXPECT_EQ(matrix.toColumns(), someColumns());
}

TEST(AffineMatrixTest, transformsPointsWithAndVectorsWithoutTheTranslation)
{
    const AffineMatrix matrix = AffineMatrix::fromColumns(someColumns());
    const glm::dvec4 point = someColumns() * glm::dvec4(1, -2, 3, 1);
    EXPECT_EQ(matrix.transformPoint({1, -2, 3}), glm::vec3(point));
    EXPECT_EQ(matrix.transformVector({1, -2, 3}), glm::vec3(point) - glm::vec3(10, 11, -12));
}

TEST(AffineMatrixTest, aProductAppliesTheRightFactorFirst)
{
    const AffineMatrix a = AffineMatrix::fromColumns(someColumns());
    AffineMatrix b;
    b.rows[0] = {0, 2, 0, 5};
    b.rows[1] = {1, 0, 0, -7};
    EXPECT_EQ((a * b).toColumns(), a.toColumns() * b.toColumns());
    EXPECT_EQ((a * b).transformPoint({1, 2, 3}), a.transformPoint(b.transformPoint({1, 2, 3})));
}

TEST(AffineMatrixTest, knowsIdentityAndNumbersThatAreNone)
{
    AffineMatrix matrix;
    EXPECT_TRUE(matrix.isIdentity());
    EXPECT_TRUE(matrix.isFinite());
    matrix.rows[1].w = 1e-30f;
    EXPECT_FALSE(matrix.isIdentity());
    for (float bad : {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()})
    {
        matrix.rows[2].y = bad;
        EXPECT_FALSE(matrix.isFinite());
    }
}

glm::vec4 turnAboutZ(double radians)
{
    return glm::vec4(0.0, 0.0, std::sin(radians / 2), std::cos(radians / 2));
}

glm::vec4 slerp(const glm::vec4& a, const glm::vec4& b, float alpha)
{
    return glm::vec4(Rotation::slerp(glm::dvec4(a), glm::dvec4(b), static_cast<double>(alpha)));
}

TEST(JointTransformTest, slerpTakesTheShorterWay)
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
        {"more than half a turn goes back", turnAboutZ(0.0), turnAboutZ(5.0), 0.5f,
         turnAboutZ((5.0 - 2 * glm::pi<double>()) / 2)},
        {"half a turn by its signs", {0, 0, 0, 1}, {0, 1, 0, 0}, 0.5f, {0, std::sqrt(0.5f), 0, std::sqrt(0.5f)}},
        {"the same", turnAboutZ(1.0), turnAboutZ(1.0), 0.7f, turnAboutZ(1.0)},
        {"next to the same", turnAboutZ(0.0), turnAboutZ(1e-6), 0.5f, turnAboutZ(5e-7)},
        {"not unit", turnAboutZ(0.0) * 3.0f, turnAboutZ(1.0) * 0.1f, 0.5f, turnAboutZ(0.5)},
        {"no direction counts as identity", {0, 0, 0, 0}, turnAboutZ(1.0), 0.5f, turnAboutZ(0.5)},
    };
    for (const Case& c : cases)
        EXPECT_LE(glm::length(slerp(c.a, c.b, c.alpha) - c.expected), 2e-7f) << c.name;
}

TEST(JointTransformTest, theMatrixIsTranslationTimesRotationTimesScale)
{
    const JointTransform transform{{1, -2, 3, 0}, {0.1f, -0.5f, 0.7f, 2.0f}, {2, -0.5, 3, 0}};
    const glm::dmat4 expected =
        reference::localMatrix({1, -2, 3}, reference::normalized({0.1, -0.5, 0.7, 2.0}), {2, -0.5, 3});
    const glm::dmat4 actual = transform.toMatrix().toColumns();
    for (int c = 0; c < 4; ++c)
        EXPECT_LE(glm::length(actual[c] - expected[c]), 1e-6) << "column " << c;
}

TEST(JointTransformTest, aQuaternionWithoutDirectionMakesNoNaN)
{
    const float infinite = std::numeric_limits<float>::infinity();
    for (const glm::vec4& rotation : {glm::vec4(0.0f), glm::vec4(infinite), glm::vec4(NAN)})
    {
        const JointTransform transform{{1, 2, 3, 0}, rotation, {1, 1, 1, 0}};
        EXPECT_TRUE(transform.toMatrix().isFinite());
        EXPECT_EQ(transform.toMatrix().rows[0], glm::vec4(1, 0, 0, 1));
    }
}

TEST(JointTransformTest, atZeroTheSecondRotationPlaysNoPart)
{
    const float largest = std::numeric_limits<float>::max();
    for (const glm::vec4& b : {glm::vec4(largest), glm::vec4(0.0f), glm::vec4(NAN), -turnAboutZ(1)})
        EXPECT_EQ(slerp(turnAboutZ(1), b, 0.0f), turnAboutZ(1));
}

// In every kind of build: an error whose value is taken ends the program with its message.
TEST(ResultDeathTest, theValueOfAnErrorEndsTheProgramWithTheMessage)
{
    const Result<int> error = Error{"clip \"Fly\" is not there"};
    const std::string said = "value\\(\\) of a Result that holds the error: clip \"Fly\" is not there";
    EXPECT_DEATH((void)error.value(), said);
    EXPECT_DEATH((void)Result<std::unique_ptr<int>>(Error{error.error()}).value(), said);
    EXPECT_DEATH((void)Result<int>(7).error(), "error\\(\\) of a Result that holds a value");
    EXPECT_EQ(Result<int>(7).value(), 7);
    EXPECT_EQ(*Result<std::unique_ptr<int>>(std::make_unique<int>(8)).value(), 8);
}

} // namespace

} // namespace osgGpuAnimation
