// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/Skeleton.h>

#include <osgGpuAnimation/math/Rotation.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <optional>

namespace osgGpuAnimation
{

namespace
{

std::string describe(const std::vector<Joint>& joints, std::size_t index)
{
    return "joint " + std::to_string(index) + " \"" + joints[index].name + "\"";
}

std::optional<Error> findFault(const std::vector<Joint>& joints)
{
    const auto count = static_cast<std::int64_t>(joints.size());
    for (std::size_t i = 0; i < joints.size(); ++i)
    {
        const Joint& joint = joints[i];
        if (joint.parent < -1 || joint.parent >= count)
            return Error{describe(joints, i) + ": parent " + std::to_string(joint.parent) + " is not one of " +
                         std::to_string(count) + " joints"};
        if (!joint.rest.isFinite()) return Error{describe(joints, i) + ": its rest transform is not finite"};
    }
    return std::nullopt;
}

/// The depth of each joint; ends at the first joint on or below a cycle and leaves it and the following ones at -1.
std::vector<int> findDepths(const std::vector<Joint>& joints)
{
    std::vector<int> depths(joints.size(), -1);
    std::vector<std::size_t> chain; // from a joint up to the first ancestor of known depth
    for (std::size_t i = 0; i < joints.size(); ++i)
    {
        chain.clear();
        int above = static_cast<int>(i);
        for (; above >= 0 && depths[above] < 0; above = joints[chain.back()].parent)
        {
            if (chain.size() == joints.size()) return depths;
            chain.push_back(static_cast<std::size_t>(above));
        }
        int depth = above < 0 ? -1 : depths[above];
        for (; !chain.empty(); chain.pop_back())
            depths[chain.back()] = ++depth;
    }
    return depths;
}

} // namespace

Result<Skeleton> Skeleton::create(std::vector<Joint> joints)
{
    if (std::optional<Error> fault = findFault(joints)) return *fault;
    const std::vector<int> depths = findDepths(joints);
    const auto lost = std::find(depths.begin(), depths.end(), -1);
    if (lost != depths.end())
        return Error{describe(joints, static_cast<std::size_t>(lost - depths.begin())) +
                     ": its chain of parents runs in a circle"};

    std::vector<std::size_t> order(joints.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return depths[a] < depths[b]; });

    Skeleton skeleton;
    skeleton._jointOfInput.resize(joints.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        skeleton._jointOfInput[order[i]] = static_cast<int>(i);
    for (std::size_t i = 0; i < order.size(); ++i)
    {
        Joint& joint = joints[order[i]];
        // A parent is at an earlier level, so its new index is known.
        if (joint.parent >= 0) joint.parent = skeleton._jointOfInput[joint.parent];
        joint.rest.translation.w = joint.rest.scale.w = 0.0f;
        joint.rest.rotation = glm::vec4(Rotation::unit(glm::dvec4(joint.rest.rotation)));
        skeleton._depths.push_back(depths[order[i]]);
        if (joint.sourceNode >= 0) skeleton._jointOfSourceNode.emplace(joint.sourceNode, static_cast<int>(i));
        skeleton._joints.push_back(std::move(joint));
    }
    return skeleton;
}

std::size_t Skeleton::levelCount() const
{
    return _depths.empty() ? 0 : static_cast<std::size_t>(_depths.back()) + 1;
}

int Skeleton::jointOfSourceNode(int node) const
{
    const auto found = _jointOfSourceNode.find(node);
    return found == _jointOfSourceNode.end() ? -1 : found->second;
}

int Skeleton::findJoint(const std::string& name) const
{
    for (std::size_t i = 0; i < _joints.size(); ++i)
        if (_joints[i].name == name) return static_cast<int>(i);
    return -1;
}

Result<std::size_t> Skeleton::jointNamed(const std::string& name) const
{
    return indexNamed("joint", name, _joints);
}

float longestJoint(const Skeleton& skeleton)
{
    float longest = 0.0f;
    for (const Joint& joint : skeleton.joints())
        longest = std::max(longest, glm::length(glm::vec3(joint.rest.translation)));
    return longest;
}

std::vector<std::size_t> firstTracksOfMorphs(const Skeleton& skeleton, const std::vector<MorphWeights>& morphs)
{
    std::vector<std::size_t> tracks{skeleton.jointCount()};
    for (const MorphWeights& morph : morphs)
        tracks.push_back(tracks.back() + morph.blockCount());
    return tracks;
}

std::vector<JointTransform> restPose(const Skeleton& skeleton, const std::vector<MorphWeights>& morphs)
{
    std::vector<JointTransform> tracks;
    for (const Joint& joint : skeleton.joints())
        tracks.push_back(joint.rest);
    for (const MorphWeights& morph : morphs)
    {
        const std::size_t first = tracks.size();
        tracks.resize(first + morph.blockCount(), {glm::vec4(0.0f), glm::vec4(0.0f), glm::vec4(0.0f)});
        for (std::size_t i = 0; i < morph.defaults.size(); ++i)
            tracks[first + i / MorphWeights::weightsPerBlock].number(i % MorphWeights::weightsPerBlock) =
                morph.defaults[i];
    }
    return tracks;
}

std::vector<JointTransform> restKeyframes(const std::vector<JointTransform>& rest, std::size_t jointCount,
                                          std::size_t transformsPerTrack, std::size_t keyframeCount)
{
    std::vector<JointTransform> data;
    data.reserve(rest.size() * transformsPerTrack * keyframeCount);
    for (std::size_t k = 0; k < keyframeCount; ++k)
        for (std::size_t track = 0; track < rest.size(); ++track)
        {
            data.push_back(rest[track]);
            if (transformsPerTrack == 1) continue;
            if (track < jointCount) data.back().translation.w = 1.0f; // slerped, see Clip
            data.insert(data.end(), 2, noTangent);
        }
    return data;
}

} // namespace osgGpuAnimation
