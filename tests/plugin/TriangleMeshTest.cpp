// SPDX-License-Identifier: MIT
#include "gltf/scene/TriangleMesh.h"
#include "gltf/scene/Meshes.h"
#include "plugin/ModelBuilder.h"
#include "support/PeakMemory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <ctime>
#include <random>

namespace osgGpuAnimation::gltf
{

namespace
{

using Words = std::vector<std::uint32_t>;

VertexStream streamOf(const Words& words, std::size_t wordsAVertex)
{
    return {words.data(), 4 * wordsAVertex};
}

constexpr std::uint32_t murmur = 0x5bd1e995;

std::uint32_t mixed(std::uint32_t word)
{
    word *= murmur;
    return (word ^ word >> 24) * murmur;
}

/// The inverse of mixed().
std::uint32_t unmixed(std::uint32_t word)
{
    std::uint32_t inverse = murmur; // modulo 2^32, by Newton's iteration
    for (int i = 0; i < 5; ++i)
        inverse *= 2 - murmur * inverse;
    word *= inverse;
    return (word ^ word >> 24) * inverse;
}

/// Different positions with one value of MurmurHash2, meshoptimizer's hash.
Words positionsOfOneHash(std::size_t count)
{
    Words positions;
    for (std::uint32_t i = 0; positions.size() < 3 * count; ++i)
    {
        const float x = float(i);
        std::uint32_t words[3] = {0, 0x3f800000, 0};
        std::memcpy(&words[0], &x, 4);
        const std::uint32_t hash = (mixed(words[0]) * murmur) ^ mixed(words[1]);
        words[2] = unmixed(hash * murmur ^ 12345u);
        positions.insert(positions.end(), words, words + 3);
    }
    return positions;
}

using Triangle = std::array<std::uint32_t, 3>;

/// Each triangle starts with its smallest index and keeps its winding.
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

/// The number of vertices that miss a cache of the last 16.
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

/// The triangles of a square of quads, in random order.
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

/// The indices of a mesh whose material has that alpha mode, as imported.
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
    MemoryBudget budget(std::size_t(1) << 30);
    Report report(messages);
    MapsOfMaterials maps(file.model, true);
    Meshes meshes(file.model, maps, budget, report);
    osg::DrawElements* elements = meshes.primitive(0, 0)->primitiveSet->getDrawElements();
    std::vector<std::uint32_t> indices;
    for (unsigned int i = 0; i < elements->getNumIndices(); ++i)
        indices.push_back(elements->getElement(i));
    return indices;
}

} // namespace

TEST(TriangleMeshTest, verticesAreNumberedInTheirOrder)
{
    const Words positions{1, 1, 2, 2, 1, 1, 3, 3, 2, 2, 1, 1};
    const Words joints{7, 7, 7, 7, 7, 8};
    const WeldedVertices one = weldVertices({streamOf(positions, 2)}, 6);
    EXPECT_EQ(one.vertexOf, (Words{0, 1, 0, 2, 1, 0}));
    EXPECT_EQ(one.count, 3u);
    const WeldedVertices both = weldVertices({streamOf(positions, 2), streamOf(joints, 1)}, 6);
    EXPECT_EQ(both.vertexOf, (Words{0, 1, 0, 2, 1, 3}));
    EXPECT_EQ(both.count, 4u);
    EXPECT_EQ(weldVertices({}, 3).count, 1u);
    EXPECT_EQ(weldVertices({streamOf(positions, 2)}, 0).count, 0u);
}

TEST(TriangleMeshTest, verticesMadeForAHashTakeNoLonger)
{
    // With meshoptimizer's table 100,000 of them would take 20 seconds.
    constexpr std::size_t count = 500000;
    const Words positions = positionsOfOneHash(count);
    const std::clock_t start = std::clock();
    EXPECT_EQ(weldVertices({streamOf(positions, 3)}, count).count, count);
    EXPECT_LT(double(std::clock() - start) / CLOCKS_PER_SEC, mostSeconds);
}

TEST(TriangleMeshTest, theSameTrianglesWithTheirVerticesShadedOnce)
{
    const std::vector<std::uint32_t> before = shuffledGrid();
    std::vector<std::uint32_t> after = before;
    optimizeForVertexCache(after, gridSize * gridSize);
    EXPECT_EQ(sortedTriangles(after), sortedTriangles(before));
    EXPECT_GT(shadedVertices(before), 4u * gridSize * gridSize);
    EXPECT_LT(shadedVertices(after), 3u * gridSize * gridSize / 2);
}

TEST(TriangleMeshTest, trianglesThatAllMeetInOneVertexStayAsTheyAre)
{
    // Quadratic time would be minutes.
    std::vector<std::uint32_t> fan;
    constexpr std::uint32_t triangles = 600000;
    for (std::uint32_t i = 0; i < triangles; ++i)
        fan.insert(fan.end(), {0, i + 1, i + 2});
    std::vector<std::uint32_t> ordered = fan;
    optimizeForVertexCache(ordered, triangles + 2);
    EXPECT_EQ(ordered, fan);
}

TEST(TriangleMeshTest, nothingToDraw)
{
    std::vector<std::uint32_t> none;
    optimizeForVertexCache(none, 0);
    EXPECT_TRUE(none.empty());
}

TEST(TriangleMeshTest, readMeshesAreInOrderButWhatIsBlendedStaysAsTheFileHasIt)
{
    EXPECT_LT(shadedVertices(readGrid("OPAQUE")), 3u * gridSize * gridSize / 2);
    EXPECT_LT(shadedVertices(readGrid("MASK")), 3u * gridSize * gridSize / 2);
    EXPECT_EQ(readGrid("BLEND"), shuffledGrid());
}

} // namespace osgGpuAnimation::gltf
