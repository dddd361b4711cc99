// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/CrowdBatches.h>

#include <osgGpuAnimation/nodes/OsgMatrix.h>

#include <array>
#include <map>

namespace osgGpuAnimation
{

namespace
{

std::vector<CrowdBatches::Draw> enlistGroups(PoseFrame& frame, const CrowdInstances& instances,
                                             const CrowdGroups& groups, const CrowdDetail& detail,
                                             const osg::Matrixd& crowdToEye)
{
    std::vector<CrowdBatches::Draw> draws;
    const AffineMatrix toEye = toAffine(crowdToEye);
    for (const CrowdGroups::Group& group : groups.groups())
    {
        if (group.members.empty()) continue;
        std::unique_ptr<PoseBatch> batch = frame.makeBatch(instances.set());
        *batch = group.poses;
        // Also where none is shown, so that those after it have the slot, and with it the palette, of the frame before.
        const std::size_t slot = frame.enlist(std::move(batch)).slot;
        std::map<int, PaletteBinding*> bindings; // by level
        for (const CrowdGroups::Shown& shown : group.shown)
        {
            const int level = detail.isOn() ? detail.levelOf(shown.index) : DetailLevels::allTriangles;
            PaletteBinding*& binding = bindings[level];
            if (!binding)
            {
                const PlacedState placed = frame.placedState(*instances.set(), slot, level);
                binding = placed.binding;
                draws.push_back({placed.stateSet, true});
            }
            binding->add({toEye * instances.rootMatrix(shown.index), static_cast<float>(shown.number)});
        }
    }
    return draws;
}

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

CrowdGroups& CrowdBatches::groupsOf(const osg::Camera* camera, unsigned int frameNumber)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    // A camera that sees it again after more than a frame begins anew. Pipelined threads are a frame apart.
    for (auto kept = _kept.begin(); kept != _kept.end();)
        kept = frameNumber > kept->second.frameNumber + 2 ? _kept.erase(kept) : std::next(kept);
    Kept& kept = _kept[camera];
    kept.frameNumber = frameNumber;
    return kept.groups;
}

std::vector<CrowdBatches::Draw> CrowdBatches::enlist(PoseFrame& frame, const CrowdInstances& instances,
                                                     osgUtil::CullVisitor& visitor, const UpdateRate& rate,
                                                     const CrowdDetail& detail, std::vector<std::uint32_t>& seen)
{
    std::vector<Draw> draws;
    if (rate.every > 1)
    {
        CrowdGroups& groups = groupsOf(visitor.getCurrentCamera(), frame.frameNumber());
        groups.update(instances, CrowdView(visitor).sizePlane(rate.pixels), seen);
        draws = enlistGroups(frame, instances, groups, detail, *visitor.getModelViewMatrix());
    }
    static thread_local std::array<Indices, PoseBatch::loadCount> loads;
    sortByLoad(instances, seen, loads);
    std::vector<CrowdDetail::Run> runs;
    for (Indices& load : loads)
    {
        if (load.empty()) continue;
        if (detail.isOn()) detail.sort(load, runs);
        std::unique_ptr<PoseBatch> batch = frame.makeBatch(instances.set());
        instances.addTo(*batch, load);
        const EnlistedBatch enlisted = frame.enlist(std::move(batch));
        if (!detail.isOn()) draws.push_back({enlisted.stateSet, false});
        std::size_t first = 0;
        for (const CrowdDetail::Run& run : runs)
        {
            draws.push_back({frame.partState(*instances.set(), enlisted.slot, first, run.count, run.level), false});
            first += run.count;
        }
    }
    return draws;
}

} // namespace osgGpuAnimation
