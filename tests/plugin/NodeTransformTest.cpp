// SPDX-License-Identifier: MIT
#include "gltf/scene/NodeTransform.h"

#include <glm/ext/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace osgGpuAnimation::gltf
{

namespace
{

struct MatrixCase
{
    const char* name;
    glm::dmat4 matrix;
    bool shears;
};

const glm::dmat4 unit(1.0);
const glm::dmat4 turn = glm::rotate(unit, 1.1, glm::normalize(glm::dvec3(1, -2, 0.5)));
const glm::dmat4 place = glm::translate(unit, glm::dvec3(3, -4, 5));
const glm::dmat4 uneven = glm::scale(unit, glm::dvec3(2, 0.25, 1.5));

const MatrixCase cases[] = {
    {"nothing", glm::dmat4(1.0), false},
    {"translation", place, false},
    {"rotation", turn, false},
    {"half a turn", glm::rotate(unit, std::acos(-1.0), glm::dvec3(0, 1, 0)), false},
    {"all three", place* turn* uneven, false},
    {"mirrored", place* turn* glm::scale(unit, glm::dvec3(-1, 1, 1)), false},
    {"point reflection", glm::scale(unit, glm::dvec3(-1.0)), false},
    {"flat", turn* glm::scale(unit, glm::dvec3(1, 0, 2)), false},
    {"a line", turn* glm::scale(unit, glm::dvec3(0, 0, 2)), false},
    {"a point", place* glm::scale(unit, glm::dvec3(0.0)), false},
    {"scaled after turning", place* uneven* turn, true},
    {"mirrored and sheared", uneven* turn* glm::scale(unit, glm::dvec3(1, -1, 1)), true},
    {"shear", glm::dmat4(1, 0, 0, 0, 0.7, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1), true},
    {"sheared flat", glm::scale(unit, glm::dvec3(2, 1, 0)) * turn, true},
    {"tiny", glm::scale(unit, glm::dvec3(1e-6)) * turn, false},
    {"tiny and sheared", glm::scale(unit, glm::dvec3(1e-6, 2e-6, 1e-6)) * turn, true},
};

tinygltf::Node nodeOf(const glm::dmat4& matrix)
{
    tinygltf::Node node;
    for (int i = 0; i < 16; ++i)
        node.matrix.push_back(matrix[i / 4][i % 4]);
    return node;
}

/// Largest difference of an element, relative to the largest element of its kind.
double difference(const glm::dmat4& expected, const glm::dmat4& found)
{
    double linear = 1e-30, length = 1.0, worst = 0.0;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 3; ++row)
            (column < 3 ? linear : length) = std::max(column < 3 ? linear : length, std::abs(expected[column][row]));
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 3; ++row)
            worst =
                std::max(worst, std::abs(expected[column][row] - found[column][row]) / (column < 3 ? linear : length));
    return worst;
}

void expectSame(const MatrixCase& wanted)
{
    SCOPED_TRACE(wanted.name);
    const NodeTransform transform = decompose(nodeOf(wanted.matrix));
    EXPECT_EQ(transform.outer.has_value(), wanted.shears);
    glm::dmat4 product = transform.inner.toMatrix().toColumns();
    EXPECT_NEAR(glm::length(transform.inner.rotation), 1.0f, 1e-6f);
    if (transform.outer)
    {
        product = transform.outer->toMatrix().toColumns() * product;
        EXPECT_EQ(glm::vec3(transform.inner.translation), glm::vec3(0));
        EXPECT_EQ(glm::vec3(transform.inner.scale), glm::vec3(1));
    }
    EXPECT_LE(difference(wanted.matrix, product), 1e-6); // a few roundings to float
}

} // namespace

TEST(NodeTransformTest, aMatrixIsOneJointOrTwo)
{
    for (const MatrixCase& wanted : cases)
        expectSame(wanted);
}

TEST(NodeTransformTest, anyMatrixIsTheProductOfTwoJoints)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> number(-2.0, 2.0);
    for (int i = 0; i < 1000; ++i)
    {
        glm::dmat4 matrix(1.0);
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 3; ++row)
                matrix[column][row] = number(random);
        expectSame({"random", matrix, true});
    }
}

TEST(NodeTransformTest, rotationsAreMadeUnit)
{
    tinygltf::Node node;
    node.rotation = {0, 0, 10, 0};
    EXPECT_EQ(decompose(node).inner.rotation, glm::vec4(0, 0, 1, 0));
    node.rotation = {0, 0, 0, 0};
    EXPECT_EQ(decompose(node).inner.rotation, glm::vec4(0, 0, 0, 1));
    EXPECT_EQ(localMatrix(node), glm::dmat4(1.0));
}

TEST(NodeTransformTest, bothWaysOfOneNodeAgree)
{
    tinygltf::Node node;
    node.translation = {1, 2, 3};
    node.rotation = {0.1, -0.4, 0.2, 0.7};
    node.scale = {2, -1, 0.5};
    const NodeTransform transform = decompose(node);
    EXPECT_LE(difference(localMatrix(node), transform.inner.toMatrix().toColumns()), 1e-6);
    EXPECT_LE(difference(localMatrix(node), decompose(nodeOf(localMatrix(node))).inner.toMatrix().toColumns()), 1e-6);
}

} // namespace osgGpuAnimation::gltf
