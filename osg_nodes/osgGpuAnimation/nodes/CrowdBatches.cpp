// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/CrowdBatches.h>

#include <array>

namespace osgGpuAnimation
{

namespace
{

using Indices = std::vector<std::uint32_t>;

/// By what their poses cost to mix; those that are too few for a batch join the next dearer.
void sortByLoad(const CrowdInstances& instances, const Indices& seen, std::array<Indices, PoseBatch::loadCount>& loads)
{
    for (Indices& load : loads)
        load.clear();
    for (const std::uint32_t index : seen)
        loads[static_cast<std::size_t>(instances.load(index))].push_back(index);
    std::size_t dearer = loads.size() - 1;
    for (std::size_t load = dearer; load-- > 0;)
        if (!loads[load].empty() && loads[load].size() < PoseBatch::worthABatch && !loads[dearer].empty())
        {
            loads[dearer].insert(loads[dearer].end(), loads[load].begin(), loads[load].end());
            loads[load].clear();
        }
        else if (!loads[load].empty())
            dearer = load;
}

} // namespace

std::vector<DrawState> enlistSeen(PoseFrame& frame, const CrowdInstances& instances, const CrowdDetail& detail,
                                  const std::vector<std::uint32_t>& seen)
{
    static thread_local std::array<Indices, PoseBatch::loadCount> loads;
    sortByLoad(instances, seen, loads);
    std::vector<DrawState> draws;
    std::vector<CrowdDetail::Run> runs;
    for (Indices& load : loads)
    {
        if (load.empty()) continue;
        if (detail.isOn()) detail.sort(load, runs);
        std::unique_ptr<PoseBatch> batch = frame.makeBatch(instances.set());
        instances.addTo(*batch, load);
        const EnlistedBatch enlisted = frame.enlist(std::move(batch));
        if (!detail.isOn()) draws.push_back(enlisted.all);
        std::size_t first = 0;
        for (const CrowdDetail::Run& run : runs)
        {
            draws.push_back(frame.partState(*instances.set(), enlisted.slot, first, run.count, run.level));
            first += run.count;
        }
    }
    return draws;
}

} // namespace osgGpuAnimation
