// SPDX-License-Identifier: MIT
#include "gltf/FlatMesh.h"

#include "gltf/Accessor.h"
#include "gltf/Influences.h"

#include <osg/Vec3d>

namespace osgGpuAnimation::gltf
{

namespace
{

template <typename Array>
void addArray(std::vector<VertexStream>& streams, const osg::ref_ptr<Array>& array)
{
    if (array) streams.push_back({array->asVector().data(), sizeof(typename Array::ElementDataType)});
}

void addArrays(std::vector<VertexStream>& streams, const MeshPrimitive& mesh)
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
    std::vector<VertexStream> streams;
    addArrays(streams, mesh);
    std::vector<std::vector<std::uint32_t>> joints;
    std::vector<std::vector<float>> weights;
    for (std::size_t set = 0; set < influenceSetCount(primitive); ++set)
    {
        joints.push_back(readIntegers(model, primitive.attributes.at("JOINTS_" + std::to_string(set))));
        weights.push_back(readFloats(model, primitive.attributes.at("WEIGHTS_" + std::to_string(set))));
        streams.push_back({joints.back().data(), 4 * sizeof(std::uint32_t)});
        streams.push_back({weights.back().data(), 4 * sizeof(float)});
    }
    return joinAlike(streams, mesh.vertexCount);
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
