// SPDX-License-Identifier: MIT
#include "Motion.h"
#include "GltfDocument.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation::scenes
{

namespace
{

bool rests(const std::vector<glm::dvec3>& values, const glm::dvec3& rest)
{
    return std::all_of(values.begin(), values.end(),
                       [&](const glm::dvec3& value) { return glm::distance(value, rest) < 1e-7; });
}

bool rests(const std::vector<glm::dquat>& values, const glm::dquat& rest)
{
    return std::all_of(values.begin(), values.end(),
                       [&](const glm::dquat& value) { return std::abs(glm::dot(value, rest)) > 1.0 - 1e-12; });
}

/// q and -q are the same turn; neighbours of one sign are kinder to players that do not look.
void alignSigns(std::vector<glm::dquat>& values)
{
    for (std::size_t i = 1; i < values.size(); ++i)
        if (glm::dot(values[i - 1], values[i]) < 0.0) values[i] = -values[i];
}

} // namespace

void addClip(GltfDocument& document, const Rig& rig, const std::vector<int>& nodeOfJoint, const Motion& motion)
{
    std::vector<double> times;
    std::vector<RigPose> poses;
    for (int sample = 0; sample <= motion.samples; ++sample)
    {
        times.push_back(motion.seconds * sample / motion.samples);
        poses.emplace_back(rig);
        motion.pose(static_cast<double>(sample % motion.samples) / motion.samples, poses.back());
    }

    const int input = document.addTimes(times);
    const int animation = document.addAnimation(motion.name);
    for (const MotionMarker& marker : motion.markers)
        document.addMarker(animation, motion.seconds * marker.phase, marker.name);
    for (std::size_t i = 0; i < rig.joints().size(); ++i)
    {
        const int joint = static_cast<int>(i);
        std::vector<glm::dvec3> translations;
        std::vector<glm::dquat> rotations;
        for (const RigPose& pose : poses)
        {
            translations.push_back(pose.localTranslation(joint));
            rotations.push_back(pose.localRotation(joint));
        }
        alignSigns(rotations);
        if (!rests(translations, rig.restTranslation(joint)))
            document.addTranslations(animation, nodeOfJoint[joint], input, translations);
        if (!rests(rotations, rig.restRotation(joint)))
            document.addRotations(animation, nodeOfJoint[joint], input, rotations);
    }
}

} // namespace osgGpuAnimation::scenes
