// SPDX-License-Identifier: MIT
#include "gltf/ModelBuilder.h"
#include "plugin/SharedAssets.h"
#include "serializers/StoredScene.h"

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <thread>

// Several threads read files at once through osgDB, as DatabasePagers and loading screens do. The test checks that
// loads are right and that osgDB's cache returns copies of a scene (plugin/serializers/RegistryHooks.h).
// ThreadSanitizer checks the data that loads share in the process: mesh numbers, programs and morph textures.

namespace osgGpuAnimation
{

namespace
{

using CacheHint = osgDB::Options::CacheHintOptions;

constexpr int rounds = 6;

/// Two glTF files and a scene in OSG's format, and the result of each when a single thread reads it.
class ConcurrentLoadsTest : public ::testing::TestWithParam<CacheHint>
{
protected:
    void SetUp() override
    {
        gltf::ModelBuilder model;
        const int arm = model.node("arm");
        model.node("sword", arm, model.triangle());
        model.slidingClip("Slide", arm);
        const std::string wanderer = ownScene("Wanderer.glb");
        files = {stored.folder.write("arm.gltf", model.text()), wanderer, stored.folder.file("kept.osgb")};
        ASSERT_TRUE(osgDB::writeNodeFile(*osgDB::readRefNodeFile(wanderer), files.back()));
        for (const std::string& file : files)
        {
            expected.push_back(osgDB::readRefNodeFile(file));
            ASSERT_TRUE(isAnimated(expected.back())) << file;
        }
        options->setObjectCacheHint(GetParam());
    }

    void TearDown() override { osgDB::Registry::instance()->clearObjectCache(); }

    static bool isAnimated(osg::ref_ptr<osg::Node>& scene)
    {
        AnimatedCharacter* character = scene ? findCharacter(*scene) : nullptr;
        if (!character) return false;
        character->update(0.0);
        character->update(0.3);
        return true;
    }

    /// Reads all files, starting with that index, and plays each for a while; empty if one is wrong.
    std::vector<osg::ref_ptr<osg::Node>> load(std::size_t first) const
    {
        std::vector<osg::ref_ptr<osg::Node>> scenes;
        for (std::size_t file = first; file < first + files.size() * rounds; ++file)
        {
            const std::size_t index = file % files.size();
            osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile(files[index], options.get());
            if (!isAnimated(scene)) return {};
            const AnimationController& wanted = findCharacter(*expected[index])->getController();
            if (paletteDifference(findCharacter(*scene)->getController(), wanted) != 0.0f) return {};
            scenes.push_back(scene);
        }
        return scenes;
    }

    StoredScene stored;
    std::vector<std::string> files;
    std::vector<osg::ref_ptr<osg::Node>> expected;
    osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
};

} // namespace

TEST_P(ConcurrentLoadsTest, everyLoadIsRightAndACharacterOfItsOwn)
{
    std::array<std::vector<osg::ref_ptr<osg::Node>>, 4> loads;
    std::vector<std::thread> threads;
    for (std::size_t thread = 0; thread < loads.size(); ++thread) // two threads start with the same file
        threads.emplace_back([this, &loads, thread] { loads[thread] = load(thread / 2); });
    for (std::thread& thread : threads)
        thread.join();
    std::set<const AnimatedCharacter*> characters;
    for (const auto& scenes : loads)
    {
        EXPECT_EQ(scenes.size(), files.size() * rounds);
        for (const osg::ref_ptr<osg::Node>& scene : scenes)
            characters.insert(findCharacter(*scene));
    }
    EXPECT_EQ(characters.size(), loads.size() * files.size() * rounds);
}

INSTANTIATE_TEST_SUITE_P(, ConcurrentLoadsTest,
                         ::testing::Values(CacheHint::CACHE_NONE, CacheHint::CACHE_NODES, CacheHint::CACHE_ALL),
                         [](const auto& info)
                         {
                             return info.param == CacheHint::CACHE_NONE    ? "Uncached"
                                    : info.param == CacheHint::CACHE_NODES ? "CachedNodes"
                                                                           : "CachedAll";
                         });

} // namespace osgGpuAnimation
