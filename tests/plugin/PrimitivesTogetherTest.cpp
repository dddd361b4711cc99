// SPDX-License-Identifier: MIT
// Primitives of a mesh that one drawable draws.
#include "gltf/scene/Meshes.h"
#include "plugin/ImportedFile.h"
#include "plugin/ModelBuilder.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace osgGpuAnimation::gltf
{

namespace
{

using Primitive = tinygltf::Primitive;
using Groups = std::vector<std::vector<int>>;

constexpr const char* variants = "KHR_materials_variants";

int indicesOf(ModelBuilder& file, const std::vector<unsigned int>& numbers)
{
    return file.integers(TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, numbers);
}

/// Three primitives over five vertices, each with other indices: lines, or another mode.
struct ThreePrimitives : ModelBuilder
{
    explicit ThreePrimitives(int mode = TINYGLTF_MODE_LINE)
    {
        model.materials.resize(2);
        const int points = floats(TINYGLTF_TYPE_VEC3, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 2, 0});
        mesh({{"POSITION", points}, {"NORMAL", points}}, mode, indicesOf(*this, {4, 0, 1, 3}));
        primitive(0).material = 0;
        primitives().resize(3, primitive(0));
        primitives()[1].indices = indicesOf(*this, {0, 2});
        primitives()[2].indices = indicesOf(*this, {3, 4});
    }

    std::vector<Primitive>& primitives() { return model.meshes[0].primitives; }
};

/// Reads the meshes of a file, which must outlive this.
struct ReadMeshes
{
    explicit ReadMeshes(const ModelBuilder& file, std::size_t bytes = std::size_t(1) << 30)
        : budget(bytes), report(messages), maps(file.model, true), meshes(file.model, maps, budget, report)
    {
    }

    Messages messages;
    MemoryBudget budget;
    Report report;
    MapsOfMaterials maps;
    Meshes meshes;
};

Groups groupsOf(const ModelBuilder& file)
{
    ReadMeshes read(file);
    Groups groups;
    for (const int first : read.meshes.firstPrimitives(0))
        if (const MeshPrimitive* drawn = read.meshes.primitive(0, first)) groups.push_back(*drawn->primitives);
    return groups;
}

std::vector<unsigned int> indicesOf(const MeshPrimitive& mesh)
{
    std::vector<unsigned int> indices;
    for (unsigned int i = 0; i < mesh.primitiveSet->getNumIndices(); ++i)
        indices.push_back(mesh.primitiveSet->index(i));
    return indices;
}

/// Material 1 in variant 0.
void mapVariant(Primitive& primitive)
{
    tinygltf::Value::Object mapping, extension;
    mapping["material"] = tinygltf::Value(1);
    mapping["variants"] = tinygltf::Value(tinygltf::Value::Array{tinygltf::Value(0)});
    extension["mappings"] = tinygltf::Value(tinygltf::Value::Array{tinygltf::Value(mapping)});
    primitive.extensions[variants] = tinygltf::Value(extension);
}

const Groups together{{0, 1, 2}}, secondApart{{0, 2}, {1}}, allApart{{0}, {1}, {2}};

struct Change
{
    const char* name;
    void (*change)(ThreePrimitives& file);
    Groups groups;
};

const Change changes[] = {
    {"only the indices differ", [](ThreePrimitives&) {}, together},
    {"no indices", [](ThreePrimitives& file) { file.primitives()[1].indices = -1; }, together},
    {"attributes",
     [](ThreePrimitives& file)
     { file.primitives()[1].attributes["POSITION"] = file.floats(TINYGLTF_TYPE_VEC3, std::vector<float>(15, 1.0f)); },
     secondApart},
    {"an attribute less", [](ThreePrimitives& file) { file.primitives()[1].attributes.erase("NORMAL"); }, secondApart},
    {"targets",
     [](ThreePrimitives& file) {
         file.primitives()[1].targets = {{{"POSITION", 0}}};
     },
     secondApart},
    {"material", [](ThreePrimitives& file) { file.primitives()[1].material = 1; }, secondApart},
    {"no material", [](ThreePrimitives& file) { file.primitives()[1].material = -1; }, secondApart},
    {"mode", [](ThreePrimitives& file) { file.primitives()[1].mode = TINYGLTF_MODE_POINTS; }, secondApart},
    {"the material of a variant", [](ThreePrimitives& file) { mapVariant(file.primitives()[1]); }, secondApart},
    {"the same material in a variant",
     [](ThreePrimitives& file) { std::for_each(file.primitives().begin(), file.primitives().end(), mapVariant); },
     together},
    {"nothing to draw", [](ThreePrimitives& file) { file.primitives()[1].indices = indicesOf(file, {2}); }, {{0, 2}}},
    {"no vertices", [](ThreePrimitives& file) { file.primitives()[1].attributes.clear(); }, {{0, 2}}},
    {"strips",
     [](ThreePrimitives& file)
     { std::for_each(file.primitives().begin(), file.primitives().end(), [](Primitive& p) { p.mode = 3; }); },
     allApart},
    {"blended", [](ThreePrimitives& file) { file.model.materials[0].alphaMode = "BLEND"; }, allApart},
    {"transmissive",
     [](ThreePrimitives& file) { file.model.materials[0].extensions["KHR_materials_transmission"] = {}; }, allApart},
    {"blended in a variant",
     [](ThreePrimitives& file)
     {
         file.model.materials[1].alphaMode = "BLEND";
         std::for_each(file.primitives().begin(), file.primitives().end(), mapVariant);
     },
     allApart},
};

} // namespace

TEST(PrimitivesTogetherTest, theyHaveTheSameVerticesAndMaterials)
{
    for (const Change& each : changes)
    {
        SCOPED_TRACE(each.name);
        ThreePrimitives file;
        each.change(file);
        EXPECT_EQ(groupsOf(file), each.groups);
    }
}

TEST(PrimitivesTogetherTest, indicesKeepTheOrderOfTheFile)
{
    ThreePrimitives file;
    EXPECT_EQ(indicesOf(*ReadMeshes(file).meshes.primitive(0, 0)), (std::vector<unsigned int>{4, 0, 1, 3, 0, 2, 3, 4}));
    file.primitives()[0].indices = indicesOf(file, {4, 0, 1}); // half a line is not drawn
    file.primitives()[1].indices = -1;                         // likewise
    EXPECT_EQ(indicesOf(*ReadMeshes(file).meshes.primitive(0, 0)), (std::vector<unsigned int>{4, 0, 0, 1, 2, 3, 3, 4}));
}

TEST(PrimitivesTogetherTest, trianglesWithoutNormalsAreFlatTogether)
{
    ThreePrimitives file(TINYGLTF_MODE_TRIANGLES);
    for (Primitive& primitive : file.primitives())
    {
        primitive.attributes.erase("NORMAL");
        primitive.indices = indicesOf(file, {0, 1, 2});
    }
    ReadMeshes read(file);
    const MeshPrimitive* mesh = read.meshes.primitive(0, 0);
    ASSERT_TRUE(mesh);
    EXPECT_EQ(mesh->primitives->size(), 3u);
    EXPECT_EQ(mesh->primitiveSet->getNumIndices(), 9u);
    EXPECT_EQ(*mesh->geometryVertex, (std::vector<std::uint32_t>{0, 1, 2, 9, 10})); // two are not drawn
}

TEST(PrimitivesTogetherTest, ofTooManyThoseThatFitAreDrawn)
{
    ThreePrimitives file;
    file.primitives()[1].indices = indicesOf(file, std::vector<unsigned int>(400, 1));
    ReadMeshes all(file);
    ASSERT_TRUE(all.meshes.primitive(0, 0));
    const std::size_t bytes = (std::size_t(1) << 30) - all.budget.left();
    ReadMeshes read(file, bytes - 400);
    const MeshPrimitive* mesh = read.meshes.primitive(0, 0);
    ASSERT_TRUE(mesh);
    EXPECT_EQ(*mesh->primitives, (std::vector<int>{0, 2}));
    EXPECT_EQ(indicesOf(*mesh), (std::vector<unsigned int>{4, 0, 1, 3, 3, 4}));
    ASSERT_EQ(read.messages.warnings.size(), 1u);
    EXPECT_EQ(read.messages.warnings[0].rfind("meshes[0] \"mesh0\".primitives[1]: it would take 4800 bytes", 0), 0u)
        << read.messages.warnings[0];
}

TEST(PrimitivesTogetherTest, aNodeHasOneDrawableForAll)
{
    ThreePrimitives file;
    file.model.meshes.push_back(file.model.meshes[0]);
    file.model.meshes[1].primitives[1].material = 1;
    const int stones[] = {file.node("stone", -1, 1), file.node("stone", -1, 1)};
    const int arm = file.node("arm", -1, 1);
    file.animation("wave");
    file.slide(arm);
    const ImportedModel model = imported(file);
    EXPECT_TRUE(model.messages.warnings.empty());
    ASSERT_EQ(model.primitives.size(), 6u);
    for (std::size_t i = 0; i < model.primitives.size(); i += 2)
    {
        EXPECT_EQ(*model.primitives[i].primitives, (std::vector<int>{0, 2}));
        EXPECT_EQ(*model.primitives[i + 1].primitives, std::vector<int>{1});
        EXPECT_EQ(model.primitives[i].geometry->getPrimitiveSet(0)->getNumIndices(), 6u);
        EXPECT_EQ(model.primitives[i].geometry->getVertexArray(), model.primitives[0].geometry->getVertexArray());
    }
    EXPECT_EQ(primitiveOf(model, stones[0]).geometry, primitiveOf(model, stones[1]).geometry);
    EXPECT_EQ(primitiveOf(model, stones[0]).geometry->getParent(0)->getNumChildren(), 2u);
    EXPECT_EQ(model.character->getNumChildren(), 2u);
}

} // namespace osgGpuAnimation::gltf
