// SPDX-License-Identifier: MIT
#include "fuzz/Seed.h"
#include "plugin/draco/DracoEncoder.h"
#include "plugin/PackedDocument.h"

#include <meshoptimizer.h>

namespace osgGpuAnimation::gltf
{

namespace
{

using Json = nlohmann::json;
using Bytes = std::vector<unsigned char>;

const std::uint32_t squares = 3;
const std::size_t vertices = (squares + 1) * (squares + 1);

Seed seed(const std::string& name, PackedDocument& document)
{
    document.json["buffers"][0]["byteLength"] = document.data().size();
    document.json["nodes"] = {{{"mesh", 0}}};
    document.json["scenes"] = {{{"nodes", {0}}}};
    return {name, document.json, document.data()};
}

int meshoptView(PackedDocument& document, const Bytes& encoded, std::size_t count, std::size_t stride, const char* mode)
{
    const Json extension = {{"buffer", 0},
                            {"byteOffset", document.add(encoded)},
                            {"byteLength", encoded.size()},
                            {"byteStride", stride},
                            {"count", count},
                            {"mode", mode}};
    Json view = {
        {"buffer", 1}, {"byteLength", count * stride}, {"extensions", {{"EXT_meshopt_compression", extension}}}};
    if (std::string(mode) == "ATTRIBUTES") view["byteStride"] = stride;
    document.json["bufferViews"].push_back(view);
    return static_cast<int>(document.json["bufferViews"].size()) - 1;
}

Seed meshopt()
{
    PackedDocument document;
    document.json["extensionsUsed"] = document.json["extensionsRequired"] = {"EXT_meshopt_compression"};
    document.json["buffers"] = {
        Json::object(), {{"byteLength", 4096}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
    const std::vector<float> positions = sheetPositions(squares);
    const std::vector<std::uint32_t> indices = sheetIndices(squares);
    Bytes points(meshopt_encodeVertexBufferBound(vertices, 12));
    points.resize(meshopt_encodeVertexBuffer(points.data(), points.size(), positions.data(), vertices, 12));
    Bytes triangles(meshopt_encodeIndexBufferBound(indices.size(), vertices));
    triangles.resize(meshopt_encodeIndexBuffer(triangles.data(), triangles.size(), indices.data(), indices.size()));
    const int position =
        document.accessor("VEC3", 5126, vertices, meshoptView(document, points, vertices, 12, "ATTRIBUTES"));
    const int index = document.accessor("SCALAR", 5123, indices.size(),
                                        meshoptView(document, triangles, indices.size(), 2, "TRIANGLES"));
    document.json["accessors"][0]["min"] = {0, 0, 0.25};
    document.json["accessors"][0]["max"] = {squares, squares, 0.25};
    document.json["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", position}}}, {"indices", index}}}}}};
    return seed("meshopt", document);
}

Seed draco(const std::string& name, DracoMethod method)
{
    const std::string stream =
        encodeDraco(sheetPositions(squares), std::vector<std::uint8_t>(4 * vertices), sheetIndices(squares), method);
    PackedDocument document;
    const char* const extension = "KHR_draco_mesh_compression";
    document.json["extensionsUsed"] = document.json["extensionsRequired"] = {extension};
    document.json["bufferViews"] = {
        {{"buffer", 0}, {"byteOffset", document.add(stream.data(), stream.size())}, {"byteLength", stream.size()}}};
    document.accessor("VEC3", 5126, vertices, -1);
    document.accessor("SCALAR", 5123, sheetIndices(squares).size(), -1);
    document.json["accessors"][0]["min"] = {0, 0, 0.25};
    document.json["accessors"][0]["max"] = {squares, squares, 0.25};
    const Json compressed = {{"bufferView", 0}, {"attributes", {{"POSITION", 0}}}};
    document.json["meshes"] = {
        {{"primitives",
          {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}, {"extensions", {{extension, compressed}}}}}}}};
    return seed(name, document);
}

} // namespace

std::vector<Seed> compressedSeeds()
{
    return {meshopt(), draco("dracoSequential", DracoMethod::Sequential),
            draco("dracoEdgebreaker", DracoMethod::Edgebreaker)};
}

} // namespace osgGpuAnimation::gltf
