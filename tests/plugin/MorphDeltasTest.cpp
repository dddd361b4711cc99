// SPDX-License-Identifier: MIT
#include "gltf/Import.h"
#include "plugin/ModelBuilder.h"
#include "plugin/StoredScene.h"

#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>

#include <gtest/gtest.h>

namespace osgGpuAnimation::gltf
{

namespace
{

std::vector<SkinnedGeometry*> meshesOf(osg::Node& node)
{
    std::vector<SkinnedGeometry*> meshes;
    forEachMeshBelow(node, [&](SkinnedGeometry& mesh) { meshes.push_back(&mesh); });
    return meshes;
}

/// One mesh under two nodes with weights of their own.
osg::ref_ptr<osg::Node> twoFaces()
{
    ModelBuilder file;
    const int mesh = file.triangle();
    file.primitive(mesh).targets = {{{"POSITION", file.floats(TINYGLTF_TYPE_VEC3, {0, 0, 3, 0, 0, 0, 0, 0, 0})}}};
    file.at(file.node("glad", -1, mesh)).weights = {1.0};
    file.at(file.node("sad", -1, mesh)).weights = {0.5};
    const Result<ImportedModel> model = importModel(file.text(), "", {});
    EXPECT_TRUE(model) << model.error().message;
    return model ? model.value().root : nullptr;
}

void expectShared(osg::Node* scene)
{
    ASSERT_TRUE(scene);
    const std::vector<SkinnedGeometry*> meshes = meshesOf(*scene);
    ASSERT_EQ(meshes.size(), 2u);
    EXPECT_NE(meshes[0]->getMorphEntry(), meshes[1]->getMorphEntry());
    ASSERT_TRUE(meshes[0]->getMorphDeltas());
    EXPECT_EQ(meshes[0]->getMorphDeltas(), meshes[1]->getMorphDeltas());
    const auto* texel = reinterpret_cast<const osg::Vec4f*>(meshes[0]->getMorphDeltas()->getImage()->data());
    EXPECT_EQ(*texel, osg::Vec4f(0, 0, 3, 0));
}

} // namespace

TEST(MorphDeltasTest, oneMeshUnderTwoNodesIsPackedOnce)
{
    expectShared(twoFaces());
}

TEST(MorphDeltasTest, copiesAndStoredScenesShareToo)
{
    const osg::ref_ptr<osg::Node> scene = twoFaces();
    expectShared(osg::clone(scene.get(), osg::CopyOp::DEEP_COPY_NODES));
    const StoredScene stored;
    for (const char* format : {"osgb", "osgt", "osgx"})
        expectShared(stored.throughFile(*scene, format));
}

// The entry says where the palette has the copy's weights.
TEST(MorphDeltasTest, copiedMeshesKeepTheirEntries)
{
    const osg::ref_ptr<osg::Node> scene = twoFaces();
    for (const SkinnedGeometry* mesh : meshesOf(*scene))
    {
        const osg::ref_ptr<SkinnedGeometry> copy = osg::clone(mesh, osg::CopyOp::SHALLOW_COPY);
        EXPECT_GE(mesh->getMorphEntry(), 0);
        EXPECT_EQ(copy->getMorphEntry(), mesh->getMorphEntry());
        EXPECT_EQ(copy->getMorph(), mesh->getMorph());
    }
}

TEST(MorphDeltasTest, changedArraysArePackedAnew)
{
    const osg::ref_ptr<osg::Node> scene = twoFaces();
    const std::vector<SkinnedGeometry*> meshes = meshesOf(*scene);
    ASSERT_EQ(meshes.size(), 2u);
    const std::vector<MorphTarget> targets = meshes[0]->getMorphTargets();
    targets[0].positions->front() = osg::Vec3(7, 0, 0);
    targets[0].positions->dirty();
    meshes[0]->setMorphTargets(meshes[0]->getMorph(), meshes[0]->getMorphEntry(), targets);
    EXPECT_NE(meshes[0]->getMorphDeltas(), meshes[1]->getMorphDeltas());
    EXPECT_EQ(*reinterpret_cast<const osg::Vec4f*>(meshes[0]->getMorphDeltas()->getImage()->data()),
              osg::Vec4f(7, 0, 0, 0));
    meshes[1]->setMorphTargets(meshes[1]->getMorph(), meshes[1]->getMorphEntry(), targets);
    EXPECT_EQ(meshes[0]->getMorphDeltas(), meshes[1]->getMorphDeltas());
    meshes[0]->setMorphTargets(-1, -1, {});
    EXPECT_FALSE(meshes[0]->getMorphDeltas());
}

} // namespace osgGpuAnimation::gltf
