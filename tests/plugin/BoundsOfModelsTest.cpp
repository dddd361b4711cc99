// SPDX-License-Identifier: MIT
#include "plugin/PluginFolder.h"
#include "plugin/SharedAssets.h"

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>

#include <gtest/gtest.h>
#include <osgDB/ReadFile>

#include <algorithm>
#include <cstdio>

// The boxes of real characters contain every vertex at every time of every clip and crossfade. The boxes of clips are
// not much larger than the space that the vertices sweep.

namespace osgGpuAnimation
{

namespace
{

class BoundsOfModelsTest : public ::testing::TestWithParam<std::string>
{
protected:
    static constexpr int timesAClip = 200; ///< a finer spacing than the keyframes of every file

    void SetUp() override
    {
        if (modelFile(GetParam()).empty()) GTEST_SKIP() << "there is no " << GetParam();
        usePluginsOfTheBuild();
        node = osgDB::readRefNodeFile(modelFile(GetParam()));
        ASSERT_TRUE(node.valid());
        character = findCharacter(*node);
        ASSERT_NE(character, nullptr);
    }

    /// The bounding box of all vertices in the current pose.
    Box posedBox() const
    {
        const AnimationController& controller = character->getController();
        std::vector<AffineMatrix> palette;
        Pose::evaluate(controller.set(), controller.instruction(), toAffine(character->getFileToNode()), palette);
        std::vector<glm::dvec3> positions;
        Box box;
        for (unsigned int i = 0; i < character->getNumChildren(); ++i)
        {
            const auto* mesh = dynamic_cast<const SkinnedGeometry*>(character->getChild(i));
            if (!mesh) continue;
            mesh->computePositions(palette, positions);
            for (const glm::dvec3& position : positions)
                box.add(glm::vec3(position));
        }
        return box;
    }

    static double diagonal(const Box& box) { return static_cast<double>(glm::length(box.max - box.min)); }

    /// The largest distance of the inner box beyond the outer one, relative to the inner one's diagonal.
    static double excess(const Box& outer, const Box& inner)
    {
        const glm::vec3 beyond = glm::max(outer.min - inner.min, inner.max - outer.max);
        return static_cast<double>(std::max({beyond.x, beyond.y, beyond.z})) / diagonal(inner);
    }

    osg::ref_ptr<osg::Node> node;
    AnimatedCharacter* character = nullptr;
};

TEST_P(BoundsOfModelsTest, clipsAreHeldTightly)
{
    AnimationController& controller = character->getController();
    controller.setLoopMode(LoopMode::Once);
    double worst = 0.0;
    for (std::size_t clip = 0; clip < character->getAnimationSet().clips().size(); ++clip)
    {
        SCOPED_TRACE(character->getAnimationSet().clips()[clip].name());
        ASSERT_TRUE(controller.play(clip));
        controller.pause();
        Box swept;
        for (int i = 0; i <= timesAClip; ++i)
        {
            controller.seek(controller.duration() * i / timesAClip);
            swept.add(posedBox());
        }
        const Box box = toBox(character->getClipBounds(static_cast<int>(clip)));
        EXPECT_LE(excess(box, swept), 1e-5) << "of the size: rounding to float";
        const double ratio = diagonal(box) / diagonal(swept);
        EXPECT_LE(ratio, 1.5);
        worst = std::max(worst, ratio);
    }
    std::printf("%s: a clip's box has at most %.3f times the diagonal of what is swept\n", GetParam().c_str(), worst);
}

TEST_P(BoundsOfModelsTest, crossfadesAreHeld)
{
    AnimationController& controller = character->getController();
    const std::size_t clips = character->getAnimationSet().clips().size();
    double time = 0.0;
    for (std::size_t from = 0; from < clips; ++from)
    {
        const std::size_t to = (from * 7 + 3) % clips;
        SCOPED_TRACE(testing::Message() << character->getAnimationSet().clips()[from].name() << " to "
                                        << character->getAnimationSet().clips()[to].name());
        ASSERT_TRUE(controller.play(from));
        controller.seek(0.37 * controller.duration());
        ASSERT_TRUE(controller.crossfade(to, 0.5));
        for (int i = 0; i < 40; ++i)
        {
            character->update(time += 1.0 / 60.0);
            const Box posed = posedBox();
            EXPECT_LE(excess(toBox(character->getCurrentBounds()), posed), 1e-5) << i;
            const osg::BoundingSphere& sphere = character->getBound();
            const glm::vec3 middle = 0.5f * (posed.min + posed.max);
            const osg::Vec3 centre = osg::Vec3(middle.x, middle.y, middle.z) * character->getMatrix();
            EXPECT_LE((centre - sphere.center()).length(), sphere.radius()) << i;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(
    Files, BoundsOfModelsTest,
    ::testing::Values("assets/Fox/Fox.glb", "assets/CesiumMan/CesiumMan.glb", "assets/Knight/Knight.glb",
                      "assets/AnimatedMorphCube/AnimatedMorphCube.gltf", "assets/SimpleSkin/SimpleSkin.gltf",
                      "assets/rigged_simple/rigged_simple.gltf", "assets/interpolation_test/interpolation_test.gltf",
                      "Wanderer.glb", "Serpent.glb"));

} // namespace

} // namespace osgGpuAnimation
