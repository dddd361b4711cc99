// SPDX-License-Identifier: MIT
#include "nodes/Walker.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace osgGpuAnimation
{

namespace
{

constexpr double hipHeight = 0.9, bone = 0.45, ankleHeight = 0.08, toeHeight = 0.02, footLength = 0.14;

double smooth(double share)
{
    const double s = std::min(std::max(share, 0.0), 1.0);
    return s * s * (3.0 - 2.0 * s);
}

/// The ball of a foot: metres before the hips and above the ground; and the pitch of the foot, its heel up.
struct FootPose
{
    double forward, height, pitch;
};

FootPose footAt(double phase)
{
    const double length = Walker::speed * Walker::seconds * Walker::duty;
    const double lift = 0.45 * smooth((phase - Walker::heelOff) / (Walker::duty - Walker::heelOff));
    if (phase < Walker::duty) return {footLength + length * (0.5 - phase / Walker::duty), toeHeight, lift};
    const double swing = (phase - Walker::duty) / (1.0 - Walker::duty);
    return {footLength + length * (smooth(swing) - 0.5),
            toeHeight + 0.1 * std::pow(std::sin(glm::pi<double>() * swing), 2.0), 0.45 * (1.0 - smooth(2.0 * swing))};
}

/// The angles about +X of thigh, shank, foot and toes.
std::array<double, 4> anglesOf(const FootPose& foot)
{
    const double up = ankleHeight - toeHeight;
    const double ankleForward = foot.forward - footLength * std::cos(foot.pitch) + up * std::sin(foot.pitch);
    const double ankle = foot.height + footLength * std::sin(foot.pitch) + up * std::cos(foot.pitch);
    const double down = hipHeight - ankle, reach = std::hypot(ankleForward, down);
    const double half = std::acos(reach / (2.0 * bone)); // an isosceles triangle with the knee in front
    const double thigh = -(std::atan2(ankleForward, down) + half), shank = 2.0 * half;
    return {thigh, shank, foot.pitch - thigh - shank, -foot.pitch};
}

Clip makeClip(const Skeleton& skeleton, const std::string& name, double seconds, FootPose (*poseAt)(double))
{
    ClipBuilder builder(skeleton, {});
    for (const std::string side : {"L", "R"})
    {
        std::array<Channel, 4> channels;
        const char* joints[] = {"thigh.", "shank.", "foot.", "toes."};
        for (std::size_t j = 0; j < 4; ++j)
            channels[j] = {
                Channel::Path::Rotation, Channel::Interpolation::Linear, skeleton.findJoint(joints[j] + side), {}, {}};
        constexpr int keys = 300;
        for (int key = 0; key <= keys; ++key)
        {
            const double share = static_cast<double>(key) / keys;
            const std::array<double, 4> angles = anglesOf(poseAt(std::fmod(share + (side == "R" ? 0.5 : 0.0), 1.0)));
            for (std::size_t j = 0; j < 4; ++j)
            {
                channels[j].times.push_back(seconds * share);
                channels[j].values.insert(channels[j].values.end(),
                                          {std::sin(angles[j] / 2.0), 0.0, 0.0, std::cos(angles[j] / 2.0)});
            }
        }
        for (const Channel& channel : channels)
            (void)builder.add(channel);
    }
    return builder.build(name);
}

} // namespace

std::shared_ptr<const AnimationSet> Walker::makeSet()
{
    std::vector<Joint> joints;
    const auto add = [&](const std::string& name, int parent, double x, double y, double z, double bend = 0.0)
    {
        Joint joint;
        joint.name = name;
        joint.parent = parent;
        joint.rest.translation = glm::vec4(glm::dvec4(x, y, z, 0.0));
        joint.rest.rotation = glm::vec4(glm::dvec4(std::sin(bend / 2.0), 0.0, 0.0, std::cos(bend / 2.0)));
        joints.push_back(joint);
        return static_cast<int>(joints.size()) - 1;
    };
    const int hips = add("hips", -1, 0.0, hipHeight, 0.0);
    for (const std::string side : {"L", "R"})
    {
        const int thigh = add("thigh." + side, hips, side == "L" ? 0.1 : -0.1, 0.0, 0.0, -0.2);
        const int shank = add("shank." + side, thigh, 0.0, -bone, 0.0, 0.4);
        const int foot = add("foot." + side, shank, 0.0, -bone, 0.0, -0.2);
        add("toes." + side, foot, 0.0, toeHeight - ankleHeight, footLength);
    }
    add("head", hips, 0.0, 0.8, 0.0);
    const Skeleton skeleton = Skeleton::create(joints).value();
    const auto leg = [](const std::string& name, const std::string& side) {
        return TwoBoneIk{name, "thigh." + side, "shank." + side, "foot." + side};
    };
    AnimationParts parts{skeleton, {}, {}, {}, {}, {leg("left", "L"), leg("right", "R"), LookAt{"head", {"head"}}}};
    parts.clips = {makeClip(skeleton, "Walk", seconds, &footAt),
                   makeClip(skeleton, "Stand", 2.0,
                            [](double) {
                                return FootPose{footLength, toeHeight, 0.0};
                            })};
    return AnimationSet::create(std::move(parts)).value();
}

osg::ref_ptr<AnimatedCharacter> Walker::make()
{
    const osg::ref_ptr<AnimatedCharacter> character = new AnimatedCharacter(makeSet());
    (void)character->setFileToNode(osg::Matrixd::rotate(osg::PI_2, osg::Vec3d(1, 0, 0)));
    return character;
}

} // namespace osgGpuAnimation
