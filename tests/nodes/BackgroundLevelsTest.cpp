// SPDX-License-Identifier: MIT
#include "mesh/Tube.h"
#include "support/MadeLevels.h"
#include "support/PeakMemory.h"

#include <osgGpuAnimation/frame/stage/LodSelection.h>
#include <osgGpuAnimation/mesh/detail/MeshDetail.h>
#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/detail/CrowdDetail.h>

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <thread>

namespace osgGpuAnimation
{

namespace
{

using Clock = std::chrono::steady_clock;

/// A crowd of a tube in parts, whose levels take a tenth of a second and more.
struct TubeCrowd
{
    std::shared_ptr<const AnimationSet> set = armSet(true);
    std::vector<osg::ref_ptr<SkinnedGeometry>> parts = makeTubeParts(*set, 4);
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(set, parts);

    SkinnedGeometry& part() { return *parts.front(); }
    bool hasLevels() const { return CrowdDetail::levels(*crowd) && MeshDetail::findLevels(*parts.front()); }
    /// Updates until the levels are there, for half a minute at most in a Release build.
    bool getsLevels()
    {
        const auto end = Clock::now() + slowdown * std::chrono::seconds(30);
        for (double time = 0.0; !hasLevels() && Clock::now() < end; time += 0.01)
        {
            crowd->update(time);
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        return hasLevels();
    }
    std::size_t meshesAt(int level) const
    {
        std::size_t count = 0;
        LodRange(*crowd, *set, CrowdDetail::levels(*crowd))
            .forEachMeshAt(level, *crowd, [&](const SkinnedGeometry&) { ++count; });
        return count;
    }
};

constexpr int coarse = 99;

} // namespace

TEST(BackgroundLevelsTest, anUpdateTakesThem)
{
    TubeCrowd tubes;
    ASSERT_TRUE(tubes.crowd->getMeshes().setPixelError(0.5f));
    EXPECT_FALSE(tubes.hasLevels()) << "not before an update";
    EXPECT_EQ(tubes.meshesAt(coarse), 4u);
    EXPECT_EQ(LodRange(*tubes.crowd, *tubes.set).clamped(coarse), LodLevels::allTriangles);
    ASSERT_TRUE(tubes.getsLevels());
    EXPECT_EQ(tubes.meshesAt(coarse), 1u);
}

TEST(BackgroundLevelsTest, waitingTakesThem)
{
    TubeCrowd tubes;
    tubes.crowd->getMeshes().waitForLevels();
    EXPECT_FALSE(tubes.hasLevels()) << "no pixel error";
    ASSERT_TRUE(tubes.crowd->getMeshes().setPixelError(0.5f));
    tubes.crowd->getMeshes().waitForLevels();
    ASSERT_TRUE(tubes.hasLevels());
    const std::shared_ptr<const LodLevels> first = MeshDetail::findLevels(tubes.part());
    tubes.part().getVertexArray()->dirty();
    tubes.crowd->getMeshes().waitForLevels();
    ASSERT_TRUE(tubes.hasLevels());
    EXPECT_NE(MeshDetail::findLevels(tubes.part()), first) << "other vertices";
    EXPECT_EQ(tubes.meshesAt(coarse), 1u);
}

TEST(BackgroundLevelsTest, areThoseThatOneThreadMakes)
{
    TubeCrowd tubes, once;
    ASSERT_TRUE(tubes.crowd->getMeshes().setPixelError(0.5f));
    ASSERT_TRUE(tubes.getsLevels());
    const std::shared_ptr<const CharacterLevels> expectedMade = madeLevels(*once.crowd, *once.set);
    const CharacterLevels& expected = *expectedMade;
    const CharacterLevels& found = *CrowdDetail::levels(*tubes.crowd);
    ASSERT_EQ(found.merged().size(), expected.merged().size());
    ASSERT_EQ(found.merged()[0].steps.size(), expected.merged()[0].steps.size());
    for (std::size_t step = 0; step < found.merged()[0].steps.size(); ++step)
    {
        const CharacterLevels::Step &own = found.merged()[0].steps[step], &other = expected.merged()[0].steps[step];
        EXPECT_EQ(own.level, other.level);
        EXPECT_EQ(own.error, other.error);
        EXPECT_EQ(own.mesh->getVertexCount(), other.mesh->getVertexCount());
        EXPECT_TRUE(own.mesh->getStateSet() && other.mesh->getStateSet());
    }
}

TEST(BackgroundLevelsTest, nodesWithTheSameMeshesShareThem)
{
    TubeCrowd tubes;
    const osg::ref_ptr<AnimatedCrowd> second = new AnimatedCrowd(tubes.set, tubes.parts),
                                      third = new AnimatedCrowd(tubes.set, tubes.parts);
    ASSERT_TRUE(tubes.crowd->getMeshes().setPixelError(0.5f));
    ASSERT_TRUE(second->getMeshes().setPixelError(0.5f));
    tubes.crowd->getMeshes().waitForLevels();
    second->getMeshes().waitForLevels();
    EXPECT_EQ(CrowdDetail::levels(*second), CrowdDetail::levels(*tubes.crowd));
    ASSERT_TRUE(third->getMeshes().setPixelError(2.0f));
    EXPECT_EQ(CrowdDetail::levels(*third), CrowdDetail::levels(*tubes.crowd)) << "at once";
}

namespace
{

struct TubeChange
{
    const char* name;
    std::function<void(TubeCrowd&)> change;
};

const TubeChange tubeChanges[] = {
    {"vertices",
     [](TubeCrowd& tubes)
     {
         auto& vertices = static_cast<osg::Vec3Array&>(*tubes.part().getVertexArray());
         for (osg::Vec3& vertex : vertices)
             vertex.x() *= 1.1f;
         vertices.dirty();
     }},
    {"triangles",
     [](TubeCrowd& tubes)
     {
         osg::DrawElements& triangles = *tubes.part().getPrimitiveSet(0)->getDrawElements();
         triangles.resizeElements(triangles.getNumIndices() / 6 * 3);
         triangles.dirty();
     }},
    {"influences", [](TubeCrowd& tubes) { tubes.part().setRigidEntry(1); }},
    {"a hidden part", [](TubeCrowd& tubes) { tubes.part().setNodeMask(0); }},
    {"a part less", [](TubeCrowd& tubes) { tubes.crowd->removeChild(&tubes.part()); }},
    {"a material",
     [](TubeCrowd& tubes)
     {
         osg::StateSet& state = *tubes.part().getStateSet();
         state.setMode(GL_CULL_FACE, osg::StateAttribute::OFF);
         state.addUniform(new osg::Uniform("other", 1.0f));
         state.setTextureAttribute(0, nullptr);
     }},
};

} // namespace

// The thread works on copies: ThreadSanitizer sees whether.
TEST(BackgroundLevelsTest, theApplicationMayChangeTheMeshesMeanwhile)
{
    for (const TubeChange& each : tubeChanges)
    {
        SCOPED_TRACE(each.name);
        TubeCrowd tubes;
        ASSERT_TRUE(tubes.crowd->getMeshes().setPixelError(0.5f));
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        each.change(tubes);
        tubes.crowd->getMeshes().waitForLevels();
        const std::shared_ptr<const CharacterLevels> levels = CrowdDetail::levels(*tubes.crowd);
        ASSERT_TRUE(levels);
        EXPECT_TRUE(levels->isOf(*tubes.crowd, *tubes.set));
        forEachMesh(*tubes.crowd, [&](const SkinnedGeometry& mesh) { EXPECT_TRUE(MeshDetail::findLevels(mesh)); });
    }
}

TEST(BackgroundLevelsTest, nodesThatGoEndTheWork)
{
    const std::shared_ptr<const AnimationSet> set = armSet();
    // The tubes would take minutes.
    const Clock::time_point begin = Clock::now();
    for (int i = 0; i < 100; ++i)
    {
        const osg::ref_ptr<AnimatedCharacter> character = makeTubeCharacter(set);
        for (int part = 0; part < 20; ++part)
            character->addChild(makeTube(*set));
        ASSERT_TRUE(character->getMeshes().setPixelError(0.5f));
        std::this_thread::sleep_for(std::chrono::milliseconds(i % 10 == 0 ? 10 : 0));
    }
    TubeCrowd next;
    ASSERT_TRUE(next.crowd->getMeshes().setPixelError(0.5f));
    ASSERT_TRUE(next.getsLevels());
    EXPECT_LT(Clock::now() - begin, slowdown * std::chrono::seconds(30));
}

/// The process that ends while the thread works.
TEST(BackgroundLevelsDeathTest, theProcessEndsAtOnce)
{
    testing::FLAGS_gtest_death_test_style = "threadsafe";
    const auto endEarly = []
    {
        static std::vector<osg::ref_ptr<AnimatedCharacter>> kept; // destroyed after the thread
        const std::shared_ptr<const AnimationSet> set = armSet();
        for (int i = 0; i < 1000; ++i)
        {
            kept.push_back(makeTubeCharacter(set));
            static_cast<void>(kept.back()->getMeshes().setPixelError(0.5f));
        }
        std::exit(7);
    };
    const Clock::time_point begin = Clock::now();
    EXPECT_EXIT(endEarly(), testing::ExitedWithCode(7), "");
    EXPECT_LT(Clock::now() - begin, slowdown * std::chrono::seconds(10));
}

} // namespace osgGpuAnimation
