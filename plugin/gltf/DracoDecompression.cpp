// SPDX-License-Identifier: MIT
#include "gltf/DracoDecompression.h"

#include "gltf/Accessor.h"
#include "gltf/AddedData.h"
#include "gltf/DracoMesh.h"
#include "gltf/ElementName.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

using Model = tinygltf::Model;

bool isRequired(const Model& model)
{
    return std::find(model.extensionsRequired.begin(), model.extensionsRequired.end(), "KHR_draco_mesh_compression") !=
           model.extensionsRequired.end();
}

bool hasPlainData(const Model& model, const tinygltf::Primitive& primitive)
{
    return std::all_of(primitive.attributes.begin(), primitive.attributes.end(),
                       [&](const auto& attribute)
                       { return model.accessors[std::size_t(attribute.second)].bufferView >= 0; });
}

/// One primitive on its way from the bit stream into accessors.
class DracoPrimitive
{
public:
    DracoPrimitive(Model& model, tinygltf::Primitive& primitive, const JsonValue& extension, std::string name)
        : _model(model), _primitive(primitive), _extension(extension),
          _name(std::move(name) + ".extensions.KHR_draco_mesh_compression")
    {
    }

    std::optional<Error> decompress(DecodedBytes& budget)
    {
        if (_primitive.mode != TINYGLTF_MODE_TRIANGLES || _primitive.indices < 0)
            return fault(_name, "a primitive of indexed triangles", "mode " + std::to_string(_primitive.mode));
        const std::size_t count = _model.accessors[std::size_t(_primitive.indices)].count;
        const tinygltf::BufferView& view = _model.bufferViews[std::size_t(_extension["bufferView"].number())];
        const unsigned char* const data = _model.buffers[std::size_t(view.buffer)].data.data() + view.byteOffset;
        const Result<DracoMesh> mesh = DracoMesh::decode(data, view.byteLength, count / 3);
        if (!mesh) return Error{_name + ": " + mesh.error().message};
        if (!budget.take(bytesOf(mesh.value(), count))) return fault(_name, budget.limitText(), "more");
        for (const JsonValue& attribute : _extension["attributes"])
            if (std::optional<Error> error = replaceAttribute(mesh.value(), attribute)) return error;
        tinygltf::Accessor indices = _model.accessors[std::size_t(_primitive.indices)];
        indices.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
        _primitive.indices = addCopy(indices, bytesOf(mesh.value().indices()));
        return std::nullopt;
    }

private:
    static std::vector<unsigned char> bytesOf(const std::vector<std::uint32_t>& indices)
    {
        const unsigned char* const begin = reinterpret_cast<const unsigned char*>(indices.data());
        return std::vector<unsigned char>(begin, begin + indices.size() * sizeof(std::uint32_t));
    }

    std::size_t bytesOf(const DracoMesh& mesh, std::size_t indices) const
    {
        std::size_t bytes = indices * sizeof(std::uint32_t);
        for (const auto& attribute : _primitive.attributes)
            bytes += mesh.vertices() * elementBytes(_model.accessors[std::size_t(attribute.second)]);
        return bytes;
    }

    std::optional<Error> replaceAttribute(const DracoMesh& mesh, const JsonValue& attribute)
    {
        const std::string key(attribute.key());
        const auto found = _primitive.attributes.find(key);
        if (found == _primitive.attributes.end()) return std::nullopt; // left out before
        const tinygltf::Accessor accessor = _model.accessors[std::size_t(found->second)];
        const std::string name = _name + ".attributes." + printable(key);
        if (accessor.count != mesh.vertices())
            return fault(name,
                         std::to_string(accessor.count) + " vertices as in " +
                             elementName("accessors", std::size_t(found->second)),
                         std::to_string(mesh.vertices()));
        Result<std::vector<unsigned char>> bytes =
            mesh.attribute(std::uint32_t(attribute.number()), componentCount(accessor), accessor.componentType);
        if (!bytes) return Error{name + ": " + bytes.error().message};
        found->second = addCopy(accessor, std::move(bytes).value());
        return std::nullopt;
    }

    /// An accessor like the file's over data of our own.
    int addCopy(tinygltf::Accessor accessor, std::vector<unsigned char> bytes)
    {
        accessor.bufferView = addBufferView(_model, std::move(bytes), 0);
        accessor.byteOffset = 0;
        accessor.sparse.isSparse = false;
        _model.accessors.push_back(std::move(accessor));
        return int(_model.accessors.size() - 1);
    }

    Model& _model;
    tinygltf::Primitive& _primitive;
    JsonValue _extension;
    std::string _name;
};

} // namespace

std::optional<Error> decompressDraco(const JsonValue& meshes, DecodedBytes& budget, Model& model)
{
    const bool required = isRequired(model);
    std::size_t m = 0;
    for (const JsonValue& mesh : meshes)
    {
        std::size_t p = 0;
        for (const JsonValue& json : mesh["primitives"])
        {
            const JsonValue extension = json["extensions"]["KHR_draco_mesh_compression"];
            tinygltf::Primitive& primitive = model.meshes[m].primitives[p];
            if (extension && (required || !hasPlainData(model, primitive)))
                if (std::optional<Error> error =
                        DracoPrimitive(model, primitive, extension, elementName("meshes", m, "primitives", p))
                            .decompress(budget))
                    return error;
            ++p;
        }
        ++m;
    }
    return std::nullopt;
}

} // namespace osgGpuAnimation::gltf
