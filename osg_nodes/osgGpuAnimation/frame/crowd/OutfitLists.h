// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>
#include <osgGpuAnimation/gpu/buffers/PlacedInstances.h>

#include <osg/ref_ptr>
#include <osg/StateSet>

#include <bitset>
#include <cstddef>
#include <functional>
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
    std::size_t numberCount = 1;          ///< numbers of outfits in use, 0 included
    std::vector<Outfits> lists{Outfits().set()};
    /// How a mesh is drawn.
    struct Mesh
    {
        std::size_t list = all;
        /// Of a merged mesh with parts of several lists: hides them by instance, see skin.glsl. Null: of one list.
        osg::ref_ptr<osg::StateSet> parts;
    };
    std::unordered_map<const SkinnedGeometry*, Mesh> meshes; ///< of all levels of detail
};

/// The lists that a camera draws.
struct DrawnLists
{
    const OutfitLists& outfits;
    std::function<std::vector<bool>(int level)> at; ///< by list: some mesh of that level of detail has it

    /// Writes the instances of each run list by list, with the numbers of their outfits, and replaces the runs.
    void arrange(const CrowdInstances& instances, std::vector<PlacedInstances::Drawn>& drawn,
                 std::vector<OutfitLists::Run>& runs) const;
};

} // namespace osgGpuAnimation
