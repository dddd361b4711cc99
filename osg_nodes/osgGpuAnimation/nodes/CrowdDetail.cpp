// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/CrowdDetail.h>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

namespace
{

struct LevelIndices
{
    int level;
    std::vector<std::uint32_t> indices;
};

/// The longest that a unit of the character's own space becomes.
float largestScale(const AffineMatrix& matrix)
{
    float largest = 0.0f;
    for (int axis = 0; axis < 3; ++axis)
    {
        const float x = matrix.rows[0][axis], y = matrix.rows[1][axis], z = matrix.rows[2][axis];
        largest = std::max(largest, x * x + y * y + z * z);
    }
    return std::sqrt(largest);
}

} // namespace

int CrowdDetail::levelOf(std::uint32_t index) const
{
    const glm::vec4& sphere = _instances.sphere(index);
    return _scale.level(glm::vec3(sphere), sphere.w, largestScale(_instances.rootMatrix(index)));
}

void CrowdDetail::sort(std::vector<std::uint32_t>& indices, std::vector<Run>& outRuns) const
{
    static thread_local std::vector<LevelIndices> levels; // keeps its storage from cull to cull
    for (LevelIndices& level : levels)
        level.indices.clear();
    std::size_t last = 0;
    for (const std::uint32_t index : indices)
    {
        const int level = levelOf(index);
        for (std::size_t i = 0; i < levels.size() && (last >= levels.size() || levels[last].level != level); ++i)
            last = i;
        if (last >= levels.size() || levels[last].level != level)
        {
            last = levels.size();
            levels.push_back({level, {}});
        }
        levels[last].indices.push_back(index);
    }
    std::sort(levels.begin(), levels.end(),
              [](const LevelIndices& a, const LevelIndices& b) { return a.level < b.level; });
    indices.clear();
    outRuns.clear();
    for (const LevelIndices& level : levels)
    {
        if (level.indices.empty()) continue;
        indices.insert(indices.end(), level.indices.begin(), level.indices.end());
        outRuns.push_back({level.level, level.indices.size()});
    }
}

} // namespace osgGpuAnimation
