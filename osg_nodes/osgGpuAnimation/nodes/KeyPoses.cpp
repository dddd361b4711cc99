// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/KeyPoses.h>

#include <osgGpuAnimation/animation/Pose.h>

#include <algorithm>

namespace osgGpuAnimation
{

namespace
{

constexpr std::size_t poolSize = 64;

using Joints = std::vector<glm::vec3>;

Joints jointsOf(const AnimationSet& set, const PoseInstruction& instruction)
{
    std::vector<JointTransform> tracks;
    std::vector<AffineMatrix> jointToModel;
    Pose::mix(set, instruction, tracks);
    Pose::jointToModel(set, tracks, AffineMatrix(), jointToModel);
    Joints joints;
    glm::vec3 mean(0.0f);
    for (const AffineMatrix& joint : jointToModel)
    {
        joints.push_back(joint.transformPoint(glm::vec3(0.0f)));
        mean += joints.back() / static_cast<float>(jointToModel.size());
    }
    for (glm::vec3& joint : joints)
        joint -= mean;
    // What turns or morphs without moving a joint counts a little.
    for (const JointTransform& track : tracks)
        joints.push_back(1e-3f * (glm::vec3(track.rotation) + glm::vec3(track.scale)));
    return joints;
}

float distanceOf(const Joints& a, const Joints& b)
{
    float distance = 0.0f;
    for (std::size_t joint = 0; joint < a.size(); ++joint)
        distance += glm::distance(a[joint], b[joint]);
    return distance;
}

std::vector<PoseInstruction> poolOf(const AnimationSet& set)
{
    std::vector<PoseInstruction> pool;
    const std::size_t clips = set.clips().size();
    const std::size_t perClip = clips == 0 ? 0 : std::clamp<std::size_t>(poolSize / clips, 1, 16);
    const std::size_t stride = std::max<std::size_t>(clips / poolSize, 1);
    for (std::size_t clip = 0; clip < clips; clip += stride)
        for (std::size_t time = 0; time < perClip; ++time)
        {
            const double share = (static_cast<double>(time) + 0.5) / static_cast<double>(perClip);
            PoseInstruction instruction;
            instruction.samples[0] = set.sampleAt(static_cast<int>(clip), share * set.clips()[clip].duration());
            pool.push_back(instruction);
        }
    return pool;
}

} // namespace

std::vector<PoseInstruction> keyPoses(const AnimationSet& set, std::size_t count)
{
    std::vector<PoseInstruction> chosen{PoseInstruction()};
    const std::vector<PoseInstruction> pool = poolOf(set);
    std::vector<Joints> joints;
    std::vector<float> distances;
    Joints last = jointsOf(set, chosen.front());
    for (const PoseInstruction& instruction : pool)
    {
        joints.push_back(jointsOf(set, instruction));
        distances.push_back(distanceOf(joints.back(), last));
    }
    while (chosen.size() < count && !pool.empty())
    {
        const auto farthest = std::max_element(distances.begin(), distances.end());
        if (!(*farthest > 0.0f)) break;
        const auto index = static_cast<std::size_t>(farthest - distances.begin());
        chosen.push_back(pool[index]);
        for (std::size_t other = 0; other < pool.size(); ++other)
            distances[other] = std::min(distances[other], distanceOf(joints[other], joints[index]));
    }
    return chosen;
}

} // namespace osgGpuAnimation
