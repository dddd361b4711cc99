// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/math/JointTransform.h>

#include <gtest/gtest.h>

#include <limits>

namespace osgGpuAnimation
{

namespace
{

glm::dmat4 someColumns()
{
    return glm::dmat4(glm::dvec4(1, 2, 3, 0), glm::dvec4(-4, 5, 0.5, 0), glm::dvec4(0.25, 8, -9, 0),
                      glm::dvec4(10, 11, -12, 1));
}

TEST(AffineMatrixTest, KeepsTheUpperThreeRowsOfAColumnMajorMatrix)
{
    const AffineMatrix matrix = AffineMatrix::fromColumns(someColumns());
    EXPECT_EQ(matrix.rows[0], glm::vec4(1, -4, 0.25, 10));
    EXPECT_EQ(matrix.rows[2], glm::vec4(3, 0.5, -9, -12));
    EXPECT_EQ(matrix.toColumns(), someColumns());
}

TEST(AffineMatrixTest, TransformsPointsWithAndVectorsWithoutTheTranslation)
{
    const AffineMatrix matrix = AffineMatrix::fromColumns(someColumns());
    const glm::dvec4 point = someColumns() * glm::dvec4(1, -2, 3, 1);
    EXPECT_EQ(matrix.transformPoint({1, -2, 3}), glm::vec3(point));
    EXPECT_EQ(matrix.transformVector({1, -2, 3}), glm::vec3(point) - glm::vec3(10, 11, -12));
}

TEST(AffineMatrixTest, AProductAppliesTheRightFactorFirst)
{
    const AffineMatrix a = AffineMatrix::fromColumns(someColumns());
    AffineMatrix b;
    b.rows[0] = {0, 2, 0, 5};
    b.rows[1] = {1, 0, 0, -7};
    EXPECT_EQ((a * b).toColumns(), a.toColumns() * b.toColumns());
    EXPECT_EQ((a * b).transformPoint({1, 2, 3}), a.transformPoint(b.transformPoint({1, 2, 3})));
}

TEST(AffineMatrixTest, KnowsIdentityAndNumbersThatAreNone)
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

} // namespace
} // namespace osgGpuAnimation
