// SPDX-License-Identifier: MIT
#pragma once

#include "support/ClipSets.h"
#include "support/ReferencePose.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/Channel.h>

#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

/// A random character from a seed: a hierarchy, morphs, and one clip of channels of every kind, each with its own
/// times. Keeps the channels, so that ReferencePose can compute the expected pose.
struct RandomCharacter
{
    struct Options
    {
        int joints = 8;
        bool splines = true;
        bool steps = true;
        bool chain = false; ///< each joint is the child of the previous one
        double swing = 1.0; ///< largest rotation from one key to the next, as a fraction of a half turn
        double reach = 1.0; ///< size of the translations
    };

    std::vector<Joint> joints;
    std::vector<MorphWeights> morphs;
    std::vector<Channel> channels;

    RandomCharacter(unsigned seed, const Options& options) : _random(seed)
    {
        for (int j = 0; j < options.joints; ++j)
            joints.push_back(makeJoint(j, options));
        for (std::size_t count : {5u, 14u})
            morphs.push_back({"morph", -1, std::vector<float>(count, 0.25f)});
        for (int j = 0; j < options.joints; ++j)
            for (auto path : {Channel::Path::Translation, Channel::Path::Rotation, Channel::Path::Scale})
                if (number(0.0, 1.0) < 0.8) channels.push_back(makeChannel(path, j, options));
        for (int m = 0; m < 2; ++m)
            channels.push_back(makeChannel(Channel::Path::Weights, m, options));
    }

    double number(double from, double to) { return std::uniform_real_distribution<double>(from, to)(_random); }
    int whole(int from, int to) { return std::uniform_int_distribution<int>(from, to)(_random); }

    std::size_t width(const Channel& channel) const
    {
        if (channel.path == Channel::Path::Weights)
            return morphs[static_cast<std::size_t>(channel.target)].defaults.size();
        return channel.path == Channel::Path::Rotation ? 4 : 3;
    }

    /// The joints are in level order only in a chain: jointOfInput maps them to the skeleton's.
    Skeleton skeleton() const { return Skeleton::create(joints).value(); }

    Clip clip(const Skeleton& skeleton) const
    {
        std::vector<Channel> mapped = channels;
        for (Channel& channel : mapped)
            if (channel.path != Channel::Path::Weights)
                channel.target = skeleton.jointOfInput(static_cast<std::size_t>(channel.target));
        return clipOf(skeleton, mapped, "random", morphs);
    }

    /// The expected value of a joint or morph.
    reference::Numbers expected(Channel::Path path, int target, double time) const
    {
        for (const Channel& channel : channels)
            if (channel.path == path && channel.target == target)
                return reference::evaluate(channel, width(channel), time);
        const JointTransform& rest = joints[static_cast<std::size_t>(target)].rest;
        if (path == Channel::Path::Rotation)
            return reference::normalized({static_cast<double>(rest.rotation.x), static_cast<double>(rest.rotation.y),
                                          static_cast<double>(rest.rotation.z), static_cast<double>(rest.rotation.w)});
        const glm::vec4& v = path == Channel::Path::Translation ? rest.translation : rest.scale;
        return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
    }

    /// The expected transform of every joint, by input index.
    std::vector<glm::dmat4> expectedJointToModel(double time) const
    {
        std::vector<glm::dmat4> result;
        for (int j = 0; j < static_cast<int>(joints.size()); ++j)
        {
            const glm::dmat4 local = reference::localMatrix(expected(Channel::Path::Translation, j, time),
                                                            expected(Channel::Path::Rotation, j, time),
                                                            expected(Channel::Path::Scale, j, time));
            const int parent = joints[static_cast<std::size_t>(j)].parent;
            result.push_back(parent < 0 ? local : result[static_cast<std::size_t>(parent)] * local);
        }
        return result;
    }

    /// Key times, moments just before and after them, and times in between.
    std::vector<double> interestingTimes(int random)
    {
        std::vector<double> times{-1.0, 0.0, 100.0};
        for (const Channel& channel : channels)
            for (double time : channel.times)
                times.insert(times.end(), {time, time - 1e-4, time + 1e-4});
        for (int i = 0; i < random; ++i)
            times.push_back(number(0.0, 4.0));
        return times;
    }

private:
    Joint makeJoint(int index, const Options& options)
    {
        Joint joint;
        joint.name = "joint" + std::to_string(index);
        joint.parent = options.chain ? index - 1 : index == 0 ? -1 : whole(-1, index - 1);
        const auto r = [&] { return static_cast<float>(number(-1.0, 1.0)); };
        joint.rest.translation = glm::vec4(glm::vec3(r(), r(), r()) * static_cast<float>(options.reach), 0.0f);
        joint.rest.rotation = glm::vec4(r(), r(), r(), 1.0f);
        return joint;
    }

    std::vector<double> makeTimes()
    {
        std::vector<double> times;
        double time = number(0.0, 1.0) < 0.5 ? 0.0 : number(0.0, 1.0);
        for (int keys = whole(1, 6); keys > 0; --keys)
        {
            // Some times are quarters, so that channels share them; all are floats, as in a file.
            const double wanted = number(0.0, 1.0) < 0.5 ? std::ceil(time * 4.0) / 4.0 : time;
            times.push_back(static_cast<double>(static_cast<float>(wanted)));
            time = times.back() + number(0.05, 0.8);
        }
        return times;
    }

    Channel makeChannel(Channel::Path path, int target, const Options& options)
    {
        Channel channel;
        channel.path = path;
        channel.target = target;
        const int kind = whole(0, 2);
        channel.interpolation = kind == 0 && options.splines ? Channel::Interpolation::CubicSpline
                                : kind == 1 && options.steps ? Channel::Interpolation::Step
                                                             : Channel::Interpolation::Linear;
        channel.times = makeTimes();
        reference::Numbers quaternion{0.0, 0.0, 0.0, 1.0};
        for (std::size_t key = 0; key < channel.times.size(); ++key)
        {
            const bool cubic = channel.interpolation == Channel::Interpolation::CubicSpline;
            if (cubic) appendRandom(channel, 0.6 * options.swing);
            if (path == Channel::Path::Rotation)
                appendRotation(channel, quaternion, options, !cubic && whole(0, 1) == 1);
            else if (path == Channel::Path::Scale)
                for (int c = 0; c < 3; ++c)
                    channel.values.push_back(number(0.7, 1.4));
            else
                appendRandom(channel, options.reach);
            if (cubic) appendRandom(channel, 0.6 * options.swing);
        }
        return channel;
    }

    void appendRandom(Channel& channel, double size)
    {
        for (std::size_t c = 0; c < width(channel); ++c)
            channel.values.push_back(static_cast<double>(static_cast<float>(number(-size, size))));
    }

    void appendRotation(Channel& channel, reference::Numbers& quaternion, const Options& options, bool opposite)
    {
        for (double& c : quaternion)
            c += options.swing * number(-0.7, 0.7);
        quaternion = reference::normalized(quaternion);
        for (double& c : quaternion)
            c = static_cast<double>(static_cast<float>(c));
        for (double c : quaternion)
            channel.values.push_back(opposite ? -c : c);
    }

    std::mt19937 _random;
};

} // namespace osgGpuAnimation
