// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>

#include <gtest/gtest.h>

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

} // namespace osgGpuAnimation
