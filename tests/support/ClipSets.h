// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/PoseInstruction.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>

#include <layout.glsl>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

/// A skeleton of one joint at the origin, without a name.
inline Skeleton oneJoint()
{
    return Skeleton::create({Joint()}).value();
}

/// A clip of these channels. The test fails if one is refused.
inline Clip clipOf(const Skeleton& skeleton, const std::vector<Channel>& channels, const char* name = "clip",
                   const std::vector<MorphWeights>& morphs = {})
{
    ClipBuilder builder(skeleton, morphs);
    for (const Channel& channel : channels)
    {
        const Result<void> added = builder.add(channel);
        EXPECT_TRUE(added) << added.error().message;
    }
    return builder.build(name);
}

/// A set without skins.
inline std::shared_ptr<const AnimationSet> setOf(const Skeleton& skeleton, std::vector<Clip> clips = {},
                                                 std::vector<MorphWeights> morphs = {})
{
    return AnimationSet::create({skeleton, {}, {}, std::move(morphs), std::move(clips)}).value();
}

/// A controller that plays a clip, by name or number, or a blend space of its set from that time (seconds) on.
template <typename Clip>
AnimationController playing(std::shared_ptr<const AnimationSet> set, const Clip& clip, double time = 0.0)
{
    AnimationController controller(std::move(set));
    EXPECT_TRUE(controller.play(clip));
    EXPECT_TRUE(time == 0.0 || controller.seek(time));
    return controller;
}

/// Joints one below the other, each a unit along x of its parent and of that scale.
inline std::vector<Joint> chainOf(int count, float scale = 1.0f)
{
    std::vector<Joint> joints;
    for (int joint = 0; joint < count; ++joint)
    {
        joints.push_back({"joint " + std::to_string(joint), joint - 1, {}, joint});
        joints.back().rest.translation.x = 1.0f;
        joints.back().rest.scale = glm::vec4(glm::vec3(scale), 0.0f);
    }
    return joints;
}

/// A clip in which "root" moves from x = 0 to x = 1 and "tip", its child, from x = 0 to x = 2.
struct SlidingClip
{
    const char* name;
    double seconds; ///< 0: a pose, in which both are at x = 5
    std::vector<ClipMarker> markers;
};

inline std::shared_ptr<const AnimationSet> makeSlidingSet(const std::vector<SlidingClip>& sliding)
{
    const Skeleton skeleton = Skeleton::create({{"root", -1, {}, 0}, {"tip", 0, {}, 1}}).value();
    std::vector<Clip> clips;
    for (const SlidingClip& each : sliding)
    {
        std::vector<Channel> channels;
        for (int joint = 0; joint < 2; ++joint)
        {
            Channel slide{Channel::Path::Translation, Channel::Interpolation::Linear, joint, {0.0}, {5.0, 0.0, 0.0}};
            if (each.seconds > 0.0) slide.times = {0.0, each.seconds}, slide.values = {0, 0, 0, 1.0 + joint, 0, 0};
            channels.push_back(slide);
        }
        clips.push_back(clipOf(skeleton, channels, each.name).withMarkers(each.markers).value());
    }
    return setOf(skeleton, std::move(clips));
}

/// One joint whose scale at rest is negative, 0 and positive, and a clip of one second that doubles the first axis,
/// raises the second, halves the third, and turns by 170 degrees about z.
inline std::shared_ptr<const AnimationSet> makeAdditiveExtremes()
{
    Joint joint;
    joint.rest.scale = glm::vec4(-1, 0, 2, 0);
    const Skeleton skeleton = Skeleton::create({joint}).value();
    const double half = 85.0 / 180.0 * std::acos(-1.0);
    const auto linear = Channel::Interpolation::Linear;
    const std::vector<double> turn{0, 0, 0, 1, 0, 0, std::sin(half), std::cos(half)};
    return setOf(skeleton, {clipOf(skeleton, {{Channel::Path::Scale, linear, 0, {0, 1}, {-1, 0, 2, -2, 3, 1}},
                                              {Channel::Path::Rotation, linear, 0, {0, 1}, turn}})});
}

/// The rest pose, and the end of the clip added to it so many times, at most 7, measured from the clip's beginning.
inline PoseInstruction addedTimes(const AnimationSet& set, std::size_t times)
{
    const auto first = static_cast<std::uint32_t>(set.firstKeyframe(0));
    PoseInstruction instruction;
    for (std::size_t i = 0; i < times; ++i)
    {
        instruction.samples[instruction.sampleCount++] = {first, 0.0f, 1.0f, POSE_SAMPLE_REFERENCE};
        instruction.samples[instruction.sampleCount++] = {first + 1, 0.0f, 1.0f, POSE_SAMPLE_ADDITIVE};
    }
    return instruction;
}

} // namespace osgGpuAnimation
