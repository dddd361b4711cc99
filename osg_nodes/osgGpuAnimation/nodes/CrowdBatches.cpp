// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/CrowdBatches.h>

#include <osgGpuAnimation/nodes/OsgMatrix.h>

namespace osgGpuAnimation
{

namespace
{

std::vector<CrowdBatches::Draw> enlistGroups(PoseFrame& frame, const CrowdInstances& instances,
                                             const CrowdGroups& groups, const osg::Matrixd& crowdToEye)
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
        if (group.shown.empty()) continue;
        const PlacedState placed = frame.placedState(*instances.set(), slot);
        for (const CrowdGroups::Shown& shown : group.shown)
            placed.binding->add({toEye * instances.rootMatrix(shown.index), static_cast<float>(shown.number)});
        draws.push_back({placed.stateSet, true});
    }
    return draws;
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
                                                     std::vector<std::uint32_t>& seen)
{
    std::vector<Draw> draws;
    if (rate.every > 1)
    {
        CrowdGroups& groups = groupsOf(visitor.getCurrentCamera(), frame.frameNumber());
        groups.update(instances, CrowdView(visitor).sizePlane(rate.pixels), seen);
        draws = enlistGroups(frame, instances, groups, *visitor.getModelViewMatrix());
    }
    if (seen.empty()) return draws;
    std::unique_ptr<PoseBatch> batch = frame.makeBatch(instances.set());
    instances.addTo(*batch, seen);
    draws.push_back({frame.enlist(std::move(batch)).stateSet, false});
    return draws;
}

} // namespace osgGpuAnimation
