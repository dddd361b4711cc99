// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/CrowdGroups.h>

#include <glm/geometric.hpp>

namespace osgGpuAnimation
{

void CrowdGroups::update(const CrowdInstances& instances, const glm::vec4& sizePlane, std::vector<std::uint32_t>& seen)
{
    if (_groups.size() != instances.groupCount()) _groups.assign(instances.groupCount(), Group(instances.set()));
    _isTurn.assign(_groups.size(), false);
    _numberOf.resize(instances.placeCount());
    for (std::size_t number = 0; number < _groups.size(); ++number)
    {
        Group& group = _groups[number];
        group.shown.clear();
        if (!group.isNew && group.turn == instances.groupTurn(number)) continue;
        _isTurn[number] = true;
        group.poses.clear();
        group.members.clear();
        group.turn = instances.groupTurn(number);
        group.isNew = false;
    }

    std::size_t kept = 0;
    for (const std::uint32_t index : seen)
    {
        const glm::vec4& sphere = instances.sphere(index);
        const bool isLarge = glm::dot(glm::vec3(sizePlane), glm::vec3(sphere)) + sizePlane.w >= -sphere.w;
        const std::size_t group = isLarge ? _groups.size() : instances.groupOf(index);
        if (group == _groups.size() || !take(instances, group, index)) seen[kept++] = index;
    }
    seen.resize(kept);
}

bool CrowdGroups::take(const CrowdInstances& instances, std::size_t number, std::uint32_t index)
{
    Group& group = _groups[number];
    const CrowdInstances::Handle handle = instances.handleOf(index);
    std::uint32_t& place = _numberOf[CrowdInstances::placeOf(handle)];
    if (_isTurn[number])
    {
        place = static_cast<std::uint32_t>(group.members.size());
        group.members.push_back(handle);
        group.poses.addSample(instances.groupSample(index));
    }
    else if (place >= group.members.size() || group.members[place] != handle)
        return false;
    group.poses.setTint(place, instances.tint(index));
    group.shown.push_back({index, place});
    return true;
}

} // namespace osgGpuAnimation
