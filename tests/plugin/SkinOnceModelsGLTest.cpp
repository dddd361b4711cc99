// SPDX-License-Identifier: MIT
#include "plugin/PluginFolder.h"
#include "plugin/SharedAssets.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/gpu/SkinnedVertices.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

#include <osgDB/ReadFile>

// Whole models look the same when their meshes are skinned once a frame.

namespace osgGpuAnimation
{

namespace
{

class SkinOnceModelsGLTest : public ViewerGLTest, public ::testing::WithParamInterface<const char*>
{
protected:
    int pictureSide() const override { return 256; }

    osg::ref_ptr<osg::Image> pictureOf(osg::Node& scene)
    {
        const osg::BoundingSphere bound = scene.getBound();
        const double reach = bound.radius();
        viewer().getCamera()->setProjectionMatrixAsOrtho(-reach, reach, -reach, reach, 0, 4 * reach);
        viewer().getCamera()->setViewMatrixAsLookAt(bound.center() + osg::Vec3(0.6f, -1.5f, 0.5f) * bound.radius(),
                                                    bound.center(), {0, 0, 1});
        viewer().setSceneData(&scene);
        for (const double time : {0.0, 0.1, 0.2, 0.37})
            drawAt(time);
        return picture().copy();
    }
};

TEST_P(SkinOnceModelsGLTest, looksTheSame)
{
    if (modelFile(GetParam()).empty()) GTEST_SKIP() << "there is no " << GetParam();
    usePluginsOfTheBuild();
    osg::ref_ptr<osg::Image> pictures[2];
    for (const Skinning skinning : {Skinning::EveryDraw, Skinning::Once})
    {
        const osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile(modelFile(GetParam()));
        ASSERT_TRUE(scene);
        AnimatedCharacter& character = *findCharacter(*scene);
        for (unsigned int child = 0; child < character.getNumChildren(); ++child)
            if (auto* mesh = dynamic_cast<SkinnedGeometry*>(character.getChild(child))) mesh->setSkinning(skinning);
        pictures[skinning == Skinning::Once] = pictureOf(*scene);
        EXPECT_GT(picture().pixelsDrawn(), 500);
        EXPECT_EQ(SkinnedVertices::of(state()).bytes() > 0, skinning == Skinning::Once);
    }
    EXPECT_EQ(Picture::pixelsDifferent(*pictures[0], *pictures[1], 1.5f / 255.0f), 0);
}

INSTANTIATE_TEST_SUITE_P(Models, SkinOnceModelsGLTest,
                         ::testing::Values("Wanderer.glb", "Serpent.glb", "assets/Fox/Fox.glb",
                                           "assets/CesiumMan/CesiumMan.glb", "assets/Knight/Knight.glb",
                                           "assets/AnimatedMorphCube/AnimatedMorphCube.gltf"));

} // namespace

} // namespace osgGpuAnimation
