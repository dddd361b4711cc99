// SPDX-License-Identifier: MIT
#include "gltf/VertexCache.h"
#include "gltf/Meshes.h"
#include "plugin/ModelBuilder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

namespace osgGpuAnimation::gltf
{

namespace
{

using Triangle = std::array<std::uint32_t, 3>;

/// With the smallest corner first, in the same turn.
std::vector<Triangle> sortedTriangles(const std::vector<std::uint32_t>& indices)
{
    std::vector<Triangle> triangles;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
    {
        Triangle triangle{indices[i], indices[i + 1], indices[i + 2]};
        std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
        triangles.push_back(triangle);
    }
    std::sort(triangles.begin(), triangles.end());
    return triangles;
}

/// Vertices that a cache of the last 16 does not have.
std::size_t shadedVertices(const std::vector<std::uint32_t>& indices)
{
    std::vector<std::uint32_t> cache;
    std::size_t shaded = 0;
    for (const std::uint32_t index : indices)
    {
        if (std::find(cache.begin(), cache.end(), index) != cache.end()) continue;
        ++shaded;
        cache.push_back(index);
        if (cache.size() > 16) cache.erase(cache.begin());
    }
    return shaded;
}

constexpr std::uint32_t gridSize = 40;

/// The triangles of a square of quads, in no order.
std::vector<std::uint32_t> shuffledGrid()
{
    std::vector<Triangle> triangles;
    for (std::uint32_t y = 0; y + 1 < gridSize; ++y)
        for (std::uint32_t x = 0; x + 1 < gridSize; ++x)
        {
            const std::uint32_t corner = y * gridSize + x;
            triangles.push_back({corner, corner + 1, corner + gridSize});
            triangles.push_back({corner + 1, corner + gridSize + 1, corner + gridSize});
        }
    std::shuffle(triangles.begin(), triangles.end(), std::mt19937(7));
    std::vector<std::uint32_t> indices;
    for (const Triangle& triangle : triangles)
        indices.insert(indices.end(), triangle.begin(), triangle.end());
    return indices;
}

/// The indices of a mesh of that material's alpha mode, as they are read.
std::vector<std::uint32_t> readGrid(const std::string& alphaMode)
{
    ModelBuilder file;
    const std::vector<float> zeros(std::size_t(3) * gridSize * gridSize, 0.0f);
    const int positions = file.floats(TINYGLTF_TYPE_VEC3, zeros);
    const int accessor = file.integers(TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, shuffledGrid());
    const int mesh = file.mesh({{"POSITION", positions}, {"NORMAL", positions}}, TINYGLTF_MODE_TRIANGLES, accessor);
    tinygltf::Primitive& primitive = file.primitive(mesh);
    primitive.material = 0;
    file.model.materials.emplace_back();
    file.model.materials.back().alphaMode = alphaMode;
    Messages messages;
    DecodedBytes budget(std::size_t(1) << 30);
    Report report(messages);
    Meshes meshes(file.model, budget, report);
    osg::DrawElements* elements = meshes.primitive(0, 0)->primitiveSet->getDrawElements();
    std::vector<std::uint32_t> indices;
    for (unsigned int i = 0; i < elements->getNumIndices(); ++i)
        indices.push_back(elements->getElement(i));
    return indices;
}

} // namespace

TEST(VertexCacheTest, theSameTrianglesWithTheirVerticesShadedOnce)
{
    const std::vector<std::uint32_t> before = shuffledGrid();
    std::vector<std::uint32_t> after = before;
    optimizeForVertexCache(after, gridSize * gridSize);
    EXPECT_EQ(sortedTriangles(after), sortedTriangles(before));
    EXPECT_GT(shadedVertices(before), 4u * gridSize * gridSize);
    EXPECT_LT(shadedVertices(after), 3u * gridSize * gridSize / 2);
}

TEST(VertexCacheTest, trianglesThatAllMeetInOneVertexStayAsTheyAre)
{
    // By the square of them it would take minutes.
    std::vector<std::uint32_t> fan;
    constexpr std::uint32_t triangles = 600000;
    for (std::uint32_t i = 0; i < triangles; ++i)
        fan.insert(fan.end(), {0, i + 1, i + 2});
    std::vector<std::uint32_t> ordered = fan;
    optimizeForVertexCache(ordered, triangles + 2);
    EXPECT_EQ(ordered, fan);
}

TEST(VertexCacheTest, nothingToDraw)
{
    std::vector<std::uint32_t> none;
    optimizeForVertexCache(none, 0);
    EXPECT_TRUE(none.empty());
}

TEST(VertexCacheTest, readMeshesAreInOrderButWhatIsBlendedStaysAsTheFileHasIt)
{
    EXPECT_LT(shadedVertices(readGrid("OPAQUE")), 3u * gridSize * gridSize / 2);
    EXPECT_LT(shadedVertices(readGrid("MASK")), 3u * gridSize * gridSize / 2);
    EXPECT_EQ(readGrid("BLEND"), shuffledGrid());
}

} // namespace osgGpuAnimation::gltf
