// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/document/JsonTree.h"

#include <osgGpuAnimation/math/Result.h>

#include <cstddef>
#include <optional>
#include <string>

namespace osgGpuAnimation::gltf
{

/// The bytes that one stage of an import may still decode into memory. Callers take before they allocate.
/// ImportOptions::maxDecodedBytes limits each of three stages separately: the loaded document (buffers, accessors,
/// images), the reads of validateMeshes() (a limit of time, not of memory), and the scene (clips, meshes, instances).
class MemoryBudget
{
public:
    explicit MemoryBudget(std::size_t limit) : _limit(limit), _left(limit) {}

    std::size_t limit() const { return _limit; }
    std::size_t left() const { return _left; }

    /// False if fewer bytes are left; then the budget does not change.
    [[nodiscard]] bool take(std::size_t bytes)
    {
        if (bytes > _left) return false;
        _left -= bytes;
        return true;
    }

    /// The limit and the option that raises it, for messages.
    std::string limitText() const
    {
        return "at most " + std::to_string(_limit) + " bytes in all (limit maxDecodedBytes)";
    }

private:
    std::size_t _limit;
    std::size_t _left;
};

/// An upper bound of the memory for one JSON value: text, tree and model.
constexpr std::size_t bytesOfJsonValue = 128;
/// The same for each letter of strings and keys.
constexpr std::size_t bytesOfJsonLetter = 6;

/// Checks that the elements of a document fit into ImportOptions::maxDocumentBytes. Two characters, `{}`, become a
/// material of two kilobytes, so the check runs before any element is made. It requires of the document only that its
/// root is an object. Error: names the list that exceeds the limit.
std::optional<Error> checkDocumentBytes(JsonTree& json, std::size_t limit);

} // namespace osgGpuAnimation::gltf
