// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/CrowdBatches.h>

#include <glm/geometric.hpp>

#include <array>

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
    static thread_local std::array<Indices, PoseBatch::loadCount> loads;
    sortByLoad(instances, seen, loads);
    for (const Indices& load : loads)
    {
        if (load.empty()) continue;
        std::unique_ptr<PoseBatch> batch = frame.makeBatch(instances.set());
        instances.addTo(*batch, load);
        states.push_back(frame.enlist(std::move(batch)));
    }
    return states;
}

} // namespace osgGpuAnimation
