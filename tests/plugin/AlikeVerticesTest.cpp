// SPDX-License-Identifier: MIT
#include "gltf/AlikeVertices.h"
#include "support/PeakMemory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <ctime>

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

/// The word that is mixed into this.
std::uint32_t unmixed(std::uint32_t word)
{
    std::uint32_t inverse = murmur; // modulo 2^32, by Newton's iteration
    for (int i = 0; i < 5; ++i)
        inverse *= 2 - murmur * inverse;
    word *= inverse;
    return (word ^ word >> 24) * inverse;
}

/// Positions, all different, that MurmurHash2, meshoptimizer's, takes for the same.
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

} // namespace

TEST(AlikeVerticesTest, verticesAreNumberedInTheirOrder)
{
    const Words positions{1, 1, 2, 2, 1, 1, 3, 3, 2, 2, 1, 1};
    const Words joints{7, 7, 7, 7, 7, 8};
    const JoinedVertices one = joinAlike({streamOf(positions, 2)}, 6);
    EXPECT_EQ(one.vertexOf, (Words{0, 1, 0, 2, 1, 0}));
    EXPECT_EQ(one.count, 3u);
    const JoinedVertices both = joinAlike({streamOf(positions, 2), streamOf(joints, 1)}, 6);
    EXPECT_EQ(both.vertexOf, (Words{0, 1, 0, 2, 1, 3}));
    EXPECT_EQ(both.count, 4u);
    EXPECT_EQ(joinAlike({}, 3).count, 1u);
    EXPECT_EQ(joinAlike({streamOf(positions, 2)}, 0).count, 0u);
}

TEST(AlikeVerticesTest, verticesMadeForAHashTakeNoLonger)
{
    // With meshoptimizer's table 100,000 of them take 20 seconds.
    constexpr std::size_t count = 500000;
    const Words positions = positionsOfOneHash(count);
    const std::clock_t start = std::clock();
    EXPECT_EQ(joinAlike({streamOf(positions, 3)}, count).count, count);
    EXPECT_LT(double(std::clock() - start) / CLOCKS_PER_SEC, mostSeconds);
}

} // namespace osgGpuAnimation::gltf
