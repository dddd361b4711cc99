// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/frame/crowd/CrowdBatches.h>

#include <osgGpuAnimation/gpu/PosePipeline.h>

#include <algorithm>
#include <array>

namespace osgGpuAnimation
{

namespace
{

using Indices = std::vector<std::uint32_t>;

/// Instances by blend cost, first those without constraints, then those with.
using IndicesByCost = std::array<Indices, 2 * PoseBatch::blendCostCount>;

/// Groups too small for a batch join the next higher cost. first: the lowest cost.
void joinSmallGroups(IndicesByCost& indicesByCost, std::size_t first)
{
    std::size_t higherCost = first + PoseBatch::blendCostCount - 1;
    for (std::size_t cost = higherCost; cost-- > first;)
        if (!indicesByCost[cost].empty() && indicesByCost[cost].size() < PoseBatch::minBatchSize &&
            !indicesByCost[higherCost].empty())
        {
            indicesByCost[higherCost].insert(indicesByCost[higherCost].end(), indicesByCost[cost].begin(),
                                             indicesByCost[cost].end());
            indicesByCost[cost].clear();
        }
        else if (!indicesByCost[cost].empty())
            higherCost = cost;
}

void sortByBlendCost(const CrowdInstances& instances, const Indices& seen, IndicesByCost& indicesByCost)
{
    for (Indices& indices : indicesByCost)
        indices.clear();
    for (const std::uint32_t index : seen)
    {
        const std::size_t first = instances.isConstrained(index) ? PoseBatch::blendCostCount : 0;
        indicesByCost[first + static_cast<std::size_t>(instances.blendCost(index))].push_back(index);
    }
    joinSmallGroups(indicesByCost, 0);
    joinSmallGroups(indicesByCost, PoseBatch::blendCostCount);
}

/// Submits instances with outfits, as many at once as one palette of the context holds, and appends their draws. runs:
/// the levels of the indices.
void submitListed(PoseFrame& frame, const CrowdInstances& instances, const DrawnLists& lists, const Indices& indices,
                  const std::vector<OutfitLists::Run>& runs, std::vector<DrawState>& draws)
{
    PosePipeline::Options options;
    options.maxTexels = frame.getMaxTexels();
    const std::size_t max = PosePipeline::chunkCapacity(*instances.set(), options);
    for (std::size_t first = 0; first < indices.size(); first += max)
    {
        const std::size_t end = std::min(first + max, indices.size());
        std::unique_ptr<PoseBatch> batch = frame.makeBatch(instances.set());
        instances.addTo(*batch, indices.data() + first, end - first);
        const std::shared_ptr<PlacedInstances> list = std::make_shared<PlacedInstances>();
        list->crowd = instances.identity();
        list->poseCount = batch->size();
        list->drawn.reserve(end - first);
        for (std::size_t i = first; i < end; ++i)
            list->drawn.push_back({static_cast<std::uint32_t>(i - first), indices[i]});
        std::vector<OutfitLists::Run> listed;
        for (const OutfitLists::Run& run : runs)
        {
            const std::size_t begin = std::max(run.first, first), stop = std::min(run.first + run.count, end);
            if (begin < stop) listed.push_back({run.level, begin - first, stop - begin});
        }
        lists.arrange(instances, list->drawn, listed);
        submitPlaced(frame, instances, std::move(batch), list, listed, draws);
    }
}

/// Sorts the indices by level, the finest first; stable within a level.
void sortByLevel(const CrowdInstances& instances, const LodScale& scale, Indices& indices,
                 std::vector<OutfitLists::Run>& outRuns)
{
    static thread_local std::map<int, Indices> levels; // keeps its storage between culls
    for (auto& [level, ofLevel] : levels)
        ofLevel.clear();
    int lastLevel = 0;
    Indices* last = nullptr;
    for (const std::uint32_t index : indices)
    {
        const glm::vec4& sphere = instances.sphere(index);
        const int level = scale.level(glm::vec3(sphere), sphere.w, instances.rootMatrix(index));
        if (!last || level != lastLevel) last = &levels[level];
        lastLevel = level;
        last->push_back(index);
    }
    indices.clear();
    outRuns.clear();
    for (const auto& [level, ofLevel] : levels)
    {
        if (ofLevel.empty()) continue;
        outRuns.push_back({level, indices.size(), ofLevel.size()});
        indices.insert(indices.end(), ofLevel.begin(), ofLevel.end());
    }
}

} // namespace

std::shared_ptr<PosedMeshes> PosedInstances::of(CrowdInstances::Handle instance)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    const auto kept = _kept.find(instance);
    if (kept != _kept.end()) return kept->second;
    if (_kept.size() >= maxKept) _kept.clear();
    return _kept[instance] = std::make_shared<PosedMeshes>();
}

void submitPlaced(PoseFrame& frame, const CrowdInstances& instances, std::unique_ptr<PoseBatch> batch,
                  const std::shared_ptr<const PlacedInstances>& list, const std::vector<OutfitLists::Run>& runs,
                  std::vector<DrawState>& draws)
{
    const std::size_t slot = frame.submitShared(std::move(batch), &instances, list);
    for (const OutfitLists::Run& run : runs)
    {
        draws.push_back(frame.placedState(*instances.set(), slot, list, run.first, run.count, run.level));
        draws.back().list = run.list;
    }
}

std::vector<DrawState> submitSeen(PoseFrame& frame, const CrowdInstances& instances, const LodScale& scale,
                                  const DrawnLists* lists, const std::vector<std::uint32_t>& seen)
{
    static thread_local IndicesByCost indicesByCost;
    sortByBlendCost(instances, seen, indicesByCost);
    std::vector<DrawState> draws;
    for (Indices& indices : indicesByCost)
    {
        if (indices.empty()) continue;
        std::vector<OutfitLists::Run> runs{{PaletteBinding::allTriangles, 0, indices.size()}};
        if (scale.isOn()) sortByLevel(instances, scale, indices, runs);
        if (lists)
        {
            submitListed(frame, instances, *lists, indices, runs, draws);
            continue;
        }
        std::unique_ptr<PoseBatch> batch = frame.makeBatch(instances.set());
        instances.addTo(*batch, indices.data(), indices.size());
        const std::size_t slot = frame.submit(std::move(batch), &instances, indices);
        for (const OutfitLists::Run& run : runs)
            draws.push_back(frame.partState(*instances.set(), slot, run.first, run.count, run.level));
    }
    return draws;
}

} // namespace osgGpuAnimation
