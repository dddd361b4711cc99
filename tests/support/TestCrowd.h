// SPDX-License-Identifier: MIT
#pragma once

#include "support/TestCharacter.h"

#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/detail/CrowdDetail.h>

#include <gtest/gtest.h>

#include <vector>

namespace osgGpuAnimation
{

/// A controller of the test character that plays the clip from that time (seconds); null: it shows the rest pose.
inline AnimationController playing(const char* clip, double time = 0.0)
{
    AnimationController controller(testCharacterSet());
    if (!clip) return controller;
    EXPECT_TRUE(controller.play(clip));
    EXPECT_TRUE(controller.seek(time));
    return controller;
}

inline AnimationController still()
{
    return playing(nullptr);
}

/// Adds an instance at each place, all with that controller.
inline std::vector<AnimatedCrowd::Instance> addInstances(AnimatedCrowd& crowd, const std::vector<osg::Matrixd>& places,
                                                         const AnimationController& controller)
{
    std::vector<AnimatedCrowd::Instance> added;
    for (const osg::Matrixd& place : places)
        added.push_back(crowd.add(place, controller).value());
    return added;
}

/// A crowd of the character with an instance at each place, all with the character's controller.
inline osg::ref_ptr<AnimatedCrowd> makeCrowd(const AnimatedCharacter& character,
                                             const std::vector<osg::Matrixd>& places = {osg::Matrixd()})
{
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(character);
    addInstances(*crowd, places, character.getController());
    return crowd;
}

/// The number of instances with a controller.
inline std::size_t controllerCount(const AnimatedCrowd& crowd)
{
    std::size_t count = 0;
    for (std::size_t index = 0; index < crowd.getNumInstances(); ++index)
        count += CrowdDetail::instances(crowd).hasController(index) ? 1 : 0;
    return count;
}

} // namespace osgGpuAnimation
