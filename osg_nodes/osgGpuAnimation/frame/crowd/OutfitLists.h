// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>
#include <osgGpuAnimation/gpu/buffers/PlacedInstances.h>

#include <bitset>
#include <cstddef>
#include <unordered_map>
#include <vector>

namespace osgGpuAnimation
{

class SkinnedGeometry;

/// The instances that each mesh of a crowd with outfits is drawn for. Meshes that the same outfits show share a list:
/// one draw for a mesh and a level of detail, however many outfits show it.
struct OutfitLists
{
    static constexpr std::size_t maxOutfits = 256;
    using Outfits = std::bitset<maxOutfits + 1>; ///< by number; 0: no outfit

    /// Consecutive instances of one level of detail and one list.
    struct Run
    {
        int level;
        std::size_t first, count;
        std::size_t list = all;
    };

    static constexpr std::size_t all = 0; ///< the list of all instances
    std::size_t numberCount = 1; ///< numbers of outfits in use, 0 included
    std::vector<Outfits> lists{Outfits().set()};
    std::vector<std::size_t> ofMeshes; ///< the list of each mesh, see CharacterLevels::Lists
    std::unordered_map<const SkinnedGeometry*, std::size_t> listOf; ///< the same by mesh

    /// Writes the instances of each run list by list, with the numbers of their outfits, and replaces the runs.
    void arrange(const CrowdInstances& instances, std::vector<PlacedInstances::Drawn>& drawn,
                 std::vector<Run>& runs) const;
};

} // namespace osgGpuAnimation
