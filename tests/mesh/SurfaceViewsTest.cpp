// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/authoring/mesh/SurfaceViews.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

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

SurfaceViews::Cell cellOf(std::size_t index)
{
    const auto across = static_cast<std::size_t>(SurfaceViews::cellsAcross);
    return {static_cast<int>(index % across), static_cast<int>(index / across)};
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
    const Triangles point = makeCube(0.0f);
    EXPECT_EQ(SurfaceViews(point.poses).coveredCells(point.surface(true)), 0u);
}

TEST(SurfaceViewsTest, eachViewShowsAnotherPose)
{
    for (const std::size_t poseCount : {std::size_t(1), std::size_t(4), SurfaceViews::poseCount + 5})
    {
        const SurfaceViews::Poses poses(poseCount, makeCube(2.0f).poses[0]);
        const SurfaceViews views(poses);
        std::set<std::size_t> shown;
        for (std::size_t view = 0; view < SurfaceViews::viewCount; ++view)
        {
            shown.insert(views.poseOf(view));
            SurfaceViews::Poses elsewhere(poseCount, std::vector<glm::vec3>(poses[0].size(), glm::vec3(1e6f)));
            elsewhere[views.poseOf(view)] = poses[0];
            EXPECT_LT(countsOf(views.seen(view, {elsewhere, makeCube(2.0f).indices, true}), 12)[12], 5000u) << view;
        }
        EXPECT_EQ(shown.size(), std::clamp(poseCount - 1, std::size_t(1), SurfaceViews::viewCount));
        EXPECT_EQ(shown.count(0), poseCount == 1) << "the first pose, if there is no other";
    }
}

TEST(SurfaceViewsTest, theNearestTriangleWinsAndOneSidedOnesAreNotVisibleFromBehind)
{
    for (const bool isNearestFirst : {false, true})
        for (const bool isTwoSided : {false, true})
        {
            SCOPED_TRACE(std::string(isNearestFirst ? "nearest first" : "") + (isTwoSided ? ", two-sided" : ""));
            Triangles squares;
            squares.addSquare({-1, -1, isNearestFirst ? 1 : 0}, isNearestFirst ? 1.0f : 2.0f);
            squares.addSquare({-1, -1, isNearestFirst ? 0 : 1}, isNearestFirst ? 2.0f : 1.0f);
            const SurfaceViews views(squares.poses);
            const std::size_t near = isNearestFirst ? 0 : 2, far = 2 - near;
            for (const float side : {1.0f, -1.0f})
            {
                const std::vector<Seen> cells =
                    views.seen(viewTowards(views, {0, 0, side}), squares.surface(isTwoSided));
                const std::vector<std::size_t> counts = countsOf(cells, 4);
                EXPECT_EQ(counts[near] + counts[near + 1], side > 0.0f ? 1600u : 0u);
                EXPECT_EQ(counts[far] + counts[far + 1], side > 0.0f ? 4800u : isTwoSided ? 6400u : 0u);
                for (const Seen& seen : cells)
                    EXPECT_TRUE(seen.triangle == Seen::none || seen.isFront == (side > 0.0f));
            }
            const std::size_t edge = viewTowards(views, {1, 0, 0});
            EXPECT_EQ(countsOf(views.seen(edge, squares.surface(isTwoSided)), 4)[4], cellsOfView);
        }
}

TEST(SurfaceViewsTest, theOutlineSurroundsWhatIsVisible)
{
    Triangles square;
    square.addSquare({0, 0, 0}, 1.0f);
    const SurfaceViews views(square.poses);
    const std::size_t view = viewTowards(views, {0, 0, 1});
    const std::vector<SurfaceViews::Cell> outline = SurfaceViews::outlineOf(views.seen(view, square.surface()));
    EXPECT_EQ(outline.size(), 4u * 79u);
    std::set<std::size_t> indices;
    for (const SurfaceViews::Cell& cell : outline)
        indices.insert(SurfaceViews::indexOf(cell));
    const glm::vec3 diagonal = views.wayBetween(view, cellOf(*indices.begin()), cellOf(*indices.rbegin()));
    EXPECT_LT(glm::distance(diagonal, glm::vec3(79.0f / 80.0f, 79.0f / 80.0f, 0.0f)), 1e-4f);
    EXPECT_TRUE(SurfaceViews::outlineOf(views.seen(viewTowards(views, {0, 0, -1}), square.surface())).empty());
}

} // namespace

} // namespace osgGpuAnimation
