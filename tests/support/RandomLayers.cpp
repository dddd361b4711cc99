// SPDX-License-Identifier: MIT
#include "support/RandomLayers.h"

#include "support/RandomSet.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/JointMask.h>
#include <osgGpuAnimation/animation/JointPose.h>

#include <layout.glsl>

namespace osgGpuAnimation
{

namespace
{

double number(std::mt19937& random, double low, double high)
{
    return std::uniform_real_distribution<double>(low, high)(random);
}

int whole(std::mt19937& random, int low, int high)
{
    return std::uniform_int_distribution<int>(low, high)(random);
}

BlendSample randomSample(const AnimationSet& set, std::mt19937& random)
{
    const int clip = whole(random, 0, static_cast<int>(set.clips().size()) - 1);
    const double time = number(random, -0.1, 1.1) * set.clips()[static_cast<std::size_t>(clip)].duration();
    return instructionAt(set, clip, time).samples[0];
}

} // namespace

void addRandomMasks(const AnimationSet& set, std::mt19937& random)
{
    const auto joints = static_cast<int>(set.skeleton().jointCount());
    for (int i = 0; i < 4; ++i)
    {
        const auto joint = static_cast<std::size_t>(whole(random, 0, joints - 1));
        const Result<JointMask> tree = JointMask::subtree(set, set.skeleton().joint(joint).name, whole(random, 0, 3));
        if (tree) (void)set.addMask(tree.value().weights());
        JointMask mask(set);
        for (std::size_t j = 0; j < set.skeleton().jointCount(); ++j)
            mask.setJoint(j, static_cast<float>(number(random, -0.3, 1.3)));
        for (std::size_t m = 0; m < set.morphs().size(); ++m)
            mask.setMorph(m, static_cast<float>(number(random, 0.0, 1.0)));
        (void)set.addMask(mask.weights());
    }
}

std::shared_ptr<const JointPose> randomPose(const std::shared_ptr<const AnimationSet>& set, std::mt19937& random)
{
    const auto pose = std::make_shared<JointPose>(set);
    const auto any = [&] { return static_cast<float>(number(random, -1.0, 1.0)); };
    for (std::size_t joint = 0; joint < set->skeleton().jointCount(); ++joint)
    {
        const int parts = whole(random, 0, 11); // three of four joints have something
        if ((parts & 1) != 0) pose->setTranslation(joint, {any(), any(), any()});
        if ((parts & 2) != 0) pose->setRotation(joint, glm::quat(any(), any(), any(), any()));
        if ((parts & 4) != 0) pose->setScale(joint, glm::vec3(1.0f) + 0.3f * glm::vec3(any(), any(), any()));
    }
    for (std::size_t morph = 0; morph < set->morphs().size(); ++morph)
        for (std::size_t target = 0; target < set->morphs()[morph].defaults.size(); ++target)
            if (whole(random, 0, 1) == 0) pose->setMorphWeight(morph, target, 2.0f * any());
    return pose;
}

void addRandomPoses(const std::shared_ptr<const AnimationSet>& set, std::mt19937& random, PoseInstruction& instruction)
{
    for (std::size_t i = 0; i < instruction.sampleCount; ++i)
    {
        BlendSample& sample = instruction.samples[i];
        if ((sample.control & POSE_SAMPLE_REFERENCE) != 0 || whole(random, 0, 2) != 0) continue;
        sample.control = (sample.control & ~POSE_SAMPLE_SPLINE) | POSE_SAMPLE_POSED;
        sample.keyframe = static_cast<std::uint32_t>(instruction.poses.size());
        sample.alpha = 0.0f;
        instruction.poses.push_back(randomPose(set, random));
    }
}

PoseInstruction randomLayers(const AnimationSet& set, std::mt19937& random)
{
    PoseInstruction out;
    out.sampleCount = 0;
    const auto randomMask = [&]
    {
        const int mask = whole(random, 0, 1) == 0 ? 0 : whole(random, 0, static_cast<int>(set.masks().count()));
        return static_cast<std::uint32_t>(mask) << POSE_SAMPLE_MASK_SHIFT;
    };
    const int priorityCount = whole(random, 0, 3);
    for (int priority = 0; priority < priorityCount; ++priority)
        for (int count = whole(random, 1, 4), i = 0; i < count; ++i)
        {
            BlendSample& sample = out.samples[out.sampleCount++] = randomSample(set, random);
            sample.weight = whole(random, 0, 3) == 0 ? 1.0f : static_cast<float>(number(random, 0.0, 0.8));
            sample.control |= randomMask() | (i == 0 && priority > 0 ? POSE_SAMPLE_ABOVE : 0u);
        }
    for (int count = whole(random, 0, 2); count > 0; --count)
    {
        BlendSample& reference = out.samples[out.sampleCount++] =
            whole(random, 0, 1) == 0 ? BlendSample() : randomSample(set, random);
        BlendSample& sample = out.samples[out.sampleCount++] = randomSample(set, random);
        const std::uint32_t mask = randomMask();
        reference.weight = sample.weight = static_cast<float>(number(random, 0.0, 1.0));
        reference.control |= POSE_SAMPLE_REFERENCE | mask;
        sample.control |= POSE_SAMPLE_ADDITIVE | mask;
    }
    if (out.sampleCount == 0) out.sampleCount = 1;
    return out;
}

} // namespace osgGpuAnimation
