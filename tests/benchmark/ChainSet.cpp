// SPDX-License-Identifier: MIT
#include "ChainSet.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>

#include <cmath>

namespace osgGpuAnimation::benchmark
{

namespace
{

constexpr int keyCount = 30;

Channel turning(int joint)
{
    Channel channel;
    channel.path = Channel::Path::Rotation;
    channel.target = joint;
    for (int key = 0; key < keyCount; ++key)
    {
        const double half = 0.3 * std::sin(0.2 * key + 0.7 * joint);
        channel.times.push_back(key / 30.0);
        for (const double value : {std::sin(half), 0.0, 0.0, std::cos(half)})
            channel.values.push_back(value);
    }
    return channel;
}

} // namespace

std::shared_ptr<const AnimationSet> makeChains(std::size_t chains, std::size_t depth)
{
    AnimationParts parts{Skeleton::create({}).value(), {}, {}, {}, {}};
    std::vector<Joint> joints(chains * depth);
    for (std::size_t i = 0; i < joints.size(); ++i)
    {
        joints[i].name = "joint " + std::to_string(i);
        joints[i].parent = i < chains ? -1 : static_cast<int>(i - chains);
        joints[i].rest.translation = glm::vec4(0, 0.1f, 0, 0);
    }
    parts.skeleton = Skeleton::create(std::move(joints)).value();
    ClipBuilder builder(parts.skeleton, parts.morphs);
    for (std::size_t joint = 0; joint < chains * depth; ++joint)
        static_cast<void>(builder.add(turning(static_cast<int>(joint))));
    parts.clips.push_back(builder.build("turning"));
    return AnimationSet::create(std::move(parts)).value();
}

} // namespace osgGpuAnimation::benchmark
