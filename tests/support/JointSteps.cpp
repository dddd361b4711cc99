// SPDX-License-Identifier: MIT
#include "support/JointSteps.h"

#include <osgGpuAnimation/animation/Pose.h>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>

namespace osgGpuAnimation
{

std::vector<glm::vec3> jointPlaces(const AnimationController& controller)
{
    std::vector<JointTransform> tracks;
    std::vector<AffineMatrix> joints;
    Pose::mix(controller.set(), controller.instruction(), tracks);
    Pose::jointToModel(controller.set(), tracks, AffineMatrix(), joints);
    std::vector<glm::vec3> places;
    for (const AffineMatrix& joint : joints)
        places.push_back(joint.transformPoint(glm::vec3(0.0f)));
    return places;
}

double largestStep(const std::vector<glm::vec3>& before, const std::vector<glm::vec3>& after)
{
    float largest = 0.0f;
    for (std::size_t i = 0; i < before.size(); ++i)
        largest = std::max(largest, glm::distance(before[i], after[i]));
    return static_cast<double>(largest);
}

double stepOfClip(const std::shared_ptr<const AnimationSet>& set, std::size_t clip, int frames)
{
    AnimationController controller(set);
    EXPECT_TRUE(controller.play(clip));
    double largest = 0.0;
    for (int i = 0; i < frames; ++i)
    {
        const std::vector<glm::vec3> before = jointPlaces(controller);
        controller.advance(frameSeconds);
        largest = std::max(largest, largestStep(before, jointPlaces(controller)));
    }
    return largest;
}

} // namespace osgGpuAnimation
