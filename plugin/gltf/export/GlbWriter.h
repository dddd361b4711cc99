// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/file/Report.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// A glTF 2.0 document with one buffer, written as GLB (glTF 2.0, section 4.4).
///
///     GlbWriter writer;
///     attributes["POSITION"] = writer.addFloats(positions, "VEC3", GlbWriter::Use::Vertices);
///     writer.document["meshes"].push_back(...);
///     const Result<std::string> glb = writer.glb(report);
class GlbWriter
{
public:
    enum class Use
    {
        Vertices, ///< with bounds
        Times,    ///< with bounds; equal arrays share an accessor
        Values
    };

    GlbWriter();

    nlohmann::json document; ///< all but `buffers`, which glb() writes

    /// The index of a new accessor. type: SCALAR, VEC2, VEC3, VEC4 or MAT4; values: its components, element by element.
    std::size_t addFloats(const std::vector<float>& values, const char* type, Use use);
    std::size_t addIndices(const std::vector<std::uint32_t>& indices);
    /// JOINTS_n: four to a vertex.
    std::size_t addJoints(const std::vector<std::uint16_t>& joints);
    /// The index of a new buffer view.
    std::size_t addBytes(std::string_view bytes, int target = 0);

    /// Lists the extension in extensionsUsed, once.
    void useExtension(const std::string& name);

    std::size_t size() const { return _binary.size(); } ///< bytes of the buffer
    /// True if the buffer has reached 2 GiB, which glb() refuses.
    bool isFull() const { return _binary.size() > maxBytes / 2; }
    /// Numbers of the document that are not finite, which JSON cannot hold, become 0, with a warning that names them.
    /// Errors: the file would be larger than a GLB can be (4 GiB), or its document than the import reads.
    Result<std::string> glb(Report& report) const;

private:
    static constexpr std::size_t maxBytes = 0xffffffffu;

    std::size_t addAccessor(std::size_t view, int componentType, std::size_t count, const char* type);

    std::string _binary;
    std::map<std::vector<float>, std::size_t> _times;
};

/// Appends to an array of the document, which is made if it is not there. Returns the element's index.
std::size_t append(nlohmann::json& array, nlohmann::json element);

} // namespace osgGpuAnimation::gltf
