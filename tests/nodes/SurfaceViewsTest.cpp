// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/authoring/mesh/SurfaceViews.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace osgGpuAnimation
{

namespace
{

using Seen = SurfaceViews::Seen;

constexpr std::size_t cellsOfView = SurfaceViews::cellsAcross * SurfaceViews::cellsAcross;

struct Triangles
{
    SurfaceViews::Poses poses{1};
    std::vector<std::uint32_t> indices;

    SurfaceViews::Surface surface(bool isTwoSided = false) const { return {poses, indices, isTwoSided}; }
    /// Faces the side from which it is counter-clockwise.
    void add(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c)
    {
        for (const glm::vec3& corner : {a, b, c})
        {
            indices.push_back(static_cast<std::uint32_t>(poses[0].size()));
            poses[0].push_back(corner);
        }
    }
    /// A square that faces +Z.
    void addSquare(const glm::vec3& lowerLeft, float side)
    {
        const glm::vec3 right(side, 0, 0), up(0, side, 0);
        add(lowerLeft, lowerLeft + right, lowerLeft + right + up);
        add(lowerLeft, lowerLeft + right + up, lowerLeft + up);
    }
    glm::vec3 at(const Seen& seen) const
    {
        glm::vec3 place(0.0f);
        for (int corner = 0; corner < 3; ++corner)
            place += seen.barycentric[corner] * poses[0][indices[3 * seen.triangle + std::size_t(corner)]];
        return place;
    }
};

/// A cube around the origin whose faces face outwards, two triangles each: -X, +X, -Y and so on.
Triangles makeCube(float side)
{
    Triangles cube;
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {-1.0f, 1.0f})
        {
            glm::vec3 out(0.0f), right(0.0f);
            out[axis] = right[(axis + 1) % 3] = 0.5f * side;
            out *= sign;
            const glm::vec3 up = glm::cross(out, right) / (0.5f * side);
            cube.add(out - right - up, out + right - up, out + right + up);
            cube.add(out - right - up, out + right + up, out - right + up);
        }
    return cube;
}

std::size_t viewTowards(const SurfaceViews& views, const glm::vec3& direction)
{
    for (std::size_t view = 0; view < SurfaceViews::viewCount; ++view)
        if (glm::distance(views.towards(view), glm::normalize(direction)) < 1e-5f) return view;
    ADD_FAILURE() << "no such view";
    return 0;
}

/// The cells by triangle; the last: none.
std::vector<std::size_t> countsOf(const std::vector<Seen>& cells, std::size_t triangleCount)
{
    EXPECT_EQ(cells.size(), cellsOfView);
    std::vector<std::size_t> counts(triangleCount + 1);
    for (const Seen& cell : cells)
        ++counts[cell.triangle == Seen::none ? triangleCount : cell.triangle];
    return counts;
}

TEST(SurfaceViewsTest, aCubeCoversSquaresAndRectangles)
{
    // A view is 1.2 times as wide as the surface: 80 of 96 cells. Between two axes a cube is sqrt(2) times as wide as
    // high.
    const double ofRectangle = 6400.0 / std::sqrt(2.0);
    const Triangles cube = makeCube(2.0f);
    const SurfaceViews views(cube.poses);
    std::size_t covered = 0;
    for (std::size_t view = 0; view < SurfaceViews::viewCount; ++view)
    {
        EXPECT_NEAR(glm::length(views.towards(view)), 1.0f, 1e-6f);
        const glm::vec3 along = glm::abs(views.towards(view));
        const bool isAlongAxis = std::max({along.x, along.y, along.z}) > 0.9f;
        std::size_t count = 0;
        for (const Seen& seen : views.seen(view, cube.surface()))
        {
            if (seen.triangle == Seen::none) continue;
            ++count;
            EXPECT_TRUE(seen.isFront);
            glm::vec3 out(0.0f);
            out[static_cast<int>(seen.triangle / 4)] = seen.triangle / 2 % 2 == 0 ? -1.0f : 1.0f;
            ASSERT_GT(glm::dot(out, views.towards(view)), 0.5f) << "view " << view << " of triangle " << seen.triangle;
        }
        EXPECT_NEAR(count, isAlongAxis ? 6400.0 : ofRectangle, isAlongAxis ? 0.0 : 0.01 * ofRectangle) << view;
        covered += count;
    }
    EXPECT_EQ(views.coveredCells(cube.surface()), covered);
    EXPECT_EQ(views.coveredCells(makeCube(6.0f).surface()), SurfaceViews::viewCount * cellsOfView)
        << "a surface beyond the grids is cut";
}

TEST(SurfaceViewsTest, eachViewShowsAnotherPose)
{
    for (const std::size_t poseCount : {std::size_t(1), std::size_t(2), std::size_t(4), SurfaceViews::poseCount + 5})
    {
        Triangles squares;
        squares.addSquare({0, 0, 0}, 1.0f);
        for (std::size_t pose = 1; pose < poseCount; ++pose)
        {
            const glm::vec3 aside(10.0f * static_cast<float>(pose), 0, 0);
            squares.poses.push_back(squares.poses.front());
            for (glm::vec3& position : squares.poses.back())
                position += aside;
        }
        const SurfaceViews views(squares.poses);
        std::set<std::size_t> shown;
        for (std::size_t view = 0; view < SurfaceViews::viewCount; ++view)
        {
            shown.insert(views.poseOf(view));
            if (std::abs(views.towards(view).z) < 0.1f) continue; // from its edge
            SurfaceViews::Poses elsewhere(poseCount, std::vector<glm::vec3>(6, glm::vec3(1e6f)));
            elsewhere[views.poseOf(view)] = squares.poses[views.poseOf(view)];
            const std::vector<Seen> cells = views.seen(view, {elsewhere, squares.indices, true});
            EXPECT_LT(countsOf(cells, 2)[2], cellsOfView) << "view " << view << " of " << poseCount << " poses";
        }
        const std::size_t others = std::min(poseCount - 1, SurfaceViews::viewCount);
        EXPECT_EQ(shown.size(), std::max(others, std::size_t(1)));
        EXPECT_EQ(shown.count(0), poseCount == 1) << "the first pose, if there is no other";
    }
}

TEST(SurfaceViewsTest, theNearestTriangleWins)
{
    for (const bool isNearestFirst : {false, true})
    {
        Triangles squares;
        const auto addNear = [&] { squares.addSquare({-1, -1, 1}, 1.0f); };
        if (isNearestFirst) addNear();
        squares.addSquare({-1, -1, 0}, 2.0f);
        if (!isNearestFirst) addNear();
        const SurfaceViews views(squares.poses);
        const std::size_t near = isNearestFirst ? 0 : 2, far = 2 - near;
        const std::vector<std::size_t> above =
            countsOf(views.seen(viewTowards(views, {0, 0, 1}), squares.surface(true)), 4);
        EXPECT_EQ(above[near] + above[near + 1], 1600u);
        EXPECT_EQ(above[far] + above[far + 1], 4800u);
        const std::vector<std::size_t> below =
            countsOf(views.seen(viewTowards(views, {0, 0, -1}), squares.surface(true)), 4);
        EXPECT_EQ(below[near] + below[near + 1], 0u);
        EXPECT_EQ(below[far] + below[far + 1], 6400u);
    }
}

TEST(SurfaceViewsTest, oneSidedTrianglesAreNotVisibleFromBehind)
{
    Triangles square;
    square.addSquare({0, 0, 0}, 1.0f);
    const SurfaceViews views(square.poses);
    for (const float side : {1.0f, -1.0f})
        for (const bool isTwoSided : {false, true})
        {
            std::size_t count = 0;
            for (const Seen& seen : views.seen(viewTowards(views, {0, 0, side}), square.surface(isTwoSided)))
            {
                if (seen.triangle == Seen::none) continue;
                ++count;
                EXPECT_EQ(seen.isFront, side > 0.0f);
            }
            EXPECT_EQ(count, side > 0.0f || isTwoSided ? 6400u : 0u) << side << (isTwoSided ? ", two-sided" : "");
        }
    EXPECT_EQ(countsOf(views.seen(viewTowards(views, {1, 0, 0}), square.surface(true)), 2)[2], cellsOfView)
        << "from its edge";
}

TEST(SurfaceViewsTest, barycentricCoordinatesAreThoseOfTheCellsCentres)
{
    Triangles triangle;
    triangle.add({0, 0, 1}, {3, 0.5f, 0}, {0.5f, 2, -1});
    const SurfaceViews views(triangle.poses);
    for (const glm::vec3& direction : {glm::vec3(0, 0, 1), glm::vec3(1, 1, 0), glm::vec3(0, 1, 1)})
    {
        const std::size_t view = viewTowards(views, direction);
        const glm::vec3 towards = views.towards(view);
        const std::vector<Seen> cells = views.seen(view, triangle.surface(true));
        // Between all cells of a row the same step to the right, between rows the same step up.
        glm::vec3 steps[2] = {};
        std::size_t pairs = 0;
        for (std::size_t cell = 0; cell + SurfaceViews::cellsAcross < cells.size(); ++cell)
            for (const int upwards : {0, 1})
            {
                const Seen& here = cells[cell];
                const Seen& next = cells[cell + (upwards ? SurfaceViews::cellsAcross : 1)];
                if (here.triangle == Seen::none || next.triangle == Seen::none) continue;
                EXPECT_NEAR(here.barycentric.x + here.barycentric.y + here.barycentric.z, 1.0f, 1e-5f);
                EXPECT_GE(std::min({here.barycentric.x, here.barycentric.y, here.barycentric.z}), 0.0f);
                const glm::vec3 way = triangle.at(next) - triangle.at(here);
                const glm::vec3 step = way - glm::dot(way, towards) * towards;
                if (steps[upwards] == glm::vec3(0.0f)) steps[upwards] = step;
                EXPECT_LT(glm::distance(step, steps[upwards]), 1e-4f * glm::length(step) + 1e-5f);
                ++pairs;
            }
        EXPECT_GT(pairs, 1000u);
        EXPECT_NEAR(glm::length(steps[0]), glm::length(steps[1]), 1e-5f);
        EXPECT_NEAR(glm::dot(glm::cross(steps[0], steps[1]), towards), glm::dot(steps[0], steps[0]), 1e-5f)
            << "a square whose up is to the left of its right";
    }
}

TEST(SurfaceViewsTest, theOutlineSurroundsWhatIsVisible)
{
    Triangles square;
    square.addSquare({0, 0, 0}, 1.0f);
    const SurfaceViews views(square.poses);
    const std::size_t view = viewTowards(views, {0, 0, 1});
    const std::vector<SurfaceViews::Cell> outline = SurfaceViews::outlineOf(views.seen(view, square.surface()));
    ASSERT_EQ(outline.size(), 4u * 79u);
    const auto [least, most] = std::minmax_element(outline.begin(), outline.end(),
                                                   [](const SurfaceViews::Cell& a, const SurfaceViews::Cell& b)
                                                   { return SurfaceViews::indexOf(a) < SurfaceViews::indexOf(b); });
    const glm::vec3 diagonal = views.wayBetween(view, *least, *most);
    EXPECT_LT(glm::distance(diagonal, glm::vec3(79.0f / 80.0f, 79.0f / 80.0f, 0.0f)), 1e-4f);
    EXPECT_TRUE(SurfaceViews::outlineOf(views.seen(viewTowards(views, {0, 0, -1}), square.surface())).empty());
}

TEST(SurfaceViewsTest, aSurfaceInOnePointCoversNothing)
{
    Triangles point;
    point.add({1, 2, 3}, {1, 2, 3}, {1, 2, 3});
    EXPECT_EQ(SurfaceViews(point.poses).coveredCells(point.surface(true)), 0u);
}

} // namespace

} // namespace osgGpuAnimation
