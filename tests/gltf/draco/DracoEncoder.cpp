// SPDX-License-Identifier: MIT
#include "DracoEncoder.h"

#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>

namespace osgGpuAnimation
{

namespace
{

void addAttribute(draco::Mesh& mesh, draco::GeometryAttribute::Type kind, std::uint8_t components,
                  draco::DataType dataType, const void* values, std::size_t stride)
{
    draco::GeometryAttribute attribute;
    attribute.Init(kind, nullptr, components, dataType, false, std::int64_t(stride), 0);
    const int id = mesh.AddAttribute(attribute, true, mesh.num_points());
    for (std::uint32_t i = 0; i < mesh.num_points(); ++i)
        mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i),
                                              static_cast<const char*>(values) + i * stride);
}

} // namespace

std::string encodeDraco(const std::vector<float>& positions, const std::vector<std::uint8_t>& joints,
                        const std::vector<std::uint32_t>& indices, DracoMethod method)
{
    draco::Mesh mesh;
    mesh.set_num_points(std::uint32_t(positions.size() / 3));
    addAttribute(mesh, draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32, positions.data(), 12);
    addAttribute(mesh, draco::GeometryAttribute::GENERIC, 4, draco::DT_UINT8, joints.data(), 4);
    for (std::size_t i = 0; i < indices.size(); i += 3)
        mesh.AddFace(
            {draco::PointIndex(indices[i]), draco::PointIndex(indices[i + 1]), draco::PointIndex(indices[i + 2])});
    draco::Encoder encoder;
    encoder.SetEncodingMethod(method == DracoMethod::Sequential ? draco::MESH_SEQUENTIAL_ENCODING
                                                                : draco::MESH_EDGEBREAKER_ENCODING);
    draco::EncoderBuffer buffer;
    return encoder.EncodeMeshToBuffer(mesh, &buffer).ok() ? std::string(buffer.data(), buffer.size()) : std::string();
}

} // namespace osgGpuAnimation
