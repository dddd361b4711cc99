// SPDX-License-Identifier: MIT
#include "support/GaitSet.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>

#include <cmath>
#include <string>
#include <utility>

namespace osgGpuAnimation
{

namespace
{

const double pi = std::acos(-1.0);

Joint makeJoint(const std::string& name, int parent, float x, float y, float z)
{
    Joint joint;
    joint.name = name;
    joint.parent = parent;
    joint.rest.translation = glm::vec4(x, y, z, 0);
    return joint;
}

Skeleton makeSkeleton()
{
    std::vector<Joint> joints{makeJoint("hips", -1, 0, 1, 0)};
    for (int i = 0; i < 3; ++i)
        joints.push_back(makeJoint("spine" + std::to_string(i), i, 0.0f, 0.3f, 0.0f));
    for (int leg = 0; leg < 4; ++leg)
        for (int i = 0; i < 3; ++i)
            joints.push_back(makeJoint(
                "leg" + std::to_string(leg) + "_" + std::to_string(i), i == 0 ? 0 : static_cast<int>(joints.size()) - 1,
                i == 0 ? 0.2f * static_cast<float>(leg) - 0.3f : 0.0f, i == 0 ? 0.0f : -0.5f, 0));
    return Skeleton::create(joints).value();
}

/// Rotation about x (or y) by angle(share of the clip).
template <typename Angle>
Channel swing(int joint, double duration, int axis, Angle angle)
{
    Channel channel{Channel::Path::Rotation, Channel::Interpolation::Linear, joint, {}, {}};
    constexpr int keys = 40;
    for (int key = 0; key <= keys; ++key)
    {
        const double half = angle(static_cast<double>(key) / keys) / 2.0;
        channel.times.push_back(duration * key / keys);
        for (int c = 0; c < 3; ++c)
            channel.values.push_back(c == axis ? std::sin(half) : 0.0);
        channel.values.push_back(std::cos(half));
    }
    return channel;
}

Clip makeClip(const Skeleton& skeleton, const char* name, double duration, double reach, bool turns)
{
    ClipBuilder builder(skeleton, {});
    if (turns) (void)builder.add(swing(0, duration, 1, [](double share) { return 2.0 * pi * share; }));
    for (int j = 1; j < static_cast<int>(skeleton.jointCount()); ++j)
    {
        const double offset = 0.5 * (j % 2) + 0.1 * (skeleton.depths()[static_cast<std::size_t>(j)]);
        (void)builder.add(
            swing(j, duration, 0, [&](double share) { return reach * std::sin(2.0 * pi * (share + offset)); }));
    }
    return builder.build(name);
}

} // namespace

std::shared_ptr<const AnimationSet> makeGaitSet()
{
    const Skeleton skeleton = makeSkeleton();
    AnimationParts parts{skeleton, {}, {}, {}, {}};
    parts.clips = {makeClip(skeleton, "Idle", 2.0, 0.1, false), makeClip(skeleton, "Walk", 1.0, 0.4, false),
                   makeClip(skeleton, "Run", 0.6, 0.6, false), makeClip(skeleton, "Turn", 1.5, 0.4, true)};
    return AnimationSet::create(std::move(parts)).value();
}

namespace
{

/// The angles of thigh and shank, about +X, that place a foot in front of the hips and above the ground.
std::pair<double, double> legAngles(double forward, double height)
{
    constexpr double segment = 0.5, hips = 0.9;
    const double down = hips - height, reach = std::sqrt(forward * forward + down * down);
    const double half = std::acos(reach / (2.0 * segment)); // an isosceles triangle with the knee in front
    return {-(std::atan2(forward, down) + half), 2.0 * half};
}

/// Where the foot of a stride is: metres before the hips, metres above the ground.
std::pair<double, double> footPlace(const Stride& stride, double phase)
{
    const double length = stride.speed * stride.duration * stride.duty;
    if (phase < stride.duty) return {length * (0.5 - phase / stride.duty), 0.0};
    const double swing = (phase - stride.duty) / (1.0 - stride.duty);
    return {length * (swing * swing * (3.0 - 2.0 * swing) - 0.5), 0.2 * std::pow(std::sin(pi * swing), 2.0)};
}

Clip makeStrideClip(const Skeleton& skeleton, const Stride& stride)
{
    ClipBuilder builder(skeleton, {});
    for (const char* side : {"L", "R"})
        for (const char* part : {"thigh.", "shank."})
        {
            Channel channel{Channel::Path::Rotation,
                            Channel::Interpolation::Linear,
                            skeleton.findJoint(std::string(part) + side),
                            {},
                            {}};
            constexpr int keys = 200;
            for (int key = 0; key <= keys; ++key)
            {
                const double share = static_cast<double>(key) / keys;
                const auto [forward, height] = footPlace(stride, std::fmod(share + (*side == 'R' ? 0.5 : 0.0), 1.0));
                const auto [thigh, shank] = legAngles(forward, height);
                const double half = (*part == 't' ? thigh : shank) / 2.0;
                channel.times.push_back(stride.duration * share);
                channel.values.insert(channel.values.end(), {std::sin(half), 0.0, 0.0, std::cos(half)});
            }
            (void)builder.add(channel);
        }
    return builder.build(stride.name);
}

} // namespace

std::shared_ptr<const AnimationSet> makeStridingSet(const std::vector<Stride>& strides)
{
    std::vector<Joint> joints{makeJoint("hips", -1, 0.0f, 0.9f, 0.0f)};
    for (const std::string side : {"L", "R"})
    {
        const int thigh = static_cast<int>(joints.size());
        joints.push_back(makeJoint("thigh." + side, 0, side == "L" ? 0.1f : -0.1f, 0.0f, 0.0f));
        joints.push_back(makeJoint("shank." + side, thigh, 0.0f, -0.5f, 0.0f));
        joints.push_back(makeJoint("foot." + side, thigh + 1, 0.0f, -0.5f, 0.0f));
    }
    const Skeleton skeleton = Skeleton::create(joints).value();
    AnimationParts parts{skeleton, {}, {}, {}, {}};
    for (const Stride& stride : strides)
        parts.clips.push_back(makeStrideClip(skeleton, stride));
    return AnimationSet::create(std::move(parts)).value();
}

} // namespace osgGpuAnimation
