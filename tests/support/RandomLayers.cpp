// SPDX-License-Identifier: MIT
#include "support/RandomLayers.h"

#include "support/RandomSet.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/JointMask.h>

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
