// SPDX-License-Identifier: MIT
#include "gltf/Influences.h"

#include "gltf/Accessor.h"

#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace osgGpuAnimation::gltf
{

namespace
{

constexpr std::size_t most = 4 * SkinnedGeometry::maxInfluenceSets;

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
        const std::size_t count = std::min({joints.size() / 4, weights.size() / 4, vertexCount});
        for (std::size_t i = 0; i < 4 * count; ++i)
            result.of(i / 4)[4 * set + i % 4] = {joints[i], weights[i]};
    }
    return result;
}

/// Keeps the largest influences in front, scaled so that their sum stays. False where there was nothing to drop.
bool reduce(Influence* influences, std::size_t count)
{
    const auto end = influences + count;
    const auto larger = [](const Influence& a, const Influence& b) { return std::abs(a.weight) > std::abs(b.weight); };
    std::stable_sort(influences, end, larger);
    if (influences[most].weight == 0.0f) return false;
    double all = 0.0, kept = 0.0;
    for (std::size_t i = 0; i < count; ++i)
    {
        all += influences[i].weight;
        if (i < most) kept += influences[i].weight;
    }
    const double factor = std::abs(kept) > 1e-30 ? all / kept : 1.0;
    for (std::size_t i = 0; i < most; ++i)
        influences[i].weight = static_cast<float>(influences[i].weight * factor);
    std::fill(influences + most, end, Influence{});
    return true;
}

/// What had to be mended, in vertices.
struct Mended
{
    std::size_t unknownJoint = 0;
    std::size_t reduced = 0;
    std::size_t unmoved = 0;

    void report(const std::string& label, Report& report) const
    {
        const auto warn = [&](std::size_t count, const char* what)
        {
            if (count > 0) report.warn(label + ": " + std::to_string(count) + " vertices " + what);
        };
        warn(unknownJoint, "name a joint that the skin does not have; its weight is dropped");
        warn(reduced, "have more than 8 influences; the 8 largest are kept");
        warn(unmoved, "have no weight at all; they follow the first joint they name");
    }
};

Mended mend(FileInfluences& file, std::size_t vertexCount, std::size_t jointCount)
{
    Mended mended;
    for (std::size_t vertex = 0; vertex < vertexCount; ++vertex)
    {
        Influence* influences = file.of(vertex);
        bool unknown = false;
        bool moved = false;
        for (std::size_t i = 0; i < file.perVertex; ++i)
        {
            if (influences[i].joint >= jointCount)
            {
                unknown = unknown || influences[i].weight != 0.0f;
                influences[i] = {};
            }
            moved = moved || influences[i].weight != 0.0f;
        }
        if (file.perVertex > most && reduce(influences, file.perVertex)) ++mended.reduced;
        if (!moved) influences[0].weight = 1.0f;
        mended.unmoved += moved ? 0 : 1;
        mended.unknownJoint += unknown ? 1 : 0;
    }
    return mended;
}

/// Sets in front of the first that has only zeros in all vertices.
std::size_t usedSets(FileInfluences& file, std::size_t vertexCount)
{
    std::size_t used = 1;
    for (std::size_t vertex = 0; vertex < vertexCount; ++vertex)
    {
        for (std::size_t i = 4 * used; i < std::min(file.perVertex, most); ++i)
        {
            if (file.of(vertex)[i].weight != 0.0f) used = i / 4 + 1;
        }
    }
    return used;
}

} // namespace

std::size_t influenceSetCount(const tinygltf::Primitive& primitive)
{
    std::size_t count = 0;
    while (primitive.attributes.count("JOINTS_" + std::to_string(count)) > 0 &&
           primitive.attributes.count("WEIGHTS_" + std::to_string(count)) > 0)
        ++count;
    return count;
}

std::vector<InfluenceSet> readInfluences(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                         const MeshPrimitive& mesh, const AnimationSet& set, std::size_t skin,
                                         Report& report)
{
    FileInfluences file = readAll(model, primitive, mesh.vertexCount);
    mend(file, mesh.vertexCount, set.skins()[skin].joints.size()).report(mesh.label, report);
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
                (*out.entries)[vertex][i] = static_cast<unsigned short>(set.entryOfSkin(skin, influences[i].joint));
                (*out.weights)[vertex][i] = influences[i].weight;
            }
        }
    }
    return sets;
}

} // namespace osgGpuAnimation::gltf
