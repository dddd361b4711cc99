// SPDX-License-Identifier: MIT
#include "gltf/ImportedFile.h"
#include "gltf/LoadedDocument.h"
#include "serializers/StoredScene.h"
#include "support/MadeLevels.h"

#include <gtest/gtest.h>

namespace osgGpuAnimation::gltf
{

namespace
{

using Json = nlohmann::json;

const char* const extension = "KHR_materials_variants";

ImportedModel importedIn(const std::string& variant, const Json& json = richDocument())
{
    ImportOptions options;
    if (!variant.empty()) options.variant = variant;
    return imported(json.dump(), options);
}

osg::Drawable& meshOf(AnimatedCharacter& character)
{
    return *character.getChild(0)->asDrawable();
}

std::string shown(AnimatedCharacter& character)
{
    return meshOf(character).getStateSet()->getName();
}

osg::ref_ptr<AnimatedCharacter> cloneOf(const AnimatedCharacter& character)
{
    return osg::clone(&character, osg::CopyOp::DEEP_COPY_NODES);
}

} // namespace

TEST(VariantsTest, theOptionChoosesByNameOrNumber)
{
    const struct
    {
        const char *option, *name, *material;
    } choices[] = {{"", "", "own"},           {"red one", "red one", "red"}, {"1", "red one", "red"},
                   {"plain", "plain", "own"}, {"3", "plain 2", "golden"},    {"plain 2", "plain 2", "golden"}};
    for (const auto& choice : choices)
    {
        SCOPED_TRACE(choice.option);
        const ImportedModel model = importedIn(choice.option);
        ASSERT_TRUE(model.character);
        EXPECT_EQ(model.character->getMeshes().getVariants(),
                  (std::vector<std::string>{"plain", "red one", "gold", "plain 2"}));
        EXPECT_EQ(model.character->getMeshes().getVariant(), choice.name);
        ASSERT_EQ(model.primitives.size(), 2u);
        for (const ImportedPrimitive& made : model.primitives) // the moving one, the still one
            EXPECT_EQ(made.geometry->getStateSet()->getName(), choice.material);
    }
    ImportOptions options;
    options.variant = "blue";
    expectRefused(
        richDocument().dump(),
        "variant \"blue\" was asked for; the file's variants are: \"plain\", \"red one\", \"gold\", \"plain 2\"",
        options);
}

TEST(VariantsTest, namesDiffer)
{
    Json made = richDocument();
    made["extensions"][extension]["variants"] =
        Json::parse(R"([{}, {"name":"variants[0]"}, {"name":"x"}, {"name":"x 2"}, {"name":"x"}, {"name":"x"}])");
    const ImportedModel model = importedIn("", made);
    EXPECT_EQ(model.variantNames, (std::vector<std::string>{"variants[0]", "variants[0] 2", "x", "x 2", "x 3", "x 4"}));
}

TEST(VariantsTest, clonesShowTheirOwnAndShareTheMeshesOfAVariant)
{
    const ImportedModel model = importedIn("");
    AnimatedCharacter& first = *model.character;
    ASSERT_TRUE(first.getMeshes().setPixelError(1.0f));
    first.getMeshes().waitForLevels();
    const osg::ref_ptr<AnimatedCharacter> second = cloneOf(first), third = cloneOf(first);
    ASSERT_EQ(&meshOf(*second), &meshOf(first));

    ASSERT_TRUE(second->getMeshes().setVariant("red one"));
    EXPECT_EQ(shown(*second), "red");
    EXPECT_EQ(shown(first), "own");
    EXPECT_EQ(first.getMeshes().getVariant(), "");
    const auto& own = dynamic_cast<const SkinnedGeometry&>(meshOf(first));
    const auto& red = dynamic_cast<const SkinnedGeometry&>(meshOf(*second));
    EXPECT_EQ(red.getVertexArray(), own.getVertexArray());
    EXPECT_EQ(madeLevels(red, first.getAnimationSet()), madeLevels(own, first.getAnimationSet()));
    EXPECT_EQ(red.getBoundingBox(), own.getBoundingBox());

    ASSERT_TRUE(third->getMeshes().setVariant("red one"));
    EXPECT_EQ(&meshOf(*third), &meshOf(*second)); // so they are drawn together
    EXPECT_EQ(shown(*cloneOf(*second)), "red");
    ASSERT_TRUE(third->getMeshes().setVariant("gold"));
    EXPECT_EQ(shown(*third), "golden");
    EXPECT_EQ(shown(*second), "red");
    ASSERT_TRUE(second->getMeshes().setVariant("plain")); // the mesh has no mapping for it
    ASSERT_TRUE(third->getMeshes().setVariant(""));
    EXPECT_EQ(&meshOf(*second), &meshOf(first));
    EXPECT_EQ(&meshOf(*third), &meshOf(first));

    // A mesh that another clone shows holds what this one plays, too.
    const osg::ref_ptr<AnimatedCharacter> fourth = cloneOf(first);
    ASSERT_TRUE(fourth->getMeshes().setVariant("gold"));
    const osg::BoundingBox larger(osg::Vec3(-50, -50, -50), osg::Vec3(50, 50, 50));
    const_cast<osg::Drawable&>(meshOf(*third)).setInitialBound(larger);
    ASSERT_TRUE(third->getMeshes().setVariant("gold"));
    EXPECT_EQ(&meshOf(*third), &meshOf(*fourth));
    EXPECT_EQ(meshOf(*third).getBoundingBox(), larger);

    const Result<void> refused = third->getMeshes().setVariant("blue");
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().message, "there is no material variant \"blue\"; the variants are \"plain\", "
                                       "\"red one\", \"gold\", \"plain 2\"");
}

TEST(VariantsTest, areKeptInScenes)
{
    const StoredScene files;
    for (const char* format : {"osgb", "osgt", "osgx"})
    {
        SCOPED_TRACE(format);
        const ImportedModel model = importedIn("red one");
        const osg::ref_ptr<osg::Node> scene = files.throughFile(*model.root, format);
        AnimatedCharacter* character = scene ? findCharacter(*scene) : nullptr;
        ASSERT_TRUE(character);
        EXPECT_EQ(character->getMeshes().getVariants(), model.character->getMeshes().getVariants());
        EXPECT_EQ(character->getMeshes().getVariant(), "red one");
        EXPECT_EQ(shown(*character), "red");
        const osg::Drawable* red = &meshOf(*character);
        ASSERT_TRUE(character->getMeshes().setVariant("red one"));
        EXPECT_EQ(&meshOf(*character), red); // its StateSet is that of the variant
        ASSERT_TRUE(character->getMeshes().setVariant(""));
        EXPECT_EQ(shown(*character), "own");
        ASSERT_TRUE(character->getMeshes().setVariant("gold"));
        EXPECT_EQ(shown(*character), "golden");
    }
}

TEST(VariantsTest, aMaterialWithOtherTextureCoordinatesIsNotShown)
{
    const struct
    {
        const char *own, *red; ///< the base colour textures
        bool isShown;
    } cases[] = {{R"({"index":0})", R"({"index":0,"texCoord":1})", false},
                 {R"({"index":0})", R"({"index":0})", true},
                 {R"({"index":0})", "", true},
                 {"", R"({"index":0,"texCoord":1})", true}}; // the vertices get what the variant needs
    for (const auto& each : cases)
    {
        SCOPED_TRACE(std::string(each.own) + " and " + each.red);
        Json made = richDocument();
        for (const int mesh : {0, 1})
            for (const char* set : {"TEXCOORD_0", "TEXCOORD_1"})
                made["meshes"][mesh]["primitives"][0]["attributes"][set] = made["accessors"].size();
        made["accessors"].push_back({{"componentType", 5126}, {"count", 3}, {"type", "VEC2"}}); // all (0, 0)
        for (const auto& [material, texture] : {std::pair(0, each.own), std::pair(1, each.red)})
            if (*texture != '\0')
                made["materials"][material]["pbrMetallicRoughness"]["baseColorTexture"] = Json::parse(texture);
        const ImportedModel model = importedIn("red one", made);
        ASSERT_TRUE(model.character);
        EXPECT_EQ(shown(*model.character), each.isShown ? "red" : "own");
        const std::string warning = "its material of variant \"red one\" reads other texture coordinates";
        expectWarnings(model, std::vector<std::string>(each.isShown ? 0 : 2, warning)); // one a primitive
    }
}

} // namespace osgGpuAnimation::gltf
