// SPDX-License-Identifier: MIT
#include "gltf/AlikeVertices.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <random>
#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

const unsigned char* at(const VertexStream& stream, std::size_t vertex)
{
    return static_cast<const unsigned char*>(stream.data) + vertex * stream.bytesAVertex;
}

/// The sums of each vertex's words times random numbers, one for each place of a word: who does not know those cannot
/// say which vertices have the same sum.
std::vector<std::uint64_t> hashes(const std::vector<VertexStream>& streams, std::size_t vertexCount)
{
    std::random_device device;
    std::seed_seq seed{device(), device(), device(), device()};
    std::mt19937_64 random(seed);
    std::vector<std::uint64_t> sums(vertexCount);
    for (const VertexStream& stream : streams)
    {
        assert(stream.bytesAVertex % 4 == 0 && "vertices are made of words");
        for (std::size_t place = 0; place < stream.bytesAVertex; place += 4)
        {
            const std::uint64_t factor = random() | 1;
            for (std::size_t vertex = 0; vertex < vertexCount; ++vertex)
            {
                std::uint32_t word;
                std::memcpy(&word, at(stream, vertex) + place, sizeof(word));
                sums[vertex] += factor * word;
            }
        }
    }
    return sums;
}

bool areAlike(const std::vector<VertexStream>& streams, std::size_t a, std::size_t b)
{
    return std::all_of(streams.begin(), streams.end(),
                       [=](const VertexStream& stream)
                       { return std::memcmp(at(stream, a), at(stream, b), stream.bytesAVertex) == 0; });
}

/// For each vertex the first one that is like it.
std::vector<std::uint32_t> firstAlike(const std::vector<VertexStream>& streams, std::size_t vertexCount)
{
    const std::vector<std::uint64_t> sums = hashes(streams, vertexCount);
    std::vector<std::pair<std::uint64_t, std::uint32_t>> sorted(vertexCount);
    for (std::size_t vertex = 0; vertex < vertexCount; ++vertex)
        sorted[vertex] = {sums[vertex], static_cast<std::uint32_t>(vertex)};
    std::sort(sorted.begin(), sorted.end());
    std::vector<std::uint32_t> first(vertexCount);
    std::vector<std::uint32_t> different; // vertices of one hash: with a chance of billions to one just one
    for (std::size_t i = 0; i < vertexCount; ++i)
    {
        const std::uint32_t vertex = sorted[i].second;
        if (i == 0 || sorted[i].first != sorted[i - 1].first) different.clear();
        const auto like = std::find_if(different.begin(), different.end(),
                                       [&](std::uint32_t other) { return areAlike(streams, vertex, other); });
        first[vertex] = like != different.end() ? *like : vertex;
        if (like == different.end()) different.push_back(vertex);
    }
    return first;
}

} // namespace

JoinedVertices joinAlike(const std::vector<VertexStream>& streams, std::size_t vertexCount)
{
    JoinedVertices joined{firstAlike(streams, vertexCount), 0};
    for (std::size_t vertex = 0; vertex < vertexCount; ++vertex)
    {
        const std::uint32_t first = joined.vertexOf[vertex];
        joined.vertexOf[vertex] = first == vertex ? static_cast<std::uint32_t>(joined.count++) : joined.vertexOf[first];
    }
    return joined;
}

} // namespace osgGpuAnimation::gltf
