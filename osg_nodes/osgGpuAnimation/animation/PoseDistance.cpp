// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/PoseDistance.h>

#include <osgGpuAnimation/animation/Pose.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgGpuAnimation
{

PoseDistance::PoseDistance(const AnimationSet& set, const EntryBoxes& entryBoxes) : _set(set)
{
    _points.assign(set.skeleton().jointCount(), {glm::vec3(0.0f)});
    for (std::size_t entry = 0; entry < entryBoxes.size(); ++entry)
    {
        const PaletteEntry& moved = set.palette()[entry];
        const Box& box = entryBoxes[entry];
        if (box.empty() || moved.joint < 0) continue;
        std::vector<glm::vec3>& points = _points[static_cast<std::size_t>(moved.joint)];
        for (int corner = 0; corner < 8; ++corner)
            points.push_back(moved.inverseBind.transformPoint(box.corner(corner)));
    }
}

bool PoseDistance::hasOtherWeights(const std::vector<JointTransform>& a, const std::vector<JointTransform>& b) const
{
    for (std::size_t track = _set.skeleton().jointCount(); track < a.size(); ++track)
        for (std::size_t i = 0; i < MorphWeights::weightsPerBlock; ++i)
        {
            const float weight = a[track].number(i);
            if (!(std::abs(weight - b[track].number(i)) <= 1e-6f * std::max(1.0f, std::abs(weight)))) return true;
        }
    return false;
}

double PoseDistance::between(const std::vector<JointTransform>& a, const std::vector<JointTransform>& b)
{
    if (hasOtherWeights(a, b)) return std::numeric_limits<double>::infinity();
    Pose::jointToModel(_set, a, AffineMatrix(), _jointsOfA);
    Pose::jointToModel(_set, b, AffineMatrix(), _jointsOfB);
    float worst = 0.0f;
    for (std::size_t joint = 0; joint < _points.size(); ++joint)
        for (const glm::vec3& point : _points[joint])
        {
            const glm::vec3 way = _jointsOfA[joint].transformPoint(point) - _jointsOfB[joint].transformPoint(point);
            const float squared = glm::dot(way, way);
            if (!std::isfinite(squared)) return std::numeric_limits<double>::infinity();
            worst = std::max(worst, squared);
        }
    return std::sqrt(static_cast<double>(worst));
}

} // namespace osgGpuAnimation
