// SPDX-License-Identifier: MIT
#include "gltf/import/Influences.h"

#include "gltf/data/Accessor.h"
#include "gltf/data/VertexAttributes.h"

#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <algorithm>
#include <cassert>

namespace osgGpuAnimation::gltf
{

namespace
{

constexpr std::size_t maxInfluences = 4 * SkinnedGeometry::maxInfluenceSets;

struct Influence
{
    std::uint32_t joint = 0; ///< place in the skin's joints
    float weight = 0.0f;
};

/// All influences of all vertices of the file's primitive.
struct FileInfluences
{
    std::size_t perVertex = 0;
    std::vector<Influence> influences; ///< perVertex a vertex

    Influence* of(std::size_t vertex) { return influences.data() + vertex * perVertex; }
};

FileInfluences readAll(const tinygltf::Model& model, const tinygltf::Primitive& primitive, std::size_t vertexCount)
{
    const std::size_t sets = influenceSetCount(primitive);
    FileInfluences result{4 * sets, std::vector<Influence>(4 * sets * vertexCount)};
    for (std::size_t set = 0; set < sets; ++set)
    {
        const std::string suffix = std::to_string(set);
        const std::vector<std::uint32_t> joints = readIntegers(model, primitive.attributes.at("JOINTS_" + suffix));
        const std::vector<float> weights = readFloats(model, primitive.attributes.at("WEIGHTS_" + suffix));
        for (std::size_t i = 0; i < 4 * vertexCount; ++i)
            result.of(i / 4)[4 * set + i % 4] = {joints[i], weights[i]};
    }
    return result;
}

/// Moves the largest influences to the front and scales them to the same sum. False if none was dropped.
bool reduce(Influence* influences, std::size_t count)
{
    const auto end = influences + count;
    const auto larger = [](const Influence& a, const Influence& b) { return a.weight > b.weight; };
    std::stable_sort(influences, end, larger);
    if (influences[maxInfluences].weight == 0.0f) return false;
    double all = 0.0, kept = 0.0;
    for (std::size_t i = 0; i < count; ++i)
    {
        all += influences[i].weight;
        if (i < maxInfluences) kept += influences[i].weight;
    }
    const double factor = all / kept;
    for (std::size_t i = 0; i < maxInfluences; ++i)
        influences[i].weight = static_cast<float>(influences[i].weight * factor);
    std::fill(influences + maxInfluences, end, Influence{});
    return true;
}

/// Reduces the vertices that have more influences than a SkinnedGeometry takes; returns how many.
std::size_t reduceAll(FileInfluences& file, std::size_t vertexCount)
{
    std::size_t reduced = 0;
    for (std::size_t vertex = 0; file.perVertex > maxInfluences && vertex < vertexCount; ++vertex)
        reduced += reduce(file.of(vertex), file.perVertex) ? 1 : 0;
    return reduced;
}

/// The number of sets up to the last one with a weight.
std::size_t usedSets(FileInfluences& file, std::size_t vertexCount)
{
    std::size_t used = 1;
    for (std::size_t vertex = 0; vertex < vertexCount; ++vertex)
    {
        for (std::size_t i = 4 * used; i < std::min(file.perVertex, maxInfluences); ++i)
        {
            if (file.of(vertex)[i].weight != 0.0f) used = i / 4 + 1;
        }
    }
    return used;
}

} // namespace

std::vector<InfluenceSet> readInfluences(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                         const MeshPrimitive& mesh, const AnimationSet& set, std::size_t skin,
                                         Report& report)
{
    FileInfluences file = readAll(model, primitive, mesh.vertexCount);
    if (const std::size_t reduced = reduceAll(file, mesh.vertexCount))
        report.warn(mesh.label + ": " + std::to_string(reduced) +
                    " vertices have more than 8 influences; the 8 largest are kept");
    std::vector<InfluenceSet> sets(usedSets(file, mesh.vertexCount));
    const bool isSame = mesh.sourceVertex.empty();
    const auto count = static_cast<unsigned int>(mesh.positions->size());
    for (std::size_t which = 0; which < sets.size(); ++which)
    {
        InfluenceSet& out = sets[which];
        out.entries = new osg::Vec4usArray(osg::Array::BIND_PER_VERTEX, count);
        out.weights = new osg::Vec4Array(osg::Array::BIND_PER_VERTEX, count);
        for (std::size_t vertex = 0; vertex < count; ++vertex)
        {
            const Influence* influences = file.of(isSame ? vertex : mesh.sourceVertex[vertex]) + 4 * which;
            for (unsigned int i = 0; i < 4; ++i)
            {
                assert(influences[i].joint < set.skins()[skin].joints.size() && "the validation checks joints");
                (*out.entries)[vertex][i] = static_cast<unsigned short>(set.entryOfSkin(skin, influences[i].joint));
                (*out.weights)[vertex][i] = influences[i].weight;
            }
        }
    }
    return sets;
}

} // namespace osgGpuAnimation::gltf
