// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/CrowdInstances.h>
#include <osgGpuAnimation/nodes/DetailScale.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgGpuAnimation
{

/// Levels of detail of a crowd's instances as one camera sees them.
class CrowdDetail
{
public:
    /// Instances of one level, one after another.
    struct Run
    {
        int level;
        std::size_t count;
    };

    CrowdDetail(const CrowdInstances& instances, const DetailScale& scale) : _instances(instances), _scale(scale) {}

    bool isOn() const { return _scale.isOn(); }
    /// Puts those of one level together, the finest first; otherwise they stay in their order.
    void sort(std::vector<std::uint32_t>& indices, std::vector<Run>& outRuns) const;

private:
    int levelOf(std::uint32_t index) const;

    const CrowdInstances& _instances;
    const DetailScale& _scale;
};

} // namespace osgGpuAnimation
