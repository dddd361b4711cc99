// SPDX-License-Identifier: MIT
#include "gltf/FlatMesh.h"

#include "gltf/Accessor.h"
#include "gltf/Influences.h"

#include <meshoptimizer.h>
#include <osg/Vec3d>

#include <algorithm>
#include <numeric>

namespace osgGpuAnimation::gltf
{

namespace
{

constexpr std::size_t mostStreams = 16; ///< that meshoptimizer compares at once

template <typename Element>
meshopt_Stream streamOf(const Element* elements, std::size_t bytes)
{
    return {elements, bytes, bytes};
}

template <typename Array>
void addArray(std::vector<meshopt_Stream>& streams, const osg::ref_ptr<Array>& array)
{
    if (array) streams.push_back(streamOf(array->asVector().data(), sizeof(typename Array::ElementDataType)));
}

void addArrays(std::vector<meshopt_Stream>& streams, const MeshPrimitive& mesh)
{
    addArray(streams, mesh.positions);
    addArray(streams, mesh.texCoords);
    addArray(streams, mesh.colors);
    for (const MorphTarget& target : mesh.targets)
    {
        addArray(streams, target.positions);
        addArray(streams, target.normals);
        addArray(streams, target.colors);
        addArray(streams, target.textureCoordinates);
    }
}

} // namespace

JoinedVertices joinVertices(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                            const MeshPrimitive& mesh)
{
    std::vector<meshopt_Stream> streams;
    addArrays(streams, mesh);
    std::vector<std::vector<std::uint32_t>> joints;
    std::vector<std::vector<float>> weights;
    for (std::size_t set = 0; set < influenceSetCount(primitive); ++set)
    {
        joints.push_back(readIntegers(model, primitive.attributes.at("JOINTS_" + std::to_string(set))));
        weights.push_back(readFloats(model, primitive.attributes.at("WEIGHTS_" + std::to_string(set))));
        streams.push_back(streamOf(joints.back().data(), 4 * sizeof(std::uint32_t)));
        streams.push_back(streamOf(weights.back().data(), 4 * sizeof(float)));
    }
    JoinedVertices joined{std::vector<std::uint32_t>(mesh.vertexCount, 0), 1};
    // All vertices in order; meshoptimizer insists on whole triangles.
    std::vector<std::uint32_t> all((mesh.vertexCount + 2) / 3 * 3, 0);
    std::iota(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(mesh.vertexCount), 0u);
    // What was found alike so far is one more stream of those that follow.
    for (std::size_t first = 0; first < streams.size(); first += mostStreams - 1)
    {
        const std::vector<std::uint32_t> before = joined.vertexOf;
        std::vector<meshopt_Stream> compared{streamOf(before.data(), sizeof(std::uint32_t))};
        const std::size_t end = std::min(first + mostStreams - 1, streams.size());
        for (std::size_t stream = first; stream < end; ++stream)
            compared.push_back(streams[stream]);
        joined.count = meshopt_generateVertexRemapMulti(joined.vertexOf.data(), all.data(), all.size(),
                                                        mesh.vertexCount, compared.data(), compared.size());
    }
    return joined;
}

osg::ref_ptr<osg::Vec3Array> smoothNormals(const osg::Vec3Array& positions, const std::vector<std::uint32_t>& indices)
{
    std::vector<osg::Vec3d> sums(positions.size());
    for (std::size_t corner = 0; corner + 2 < indices.size(); corner += 3)
    {
        const osg::Vec3d first(positions[indices[corner]]);
        const osg::Vec3d area =
            (osg::Vec3d(positions[indices[corner + 1]]) - first) ^ (osg::Vec3d(positions[indices[corner + 2]]) - first);
        for (std::size_t i = corner; i < corner + 3; ++i)
            sums[indices[i]] += area;
    }
    osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array;
    normals->reserve(sums.size());
    for (osg::Vec3d& sum : sums)
        normals->push_back(sum.normalize() > 0.0 ? osg::Vec3(sum) : osg::Vec3(0, 0, 1));
    return normals;
}

} // namespace osgGpuAnimation::gltf
