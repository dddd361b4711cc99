// SPDX-License-Identifier: MIT
#include "gltf/import/Influences.h"

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

} // namespace

std::vector<InfluenceSet> readInfluences(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                         const MeshPrimitive& mesh, const AnimationSet& set, std::size_t skin,
                                         Report& report)
{
    const std::vector<FileInfluences> file = readFileInfluences(model, primitive);
    const std::size_t perVertex = 4 * file.size();
    std::vector<Influence> all(perVertex * mesh.vertexCount);
    std::size_t reduced = 0, used = 1; // vertices, and sets up to the last one with a weight
    for (std::size_t vertex = 0; vertex < mesh.vertexCount; ++vertex)
    {
        Influence* const own = all.data() + vertex * perVertex;
        for (std::size_t i = 0; i < perVertex; ++i)
            own[i] = {file[i / 4].joints[4 * vertex + i % 4], file[i / 4].weights[4 * vertex + i % 4]};
        if (perVertex > maxInfluences && reduce(own, perVertex)) ++reduced;
        for (std::size_t i = 4 * used; i < std::min(perVertex, maxInfluences); ++i)
            if (own[i].weight != 0.0f) used = i / 4 + 1;
    }
    if (reduced > 0)
        report.warn(mesh.label + ": " + std::to_string(reduced) +
                    " vertices have more than 8 influences; the 8 largest are kept");
    std::vector<InfluenceSet> sets(used);
    const bool isSame = mesh.sourceVertex.empty();
    const auto count = static_cast<unsigned int>(mesh.positions->size());
    for (std::size_t which = 0; which < sets.size(); ++which)
    {
        InfluenceSet& out = sets[which];
        out.entries = new osg::Vec4usArray(osg::Array::BIND_PER_VERTEX, count);
        out.weights = new osg::Vec4Array(osg::Array::BIND_PER_VERTEX, count);
        for (std::size_t vertex = 0; vertex < count; ++vertex)
        {
            const Influence* const influences =
                all.data() + (isSame ? vertex : mesh.sourceVertex[vertex]) * perVertex + 4 * which;
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
