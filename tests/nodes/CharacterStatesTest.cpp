// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/callbacks/CharacterStates.h>

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <gtest/gtest.h>

#include <thread>

namespace osgGpuAnimation
{

namespace
{

struct NoState
{
};

// The thread sanitizer sees an access without the lock.
TEST(CharacterStatesTest, camerasThatCullConcurrentlyKeepTheSmallestDistance)
{
    const osg::ref_ptr<AnimatedCharacter> character = new AnimatedCharacter;
    CharacterStates<NoState> states;
    const auto cull = [&](double nearest)
    {
        for (int more = 20000; more >= 0; --more)
            states.sawFrom(*character, nearest + more, 1);
    };
    std::thread cameras[] = {std::thread(cull, 1.0), std::thread(cull, 2.0)};
    for (std::thread& camera : cameras)
        camera.join();
    EXPECT_TRUE(states.isWithin(*character, 1.0, 2));
    EXPECT_FALSE(states.isWithin(*character, 0.9, 2));
    EXPECT_FALSE(states.isWithin(*character, 1.0, 3)) << "no camera has drawn it in the last frame";
}

} // namespace

} // namespace osgGpuAnimation
