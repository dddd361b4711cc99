// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/math/Box.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace osgGpuAnimation
{

/// The distance between two poses of a set in the model's units, see compactClips().
class PoseDistance
{
public:
    /// The point that is farthest from its place in the exact pose.
    struct Worst
    {
        double distance = 0.0; ///< infinite if morph weights differ by more than rounding or a number is not finite
        std::size_t joint = 0;
        glm::vec3 point{0.0f}; ///< in the joint's space
    };

    /// entryBoxes: one box per palette entry. reach: how far something may be attached from a joint, in the model's
    /// units. The set must outlive this object.
    PoseDistance(const AnimationSet& set, const EntryBoxes& entryBoxes, double reach) : _set(set)
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

    /// pose: one transform per track, for the next calls of to(), which compare with it.
    void from(const std::vector<JointTransform>& pose)
    {
        _exactPose = pose;
        Pose::jointToModel(_set, pose, AffineMatrix(), _joints);
        for (std::size_t joint = 0; joint < _points.size(); ++joint)
            for (std::size_t i = 0; i < _points[joint].size(); ++i)
                _places[joint][i] = _joints[joint].transformPoint(_points[joint][i]);
    }

    Worst to(const std::vector<JointTransform>& pose)
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

    /// The joints' matrices in that pose.
    const std::vector<AffineMatrix>& jointToModel() const { return _joints; }

    /// The points of a joint in its own space: its origin, points on its axes at the reach, and the corners of its
    /// entries' boxes.
    const std::vector<glm::vec3>& points(std::size_t joint) const { return _points[joint]; }

private:
    bool hasOtherWeights(const std::vector<JointTransform>& pose) const
    {
        for (std::size_t track = _set.skeleton().jointCount(); track < pose.size(); ++track)
            for (std::size_t i = 0; i < MorphWeights::weightsPerBlock; ++i)
            {
                const float weight = _exactPose[track].number(i);
                if (!(std::abs(weight - pose[track].number(i)) <= 1e-6f * std::max(1.0f, std::abs(weight))))
                    return true;
            }
        return false;
    }

    const AnimationSet& _set;
    std::vector<std::vector<glm::vec3>> _points; ///< of each joint
    std::vector<JointTransform> _exactPose;
    std::vector<std::vector<glm::vec3>> _places; ///< of _points in the exact pose, in the model
    std::vector<AffineMatrix> _joints;
};

} // namespace osgGpuAnimation
