// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/frame/crowd/OutfitLists.h>

#include <layout.glsl>

#include <algorithm>
#include <array>
#include <tuple>

namespace osgGpuAnimation
{

void DrawnLists::arrange(const CrowdInstances& instances, std::vector<PlacedInstances::Drawn>& drawn,
                         std::vector<OutfitLists::Run>& runs) const
{
    static thread_local std::vector<PlacedInstances::Drawn> sorted; // keeps its storage from cull to cull
    std::vector<PlacedInstances::Drawn> listed;
    std::vector<OutfitLists::Run> runsOfLists;
    const auto& [lists, numberCount] = std::tie(outfits.lists, outfits.numberCount);
    for (const OutfitLists::Run& run : runs)
    {
        const PlacedInstances::Drawn* const begin = drawn.data() + run.first;
        const PlacedInstances::Drawn* const end = begin + run.count;
        std::array<std::uint32_t, OutfitLists::maxOutfits + 2> ends{}; // by outfit: where its instances end
        for (const PlacedInstances::Drawn* each = begin; each != end; ++each)
            ++ends[instances.outfit(each->instance) + 1u];
        for (std::size_t outfit = 1; outfit <= numberCount; ++outfit)
            ends[outfit] += ends[outfit - 1];
        const std::array<std::uint32_t, OutfitLists::maxOutfits + 2> begins = ends;
        sorted.resize(run.count);
        for (const PlacedInstances::Drawn* each = begin; each != end; ++each)
        {
            const std::uint32_t outfit = instances.outfit(each->instance);
            sorted[ends[outfit]++] = {each->pose, each->instance | outfit << POSE_DRAWN_OUTFIT_SHIFT};
        }
        const std::vector<bool> isDrawn = at(run.level);
        listed.reserve(listed.size() +
                       run.count * static_cast<std::size_t>(std::count(isDrawn.begin(), isDrawn.end(), true)));
        for (std::size_t list = 0; list < lists.size(); ++list)
        {
            if (!isDrawn[list]) continue;
            const std::size_t first = listed.size();
            for (std::size_t outfit = 0; outfit < numberCount; ++outfit)
                if (lists[list][outfit])
                    listed.insert(listed.end(), sorted.begin() + begins[outfit], sorted.begin() + begins[outfit + 1]);
            if (listed.size() > first) runsOfLists.push_back({run.level, first, listed.size() - first, list});
        }
    }
    drawn = std::move(listed);
    runs = std::move(runsOfLists);
}

} // namespace osgGpuAnimation
