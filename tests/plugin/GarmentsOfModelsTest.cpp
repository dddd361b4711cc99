// SPDX-License-Identifier: MIT
#include "gltf/GlbText.h"
#include "gltf/ImportedFile.h"
#include "plugin/SharedAssets.h"
#include "serializers/StoredScene.h"
#include "support/VertexDistance.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <algorithm>
#include <set>

// A model as two files, a body and its clothes, of which one is worn by the other: the same poses and pictures as the
// one file.

namespace osgGpuAnimation::gltf
{

namespace
{

const char* const knightFile = "assets/Knight/Knight.glb";
const char* const clips[] = {"Idle", "Running_A", "1H_Melee_Attack_Chop", "Death_A"};
const std::set<std::string> clothes{"Knight_Helmet", "Knight_Cape", "Knight_ArmLeft", "1H_Sword", "Knight_Body"};

/// The model without the meshes of some nodes. areKept: those of the names, else all others.
std::string withMeshes(GlbParts model, const std::set<std::string>& names, bool areKept)
{
    for (nlohmann::json& node : model.json["nodes"])
    {
        if (!node.contains("mesh") || (names.count(node["name"]) > 0) == areKept) continue;
        node.erase("mesh");
        node.erase("skin");
    }
    if (areKept) model.json.erase("animations");
    return model.whole();
}

class KnightsClothes
{
public:
    KnightsClothes()
    {
        GlbParts split(readBytes(sharedFile(knightFile)));
        nlohmann::json few = nlohmann::json::array();
        for (const nlohmann::json& animation : split.json["animations"])
            if (std::find(std::begin(clips), std::end(clips), animation["name"]) != std::end(clips))
                few.push_back(animation);
        split.json["animations"] = few;
        whole = imported(split.whole()).character;
        body = imported(withMeshes(split, clothes, false)).character;
        garment = imported(withMeshes(split, clothes, true)).character;
    }

    void play(const std::string& clip, double time)
    {
        for (AnimatedCharacter* character : {whole.get(), body.get()})
        {
            EXPECT_TRUE(character->getController().play(clip));
            character->getController().seek(time);
        }
    }

    /// Of meshes of the same nodes, in model units.
    double largestDistanceOf(const AnimatedCharacter& dressed) const
    {
        double largest = 0.0;
        for (unsigned int i = 0; i < whole->getNumChildren(); ++i)
        {
            const auto& mesh = dynamic_cast<const SkinnedGeometry&>(*whole->getChild(i));
            const SkinnedGeometry* other = dressed.getMeshes().find(mesh.getName());
            EXPECT_NE(other, nullptr) << mesh.getName();
            if (!other) continue;
            largest = std::max(largest, largestDistance(*whole->getPosedMesh(mesh), *dressed.getPosedMesh(*other)));
        }
        return largest;
    }

    osg::ref_ptr<AnimatedCharacter> whole, body, garment;
};

using KnightsClothesGLTest = ViewerGLTest;

} // namespace

TEST(GarmentsOfModelsTest, aBodyInItsClothesIsTheWholeModel)
{
    SKIP_WITHOUT_SHARED_FILE(knightFile);
    KnightsClothes knight;
    ASSERT_TRUE(knight.whole && knight.body && knight.garment);
    const std::shared_ptr<const AnimationSet> bare = knight.body->getController().sharedSet();
    const WornGarment worn = valueOf(knight.body->wear(knight.garment));
    EXPECT_TRUE(worn.leftOut.empty());
    EXPECT_EQ(worn.addedEntries, 3u) << "of the rigid parts on the head, the chest and a hand";
    ASSERT_EQ(knight.body->getNumChildren(), knight.whole->getNumChildren());
    for (const char* clip : clips)
        for (const double share : {0.0, 0.3, 0.8})
        {
            knight.play(clip, share);
            EXPECT_LT(knight.largestDistanceOf(*knight.body), 2.5e-6) << clip << ' ' << share; // 1e-6 of the size
        }
    EXPECT_TRUE(knight.body->takeOff(knight.garment));
    EXPECT_EQ(knight.body->getController().sharedSet(), bare);
}

TEST(GarmentsOfModelsTest, areKeptInStoredScenes)
{
    SKIP_WITHOUT_SHARED_FILE(knightFile);
    const StoredScene files;
    KnightsClothes knight;
    ASSERT_TRUE(knight.body->wear(knight.garment));
    ASSERT_TRUE(knight.body->getMeshes().setVisible("Round_Shield", false));
    knight.play("Running_A", 0.3);
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(knight.body);
    scene->addChild(osg::clone(knight.body.get(), osg::CopyOp::DEEP_COPY_NODES));
    for (const char* format : storedFormats)
    {
        SCOPED_TRACE(format);
        const osg::ref_ptr<osg::Node> read = files.throughFile(*scene, format);
        ASSERT_TRUE(read);
        auto& first = dynamic_cast<AnimatedCharacter&>(*read->asGroup()->getChild(0));
        auto& second = dynamic_cast<AnimatedCharacter&>(*read->asGroup()->getChild(1));
        EXPECT_EQ(first.getController().sharedSet(), second.getController().sharedSet());
        EXPECT_EQ(first.getAnimationSet().paletteSize(), knight.body->getAnimationSet().paletteSize());
        EXPECT_LT(knight.largestDistanceOf(first), 2.5e-6);
        EXPECT_EQ(first.getMeshes().find("Round_Shield")->getNodeMask(), 0u);
        ASSERT_TRUE(first.getMeshes().setVisible("Round_Shield", true));
        EXPECT_TRUE(second.takeOff(second.getMeshes().find("Knight_Cape")));
        EXPECT_EQ(second.getNumChildren(), knight.whole->getNumChildren() - clothes.size());
        EXPECT_TRUE(second.getAnimationSet().garments().empty());
        EXPECT_EQ(first.getNumChildren(), knight.whole->getNumChildren());
    }
}

TEST_F(KnightsClothesGLTest, showTheWholeKnight)
{
    SKIP_WITHOUT_SHARED_FILE(knightFile);
    viewer().getCamera()->setProjectionMatrixAsOrtho(-2, 2, -1, 3, 1, 20);
    KnightsClothes knight;
    const osg::ref_ptr<osg::Image> naked = pictureOf(knight.body, {0.0});
    ASSERT_TRUE(knight.body->wear(knight.garment));
    knight.play("1H_Melee_Attack_Chop", 0.4);
    const osg::ref_ptr<osg::Image> expected = pictureOf(knight.whole, {0.0});
    EXPECT_EQ(Picture::pixelsDifferent(*pictureOf(knight.body, {0.0}), *expected), 0);
    EXPECT_GT(Picture::pixelsDifferent(*naked, *expected), 50);
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*knight.body);
    ASSERT_TRUE(crowd->add(osg::Matrixd(), knight.body->getController()));
    EXPECT_EQ(Picture::pixelsDifferent(*pictureOf(crowd, {0.0}), *expected), 0);
    ASSERT_TRUE(knight.body->getMeshes().setVisible("Knight_Cape", false));
    ASSERT_TRUE(knight.whole->getMeshes().setVisible("Knight_Cape", false));
    const osg::ref_ptr<osg::Image> without = pictureOf(knight.whole, {0.0});
    EXPECT_EQ(Picture::pixelsDifferent(*pictureOf(knight.body, {0.0}), *without), 0);
    EXPECT_GT(Picture::pixelsDifferent(*without, *expected), 10);
}

} // namespace osgGpuAnimation::gltf
