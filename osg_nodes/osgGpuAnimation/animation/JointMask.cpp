// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/JointMask.h>

#include <algorithm>

namespace osgGpuAnimation
{

namespace
{

float clampedWeight(float weight)
{
    return weight > 0.0f ? std::min(weight, 1.0f) : 0.0f;
}

} // namespace

JointMask::JointMask(const AnimationSet& set, float weight)
    : _jointCount(set.skeleton().jointCount()), _firstTracks(firstTracksOfMorphs(set.skeleton(), set.morphs())),
      _weights(set.trackCount(), clampedWeight(weight))
{
}

Result<JointMask> JointMask::subtree(const AnimationSet& set, const std::string& joint, int feather)
{
    const Skeleton& skeleton = set.skeleton();
    const Result<std::size_t> found = skeleton.jointNamed(joint);
    if (!found) return found.error();
    const int root = static_cast<int>(found.value());
    JointMask mask(set);
    const float step = 1.0f / (static_cast<float>(std::max(feather, 0)) + 1.0f);
    const int rootDepth = skeleton.depths()[root];
    std::vector<bool> isInside(skeleton.jointCount(), false);
    for (auto j = static_cast<std::size_t>(root); j < isInside.size(); ++j)
    {
        const int parent = skeleton.joint(j).parent;
        isInside[j] = static_cast<int>(j) == root || (parent >= 0 && isInside[parent]);
        if (isInside[j]) mask.setJoint(j, step * static_cast<float>(skeleton.depths()[j] - rootDepth + 1));
    }
    for (std::size_t morph = 0; morph < set.morphs().size(); ++morph)
    {
        const int owner = skeleton.jointOfSourceNode(set.morphs()[morph].sourceNode);
        if (owner >= 0) mask.setMorph(morph, mask.joint(owner));
    }
    return mask;
}

Result<JointMask> JointMask::joints(const AnimationSet& set, const std::vector<std::string>& names)
{
    JointMask mask(set);
    for (const std::string& name : names)
    {
        const Result<std::size_t> joint = set.skeleton().jointNamed(name);
        if (!joint) return joint.error();
        mask.setJoint(joint.value(), 1.0f);
    }
    return mask;
}

bool JointMask::setJoint(std::size_t joint, float weight)
{
    if (joint >= _jointCount) return false;
    _weights[joint] = clampedWeight(weight);
    return true;
}

bool JointMask::setMorph(std::size_t morph, float weight)
{
    if (morph + 1 >= _firstTracks.size()) return false;
    std::fill(_weights.begin() + _firstTracks[morph], _weights.begin() + (_firstTracks[morph + 1]),
              clampedWeight(weight));
    return true;
}

JointMask JointMask::inverted() const
{
    JointMask mask = *this;
    for (float& weight : mask._weights)
        weight = 1.0f - weight;
    return mask;
}

} // namespace osgGpuAnimation
