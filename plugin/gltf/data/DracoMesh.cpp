// SPDX-License-Identifier: MIT
#include "gltf/data/DracoMesh.h"

#include "gltf/file/Report.h"

#include <draco/compression/decode.h>
#include <draco/compression/point_cloud/point_cloud_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/mesh/mesh.h>
#include <draco/metadata/geometry_metadata.h>
#include <draco/metadata/metadata_decoder.h>

#include <cstring>
#include <memory>
#include <optional>
#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

/// The number of triangles in the header; none if the stream has no header of version 2.2.
std::optional<std::uint32_t> facesOfHeader(const char* data, std::size_t bytes)
{
    draco::DecoderBuffer buffer;
    buffer.Init(data, bytes);
    draco::DracoHeader header;
    if (!draco::PointCloudDecoder::DecodeHeader(&buffer, &header).ok()) return std::nullopt;
    if (header.version_major != 2 || header.version_minor != 2 || header.encoder_type != draco::TRIANGULAR_MESH)
        return std::nullopt;
    buffer.set_bitstream_version(draco::kDracoMeshBitstreamVersion);
    if (header.flags & METADATA_FLAG_MASK)
    {
        draco::GeometryMetadata metadata;
        if (!draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &metadata)) return std::nullopt;
    }
    std::uint32_t faces = 0, vertices = 0;
    if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING)
    {
        std::uint8_t traversal;
        if (!buffer.Decode(&traversal) || !draco::DecodeVarint(&vertices, &buffer)) return std::nullopt;
    }
    if (!draco::DecodeVarint(&faces, &buffer)) return std::nullopt;
    return faces;
}

template <typename Number>
bool readValues(const draco::Mesh& mesh, const draco::PointAttribute& attribute, std::vector<unsigned char>& out)
{
    const std::size_t components = static_cast<std::size_t>(attribute.num_components());
    out.resize(mesh.num_points() * components * sizeof(Number));
    Number values[4] = {};
    unsigned char* to = out.data();
    for (draco::PointIndex point(0); point < mesh.num_points(); ++point)
    {
        const draco::AttributeValueIndex value = attribute.mapped_index(point);
        if (value.value() >= attribute.size()) return false;
        if (!attribute.ConvertValue<Number>(value, static_cast<std::int8_t>(components), values)) return false;
        std::memcpy(to, values, components * sizeof(Number));
        to += components * sizeof(Number);
    }
    return true;
}

std::optional<Error> readAttribute(const draco::Mesh& mesh, const std::string& name, DracoAttribute& out)
{
    using Reader = bool (*)(const draco::Mesh&, const draco::PointAttribute&, std::vector<unsigned char>&);
    // From GL_BYTE on; glTF does not know the fifth, GL_INT.
    constexpr Reader readers[] = {readValues<std::int8_t>,
                                  readValues<std::uint8_t>,
                                  readValues<std::int16_t>,
                                  readValues<std::uint16_t>,
                                  nullptr,
                                  readValues<std::uint32_t>,
                                  readValues<float>};
    if (out.vertices != mesh.num_points())
        return fault(name, std::to_string(out.vertices) + " vertices as in " + elementName("accessors", out.accessor),
                     mesh.num_points());
    const draco::PointAttribute* const attribute = mesh.GetAttributeByUniqueId(out.uniqueId);
    if (!attribute) return fault(name, "an attribute of the Draco mesh", "number " + std::to_string(out.uniqueId));
    if (out.components > 4 || static_cast<std::size_t>(attribute->num_components()) != out.components)
        return fault(name, std::to_string(out.components) + " components in the Draco mesh",
                     attribute->num_components());
    if (!readers[out.componentType - 5120](mesh, *attribute, out.values))
        return fault(name, "values of the accessor's component type in the Draco mesh", "others");
    return std::nullopt;
}

} // namespace

Result<std::vector<std::uint32_t>> decodeDraco(const unsigned char* data, std::size_t bytes, std::size_t faces,
                                               const std::string& name, std::vector<DracoAttribute>& attributes)
{
    const char* const stream = reinterpret_cast<const char*>(data);
    const std::optional<std::uint32_t> found = facesOfHeader(stream, bytes);
    if (!found) return fault(name, "a Draco mesh of version 2.2", "other data");
    if (*found != faces) return fault(name, "a Draco mesh of " + std::to_string(faces) + " triangles", *found);
    draco::DecoderBuffer buffer;
    buffer.Init(stream, bytes);
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) return fault(name, "data that Draco can decode", printable(decoded.status().error_msg_string()));
    const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
    if (!mesh || mesh->num_faces() != faces) return fault(name, "data that Draco can decode", "other data");
    for (DracoAttribute& attribute : attributes)
        if (const auto error = readAttribute(*mesh, name + ".attributes." + printable(attribute.name), attribute))
            return *error;
    std::vector<std::uint32_t> indices;
    indices.reserve(faces * 3);
    for (draco::FaceIndex face(0); face < mesh->num_faces(); ++face)
        for (const draco::PointIndex& point : mesh->face(face))
            indices.push_back(point.value());
    return indices;
}

} // namespace osgGpuAnimation::gltf
