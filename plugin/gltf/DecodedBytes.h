// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>

namespace osgGpuAnimation::gltf
{

/// What one document may still unfold to in memory: buffers, accessors and images, all together
/// (ImportOptions::maxDecodedBytes). Take first, allocate then.
class DecodedBytes
{
public:
    explicit DecodedBytes(std::size_t limit) : _limit(limit), _left(limit) {}

    std::size_t limit() const { return _limit; }
    std::size_t left() const { return _left; }

    /// False, and nothing taken, where it is more than is left.
    [[nodiscard]] bool take(std::size_t bytes)
    {
        if (bytes > _left) return false;
        _left -= bytes;
        return true;
    }

    /// For messages: what the limit is and how it is raised.
    std::string limitText() const
    {
        return "at most " + std::to_string(_limit) + " bytes in all (limit maxDecodedBytes)";
    }

private:
    std::size_t _limit;
    std::size_t _left;
};

} // namespace osgGpuAnimation::gltf
