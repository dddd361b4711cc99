// SPDX-License-Identifier: MIT
#include "gltf/Import.h"
#include "plugin/LoadedDocument.h"
#include "plugin/StoredScene.h"

#include <gtest/gtest.h>

namespace osgGpuAnimation::gltf
{

namespace
{

using Json = nlohmann::json;

const char* const extension = "KHR_materials_variants";
const char* const twoMappings = R"({"mappings":[{"material":1,"variants":[1]},{"material":2,"variants":[2,3]}]})";

/// The base document with a still copy of its mesh. Both are red in variant 1 and gold in variants 2 and 3, of which
/// the last has the name of the first.
Json document()
{
    Json made = baseDocument();
    made["extensionsUsed"] = {extension};
    made["extensions"][extension]["variants"] =
        Json::parse(R"([{"name":"plain"},{"name":"red one"},{"name":"gold"},{"name":"plain"}])");
    made["materials"][0]["name"] = "own";
    made["materials"].push_back(Json::parse(R"({"name":"red","pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1]}})"));
    made["materials"].push_back(Json::parse(R"({"name":"golden","alphaMode":"BLEND"})"));
    made["meshes"][0]["primitives"][0]["extensions"][extension] = Json::parse(twoMappings);
    made["meshes"].push_back(made["meshes"][0]);
    Json& still = made["meshes"][1]["primitives"][0]["attributes"];
    still.erase("JOINTS_0");
    still.erase("WEIGHTS_0");
    made["scenes"][0]["nodes"].push_back(made["nodes"].size());
    made["nodes"].push_back({{"name", "still"}, {"mesh", 1}});
    return made;
}

ImportedModel importedIn(const std::string& variant, const Json& json = document())
{
    ImportOptions options;
    if (!variant.empty()) options.variant = variant;
    const Result<ImportedModel> model = importModel(json.dump(), "", options);
    EXPECT_TRUE(model) << model.error().message;
    return model ? model.value() : ImportedModel{};
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

struct Change
{
    const char* path;
    const char* value;   ///< JSON
    const char* message; ///< part of a warning; empty: none
    std::size_t left;    ///< usable mappings of the first primitive
};

const char* const root = "/extensions/KHR_materials_variants";
const char* const primitive = "/meshes/0/primitives/0/extensions/KHR_materials_variants";

const Change changes[] = {
    {"", "7", "variants: expected an array, found nothing; no variant is read", 0},
    {"/variants", "{}", "variants: expected an array, found an object", 0},
    {"/variants/1", "null", "variants[1].name: expected a text, found nothing; the variant gets another name", 2},
    {"/variants/1/name", "7", "variants[1].name: expected a text, found 7", 2},
    {"/variants/1/extras", "[]", "", 2},
};

const Change mappingChanges[] = {
    {"", "7", "meshes[0].primitives[0].extensions.KHR_materials_variants.mappings: expected an array", 0},
    {"/mappings/0", "[]", "mappings[0]: expected an object, found an array of 0; the mapping is left out", 1},
    {"/mappings/0/material", "3", "mappings[0].material: expected an index below 3 of the file's materials", 1},
    {"/mappings/0/material", "-1", "mappings[0].material", 1},
    {"/mappings/0/material", "0.5", "found 0.5", 1},
    {"/mappings/0/variants", "1", "mappings[0].variants: expected an array, found 1", 1},
    {"/mappings/0/variants", "[4]", "expected indices below 4 of the file's variants, found 4", 1},
    {"/mappings/0/variants", "[1,\"x\"]", "mappings[0].variants", 1},
    {"/mappings/1/variants", "[2,1]", "mappings[1].variants: expected each variant once, found 1 again", 1},
    {"/mappings/1/variants", "[2,2]", "found 2 again", 1},
    {"/mappings/1/variants", "[]", "", 2},
    {"/mappings/1/name", "\"x\"", "", 2},
};

void expectChange(const Change& change, const std::string& path)
{
    SCOPED_TRACE(path + change.path + " = " + change.value);
    Json made = document();
    made[Json::json_pointer(path + change.path)] = Json::parse(change.value);
    const LoadedDocument answer = load(made.dump());
    expectAnswer(answer, *change.message == '\0' ? Expect::Valid : Expect::Warn, change.message);
    ASSERT_TRUE(answer.model);
    const tinygltf::ExtensionMap& extensions = answer.model.value().meshes[0].primitives[0].extensions;
    const auto found = extensions.find(extension);
    std::size_t left = 0;
    if (found != extensions.end())
        for (std::size_t i = 0; i < found->second.Get("mappings").ArrayLen(); ++i)
            left += found->second.Get("mappings").Get(static_cast<int>(i)).Has("material") ? 1 : 0;
    EXPECT_EQ(left, change.left);
    EXPECT_TRUE(importModel(made.dump(), "", {}));
}

} // namespace

TEST(VariantRulesTest, aFaultCostsNoMoreThanItsMappingOrName)
{
    for (const Change& change : changes)
        expectChange(change, root);
    for (const Change& change : mappingChanges)
        expectChange(change, primitive);
}

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
    const Result<ImportedModel> refused = importModel(document().dump(), "", options);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().message, "variant \"blue\" was asked for; the file's variants are: \"plain\", "
                                       "\"red one\", \"gold\", \"plain 2\"");
}

TEST(VariantsTest, namesDiffer)
{
    Json made = document();
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
    const osg::ref_ptr<AnimatedCharacter> second = cloneOf(first), third = cloneOf(first);
    ASSERT_EQ(&meshOf(*second), &meshOf(first));

    ASSERT_TRUE(second->getMeshes().setVariant("red one"));
    EXPECT_EQ(shown(*second), "red");
    EXPECT_EQ(shown(first), "own");
    EXPECT_EQ(first.getMeshes().getVariant(), "");
    const auto& own = dynamic_cast<const SkinnedGeometry&>(meshOf(first));
    const auto& red = dynamic_cast<const SkinnedGeometry&>(meshOf(*second));
    EXPECT_EQ(red.getVertexArray(), own.getVertexArray());
    EXPECT_EQ(MeshDetail::levels(red, first.getAnimationSet()), MeshDetail::levels(own, first.getAnimationSet()));
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
        Json made = document();
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
        const std::size_t warnings = each.isShown ? 0 : 2; // one a primitive
        ASSERT_EQ(model.messages.warnings.size(), warnings);
        for (const std::string& warning : model.messages.warnings)
            EXPECT_NE(warning.find("its material of variant \"red one\" reads other texture coordinates"),
                      std::string::npos)
                << warning;
    }
}

} // namespace osgGpuAnimation::gltf
