// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/gpu/PoseBatch.h>
#include <osgGpuAnimation/nodes/CrowdInstances.h>

#include <cstdint>
#include <vector>

namespace osgGpuAnimation
{

/// What one camera keeps of a crowd's small instances from frame to frame: by group, the poses of those that it saw
/// when the group's turn was last. They are without root matrices, so that they stay when instances or the camera move.
class CrowdGroups
{
public:
    /// A member that is seen now.
    struct Shown
    {
        std::uint32_t index;  ///< of the crowd's instances
        std::uint32_t number; ///< of its pose in the group's batch
    };
    struct Group
    {
        explicit Group(std::shared_ptr<const AnimationSet> set) : poses(std::move(set)) {}

        PoseBatch poses;
        std::vector<CrowdInstances::Handle> members; ///< by their numbers
        std::vector<Shown> shown;
        std::uint32_t turn = 0; ///< that of the poses
        bool isNew = true;
    };

    /// Has each group whose turn it is taken up anew, from those of `seen` that lie behind the sizePlane. What groups
    /// have is taken out of `seen`: the rest, what came since among it, needs poses of its own.
    void update(const CrowdInstances& instances, const glm::vec4& sizePlane, std::vector<std::uint32_t>& seen);

    const std::vector<Group>& groups() const { return _groups; }

private:
    bool take(const CrowdInstances& instances, std::size_t group, std::uint32_t index);

    std::vector<Group> _groups;
    std::vector<bool> _isTurn;            ///< of the groups, in this frame
    std::vector<std::uint32_t> _numberOf; ///< in its group, by an instance's place: see CrowdInstances::placeOf()
};

} // namespace osgGpuAnimation
