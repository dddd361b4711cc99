// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/FadePace.h>

#include <osgGpuAnimation/animation/Pose.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

constexpr std::size_t poseCount = 48;
using Places = std::vector<glm::dvec3>; ///< of the joints' origins

double farthest(const Places& a, const Places& b)
{
    double distance = 0.0;
    for (std::size_t joint = 0; joint < a.size(); ++joint)
        distance = std::max(distance, glm::distance(a[joint], b[joint]));
    return distance;
}

std::vector<Places> posesOf(const AnimationSet& set, std::size_t clip)
{
    std::vector<Places> poses;
    std::vector<JointTransform> tracks;
    std::vector<AffineMatrix> joints;
    for (std::size_t i = 0; i <= poseCount; ++i)
    {
        PoseInstruction instruction;
        instruction.samples[0] =
            set.sampleAt(static_cast<int>(clip), set.clips()[clip].duration() * static_cast<double>(i) / poseCount);
        Pose::mix(set, instruction, tracks);
        Pose::jointToModel(set, tracks, AffineMatrix(), joints);
        Places places;
        for (const AffineMatrix& joint : joints)
            places.emplace_back(joint.transformPoint(glm::vec3(0.0f)));
        poses.push_back(std::move(places));
    }
    return poses;
}

/// Of its fastest joint: units a second.
double speedOf(const std::vector<Places>& poses, double duration)
{
    double step = 0.0;
    for (std::size_t i = 1; i < poses.size(); ++i)
        step = std::max(step, farthest(poses[i - 1], poses[i]));
    return duration > 0.0 ? step * poseCount / duration : 0.0;
}

} // namespace

double leastFadeSeconds(const AnimationSet& set, std::size_t clip, std::size_t otherClip, Sync sync)
{
    if (clip >= set.clips().size() || otherClip >= set.clips().size()) return 0.0;
    const std::vector<Places> poses = posesOf(set, clip), otherPoses = posesOf(set, otherClip);
    const double speed =
        std::max(speedOf(poses, set.clips()[clip].duration()), speedOf(otherPoses, set.clips()[otherClip].duration()));
    double distance = 0.0;
    for (std::size_t i = 0; i < poses.size(); ++i)
        for (std::size_t other = 0; other < otherPoses.size(); ++other)
            if (sync == Sync::Start || i == other) distance = std::max(distance, farthest(poses[i], otherPoses[other]));
    if (distance == 0.0) return 0.0;
    constexpr double mostAdded = 0.5;
    return speed > 0.0 ? distance / (mostAdded * speed) : std::numeric_limits<double>::infinity();
}

} // namespace osgGpuAnimation
