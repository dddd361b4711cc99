// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/authoring/keyframes/PoseDistance.h>

#include <osgGpuAnimation/animation/Pose.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgGpuAnimation
{

PoseDistance::PoseDistance(const AnimationSet& set, const EntryBoxes& entryBoxes, double reach) : _set(set)
{
    _points.assign(set.skeleton().jointCount(), {glm::vec3(0.0f)});
    Pose::jointToModel(set, set.restPose(), AffineMatrix(), _joints);
    for (std::size_t joint = 0; joint < _points.size(); ++joint)
        for (int axis = 0; axis < 3; ++axis)
        {
            glm::vec3 point(0.0f);
            point[axis] = 1.0f;
            // A joint of the scale 0 shows nothing.
            const float scale = glm::length(_joints[joint].transformVector(point));
            if (scale > 0.0f) _points[joint].push_back(point * static_cast<float>(reach) / scale);
        }
    for (std::size_t entry = 0; entry < entryBoxes.size(); ++entry)
    {
        const PaletteEntry& moved = set.palette()[entry];
        const Box& box = entryBoxes[entry];
        if (box.empty() || moved.joint < 0) continue;
        std::vector<glm::vec3>& points = _points[moved.joint];
        for (int corner = 0; corner < 8; ++corner)
            points.push_back(moved.inverseBind.transformPoint(box.corner(corner)));
    }
    _places = _points;
}

bool PoseDistance::hasOtherWeights(const std::vector<JointTransform>& pose) const
{
    for (std::size_t track = _set.skeleton().jointCount(); track < pose.size(); ++track)
        for (std::size_t i = 0; i < MorphWeights::weightsPerBlock; ++i)
        {
            const float weight = _exactPose[track].number(i);
            if (!(std::abs(weight - pose[track].number(i)) <= 1e-6f * std::max(1.0f, std::abs(weight)))) return true;
        }
    return false;
}

void PoseDistance::from(const std::vector<JointTransform>& pose)
{
    _exactPose = pose;
    Pose::jointToModel(_set, pose, AffineMatrix(), _joints);
    for (std::size_t joint = 0; joint < _points.size(); ++joint)
        for (std::size_t i = 0; i < _points[joint].size(); ++i)
            _places[joint][i] = _joints[joint].transformPoint(_points[joint][i]);
}

PoseDistance::Worst PoseDistance::to(const std::vector<JointTransform>& pose)
{
    Worst worst;
    const auto infinite = [&](std::size_t joint) {
        return Worst{std::numeric_limits<double>::infinity(), joint, glm::vec3(0.0f)};
    };
    if (hasOtherWeights(pose)) return infinite(0);
    Pose::jointToModel(_set, pose, AffineMatrix(), _joints);
    float max = 0.0f; // squared
    for (std::size_t joint = 0; joint < _points.size(); ++joint)
        for (std::size_t i = 0; i < _points[joint].size(); ++i)
        {
            const glm::vec3 way = _joints[joint].transformPoint(_points[joint][i]) - _places[joint][i];
            const float squared = glm::dot(way, way);
            if (!std::isfinite(squared)) return infinite(joint);
            if (!(squared > max)) continue;
            max = squared;
            worst = {std::sqrt(static_cast<double>(squared)), joint, _points[joint][i]};
        }
    return worst;
}

} // namespace osgGpuAnimation
