// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/CrowdBatches.h>

#include <glm/geometric.hpp>

namespace osgGpuAnimation
{

namespace
{

using Indices = std::vector<std::uint32_t>;

/// Takes what is small out of `seen` and into the groups.
void dealOut(const CrowdInstances& instances, const glm::vec4& sizePlane, Indices& seen, std::vector<Indices>& groups)
{
    groups.resize(instances.groupCount());
    for (Indices& group : groups)
        group.clear();
    std::size_t kept = 0;
    for (const std::uint32_t index : seen)
    {
        const glm::vec4& sphere = instances.sphere(index);
        const bool isLarge = glm::dot(glm::vec3(sizePlane), glm::vec3(sphere)) + sizePlane.w >= -sphere.w;
        const std::size_t group = isLarge ? instances.groupCount() : instances.groupOf(index);
        if (group == instances.groupCount())
            seen[kept++] = index;
        else
            groups[group].push_back(index);
    }
    seen.resize(kept);
}

} // namespace

std::vector<osg::StateSet*> enlistCrowd(PoseFrame& frame, const CrowdInstances& instances, const CrowdView& view,
                                        const UpdateRate& rate, Indices& seen)
{
    std::vector<osg::StateSet*> states;
    static thread_local std::vector<Indices> groups; // keeps its storage from cull to cull
    if (rate.every > 1)
        dealOut(instances, view.sizePlane(rate.pixels), seen, groups);
    else
        groups.clear();
    // Groups first: so each has the slot, and with it the palette, of the frame before.
    for (std::size_t group = 0; group < groups.size(); ++group)
    {
        if (groups[group].empty()) continue;
        std::unique_ptr<PoseBatch> batch = frame.makeBatch(instances.set());
        instances.addGroupTo(*batch, groups[group], group);
        states.push_back(frame.enlist(std::move(batch)));
    }
    if (seen.empty()) return states;
    std::unique_ptr<PoseBatch> batch = frame.makeBatch(instances.set());
    instances.addTo(*batch, seen);
    states.push_back(frame.enlist(std::move(batch)));
    return states;
}

} // namespace osgGpuAnimation
