// SPDX-License-Identifier: MIT
#include "gltf/Import.h"
#include "plugin/ImportedFile.h"
#include "plugin/ModelBuilder.h"
#include "plugin/SharedAssets.h"
#include "plugin/SplitModel.h"
#include "plugin/StoredScene.h"
#include "support/VertexDistance.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/TriangleFunctor>

#include <algorithm>
#include <cstring>
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
std::string withMeshes(SplitModel split, const std::set<std::string>& names, bool areKept)
{
    for (nlohmann::json& node : split.document()["nodes"])
    {
        if (!node.contains("mesh") || (names.count(node["name"]) > 0) == areKept) continue;
        node.erase("mesh");
        node.erase("skin");
    }
    return areKept ? split.mesh() : split.whole();
}

/// Multiplies numbers of an accessor of floats: the first `used` of every `each`.
void scale(SplitModel& split, std::size_t accessorIndex, float factor, std::size_t each, std::size_t used)
{
    nlohmann::json& accessor = split.document()["accessors"][accessorIndex];
    const nlohmann::json& view = split.document()["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    const std::size_t offset = view.value("byteOffset", std::size_t(0)) + accessor.value("byteOffset", std::size_t(0));
    for (std::size_t i = 0; i < each * accessor["count"].get<std::size_t>(); ++i)
    {
        if (i % each >= used) continue;
        float number = 0.0f;
        std::memcpy(&number, &split.binary()[offset + i * sizeof(float)], sizeof(float));
        number *= factor;
        std::memcpy(&split.binary()[offset + i * sizeof(float)], &number, sizeof(float));
    }
    for (const char* limit : {"min", "max"})
        if (accessor.contains(limit))
            for (nlohmann::json& number : accessor[limit])
                number = static_cast<float>(number) * factor;
}

/// Doubles the skinned meshes at bind time; the inverse binds halve them again.
void doubleSkinnedMeshes(SplitModel& split)
{
    nlohmann::json& document = split.document();
    std::set<std::size_t> positions;
    for (const nlohmann::json& node : document["nodes"])
        if (node.contains("skin"))
            for (const nlohmann::json& primitive : document["meshes"][node["mesh"].get<std::size_t>()]["primitives"])
                positions.insert(primitive["attributes"]["POSITION"].get<std::size_t>());
    for (const std::size_t accessor : positions)
        scale(split, accessor, 2.0f, 3, 3);
    for (const nlohmann::json& skin : document["skins"])
        scale(split, skin["inverseBindMatrices"].get<std::size_t>(), 0.5f, 16, 12);
}

osg::ref_ptr<AnimatedCharacter> characterOf(const std::string& bytes)
{
    const Result<ImportedModel> model = importModel(bytes, "", {});
    EXPECT_TRUE(model) << model.error().message;
    return model ? model.value().character : nullptr;
}

struct Dressing
{
    const char* name;
    bool isDoubled;           ///< the garment's skinned meshes at bind time
    std::size_t addedEntries; ///< of the palette
};

// Three parts are rigid: on the head, the chest and a hand. Of the 41 joints of the skin, two meshes use 7.
const Dressing dressings[] = {{"bound as in the whole file", false, 3}, {"bound at another scale", true, 10}};

class KnightsClothes
{
public:
    explicit KnightsClothes(const Dressing& dressing)
    {
        SplitModel split(readBytes(sharedFile(knightFile)));
        nlohmann::json few = nlohmann::json::array();
        for (const nlohmann::json& animation : split.document()["animations"])
            if (std::find(std::begin(clips), std::end(clips), animation["name"]) != std::end(clips))
                few.push_back(animation);
        split.document()["animations"] = few;
        whole = characterOf(split.whole());
        body = characterOf(withMeshes(split, clothes, false));
        if (dressing.isDoubled) doubleSkinnedMeshes(split);
        garment = characterOf(withMeshes(split, clothes, true));
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
            std::string node = mesh.getName();
            (void)mesh.getUserValue("osgGpuAnimation.node", node);
            const SkinnedGeometry* other = dressed.getMeshes().find(node);
            EXPECT_NE(other, nullptr) << node;
            if (!other) continue;
            largest = std::max(largest, largestDistance(*whole->getPosedMesh(mesh), *dressed.getPosedMesh(*other)));
        }
        return largest;
    }

    osg::ref_ptr<AnimatedCharacter> whole, body, garment;
};

std::size_t trianglesOf(AnimatedCharacter& character)
{
    struct Count
    {
        void operator()(const osg::Vec3&, const osg::Vec3&, const osg::Vec3&) { ++triangles; }
        void operator()(const osg::Vec3&, const osg::Vec3&, const osg::Vec3&, bool) { ++triangles; }
        std::size_t triangles = 0;
    };
    osg::TriangleFunctor<Count> count;
    character.acceptPosed(count);
    return count.triangles;
}

using KnightsClothesGLTest = ViewerGLTest;

} // namespace

TEST(GarmentsOfModelsTest, aBodyInItsClothesIsTheWholeModel)
{
    SKIP_WITHOUT_SHARED_FILE(knightFile);
    for (const Dressing& dressing : dressings)
    {
        SCOPED_TRACE(dressing.name);
        KnightsClothes knight(dressing);
        ASSERT_TRUE(knight.whole && knight.body && knight.garment);
        const std::shared_ptr<const AnimationSet> bare = knight.body->getController().sharedSet();
        const Result<WornGarment> worn = knight.body->wear(knight.garment);
        ASSERT_TRUE(worn) << worn.error().message;
        EXPECT_TRUE(worn.value().leftOut.empty());
        EXPECT_EQ(worn.value().addedEntries, dressing.addedEntries);
        ASSERT_EQ(knight.body->getNumChildren(), knight.whole->getNumChildren());
        for (const char* clip : clips)
            for (const double share : {0.0, 0.3, 0.8})
            {
                knight.play(clip, share);
                EXPECT_LT(knight.largestDistanceOf(*knight.body), 2.5e-6) << clip << ' ' << share; // 1e-6 of the size
            }
        EXPECT_EQ(trianglesOf(*knight.body), trianglesOf(*knight.whole));
        EXPECT_TRUE(knight.body->takeOff(knight.garment));
        EXPECT_EQ(knight.body->getController().sharedSet(), bare);
    }
}

TEST(GarmentsOfModelsTest, skinnedMeshesShareTheBodysEntries)
{
    SKIP_WITHOUT_SHARED_FILE(knightFile);
    const SplitModel split(readBytes(sharedFile(knightFile)));
    const std::set<std::string> skinned{"Knight_ArmLeft", "Knight_Body"};
    const osg::ref_ptr<AnimatedCharacter> body = characterOf(withMeshes(split, skinned, false));
    const osg::ref_ptr<AnimatedCharacter> garment = characterOf(withMeshes(split, skinned, true));
    ASSERT_TRUE(body && garment);
    const AnimationSet* const before = &body->getAnimationSet();
    const Result<WornGarment> worn = body->wear(garment);
    ASSERT_TRUE(worn) << worn.error().message;
    EXPECT_EQ(worn.value().addedEntries, 0u);
    EXPECT_TRUE(worn.value().followed.empty());
    EXPECT_EQ(&body->getAnimationSet(), before) << "no pose work is added";
}

TEST(GarmentsOfModelsTest, areKeptInStoredScenes)
{
    SKIP_WITHOUT_SHARED_FILE(knightFile);
    const StoredScene files;
    for (const Dressing& dressing : dressings)
    {
        KnightsClothes knight(dressing);
        ASSERT_TRUE(knight.body->wear(knight.garment));
        ASSERT_TRUE(knight.body->getMeshes().setVisible("Round_Shield", false));
        knight.play("Running_A", 0.3);
        const osg::ref_ptr<osg::Group> scene = new osg::Group;
        scene->addChild(knight.body);
        scene->addChild(osg::clone(knight.body.get(), osg::CopyOp::DEEP_COPY_NODES));
        for (const char* format : {"osgb", "osgt", "osgx"})
        {
            SCOPED_TRACE(std::string(dressing.name) + ", " + format);
            const osg::ref_ptr<osg::Node> read = files.throughFile(*scene, format);
            ASSERT_TRUE(read);
            auto& first = dynamic_cast<AnimatedCharacter&>(*read->asGroup()->getChild(0));
            auto& second = dynamic_cast<AnimatedCharacter&>(*read->asGroup()->getChild(1));
            EXPECT_EQ(first.getController().sharedSet(), second.getController().sharedSet());
            EXPECT_EQ(first.getAnimationSet().paletteSize(), knight.body->getAnimationSet().paletteSize());
            EXPECT_LT(knight.largestDistanceOf(first), 2.5e-6);
            EXPECT_EQ(first.getMeshes().find("Round_Shield")->getNodeMask(), 0u);
            ASSERT_TRUE(first.getMeshes().setVisible("Round_Shield", true));
            EXPECT_EQ(trianglesOf(first), trianglesOf(*knight.whole));
            EXPECT_TRUE(second.takeOff(second.getMeshes().find("Knight_Cape")));
            EXPECT_EQ(second.getNumChildren(), knight.whole->getNumChildren() - clothes.size());
            EXPECT_TRUE(second.getAnimationSet().garments().empty());
            EXPECT_EQ(first.getNumChildren(), knight.whole->getNumChildren());
        }
    }
}

TEST(GarmentsOfModelsTest, meshesAreFoundByTheNamesOfTheirNodes)
{
    ModelBuilder file;
    const int root = file.node("Root");
    const int hand = file.node("Hand", root), sword = file.node("Sword", hand, file.triangle());
    file.animation("Wave");
    file.slide(hand);
    const ImportedModel model = imported(file);
    ASSERT_TRUE(model.character);
    EXPECT_EQ(model.character->getMeshes().find("Sword"), primitiveOf(model, sword).geometry);
    EXPECT_EQ(model.character->getMeshes().find("Hand"), nullptr);
    const StoredScene files;
    const osg::ref_ptr<osg::Node> read = files.throughFile(*model.root, "osgb");
    ASSERT_TRUE(read);
    EXPECT_NE(findCharacter(*read)->getMeshes().find("Sword"), nullptr);
}

TEST_F(KnightsClothesGLTest, showTheWholeKnight)
{
    SKIP_WITHOUT_SHARED_FILE(knightFile);
    viewer().getCamera()->setProjectionMatrixAsOrtho(-2, 2, -1, 3, 1, 20);
    for (const Dressing& dressing : dressings)
    {
        SCOPED_TRACE(dressing.name);
        KnightsClothes knight(dressing);
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
}

// Characters that wear the same are posed in one batch, and drawn together.
TEST_F(KnightsClothesGLTest, areDrawnTogether)
{
    SKIP_WITHOUT_SHARED_FILE(knightFile);
    KnightsClothes knight(dressings[1]);
    viewer().getCamera()->setProjectionMatrixAsOrtho(-2, 2, -1, 3, 1, 20);
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    for (int i = 0; i < 3; ++i)
    {
        const osg::ref_ptr<AnimatedCharacter> other = osg::clone(knight.body.get(), osg::CopyOp::DEEP_COPY_NODES);
        other->setMatrix(osg::Matrixd::translate(i - 1, 0, 0));
        ASSERT_TRUE(other->wear(knight.garment));
        scene->addChild(other);
    }
    const auto drawsAt = [&](double time)
    {
        const std::size_t before = PosePipeline::of(state())->getCounters().feedbackDraws;
        drawAt(time);
        return PosePipeline::of(state())->getCounters().feedbackDraws - before;
    };
    const osg::ref_ptr<osg::Image> together = pictureOf(scene, {0.0});
    const std::size_t levels = knight.body->getAnimationSet().levelCount();
    EXPECT_EQ(drawsAt(0.1), levels + 1) << "one more draw, for the entries of the garment";
    for (unsigned int i = 0; i < 3; ++i)
        dynamic_cast<AnimatedCharacter&>(*scene->getChild(i)).setDrawnTogether(false);
    EXPECT_EQ(Picture::pixelsDifferent(*pictureOf(scene, {0.0}), *together), 0);
    EXPECT_GT(picture().pixelsDrawn(), 100);
    for (unsigned int i = 0; i < 3; ++i)
        EXPECT_TRUE(dynamic_cast<AnimatedCharacter&>(*scene->getChild(i)).takeOff(knight.garment));
    drawAt(0.2);
    EXPECT_EQ(drawsAt(0.3), levels);
}

} // namespace osgGpuAnimation::gltf
