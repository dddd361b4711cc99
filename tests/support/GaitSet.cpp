// SPDX-License-Identifier: MIT
#include "support/GaitSet.h"

#include <osgGpuAnimation/animation/ClipBuilder.h>

#include <cmath>

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

} // namespace osgGpuAnimation
