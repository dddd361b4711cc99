// SPDX-License-Identifier: MIT
// Small files that require much memory or time.
#include "gltf/Import.h"
#include "plugin/ModelBuilder.h"
#include "support/PeakMemory.h"

#include <gtest/gtest.h>

#include <osg/NodeVisitor>
#include <osg/StateSet>

#include <algorithm>
#include <ctime>
#include <set>
#include <string>

namespace osgGpuAnimation::gltf
{

namespace
{

constexpr unsigned int vertices = 99999;
constexpr int nodes = 20000;

/// One mesh of 99,999 vertices.
struct LargeMesh : ModelBuilder
{
    std::map<std::string, int> attributes{
        {"POSITION", floats(TINYGLTF_TYPE_VEC3, std::vector<float>(3 * vertices, 1.0f))}};

    void beSkinned()
    {
        const std::vector<unsigned int> joints(4 * vertices, 0);
        std::vector<float> weights;
        for (unsigned int i = 0; i < vertices; ++i)
            weights.insert(weights.end(), {1, 0, 0, 0});
        attributes["JOINTS_0"] = integers(TINYGLTF_TYPE_VEC4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, joints);
        attributes["WEIGHTS_0"] = floats(TINYGLTF_TYPE_VEC4, weights);
    }
};

std::string staticNodes()
{
    LargeMesh file;
    const int mesh = file.mesh(file.attributes);
    for (int i = 0; i < nodes; ++i)
        file.node("", -1, mesh);
    return file.text();
}

std::string nodesOnAnAnimatedJoint()
{
    LargeMesh file;
    const int mesh = file.mesh(file.attributes);
    const int joint = file.node("joint");
    file.animation("slide");
    file.slide(joint);
    for (int i = 0; i < nodes; ++i)
        file.node("", joint, mesh);
    return file.text();
}

/// One skin per node, all with the same joint.
std::string skinnedNodes()
{
    LargeMesh file;
    file.beSkinned();
    const int mesh = file.mesh(file.attributes);
    const int joint = file.node("joint");
    for (int i = 0; i < nodes; ++i)
    {
        const int skin = file.skin({joint});
        file.at(file.node("", -1, mesh)).skin = skin;
    }
    return file.text();
}

/// Nodes with their own morph weights.
std::string morphingNodes()
{
    LargeMesh file;
    const int mesh = file.mesh(file.attributes);
    file.primitive(mesh).targets.push_back({{"POSITION", file.attributes["POSITION"]}});
    for (int i = 0; i < nodes; ++i)
        file.at(file.node("", -1, mesh)).weights = {0.5};
    return file.text();
}

/// Ten buffers of that many bytes each in data URIs.
std::string dataUris(std::size_t bytes)
{
    const std::string buffer = R"({"byteLength":)" + std::to_string(bytes) + R"(,"uri":"data:;base64,)" +
                               std::string(bytes / 3 * 4, 'A') + "\"}";
    std::string text = R"({"asset":{"version":"2.0"},"buffers":[)" + buffer;
    for (int i = 1; i < 10; ++i)
        text += ',' + buffer;
    return text + "]}";
}

/// One long string that is not a data URI.
std::string longName(std::size_t letters)
{
    return R"({"asset":{"version":"2.0","generator":")" + std::string(letters, 'x') + R"("}})";
}

/// A document with a list of `count` empty objects.
std::string emptyObjects(const std::string& list, std::size_t count)
{
    std::string text = R"({"asset":{"version":"2.0"},")" + list + "\":[{}";
    for (std::size_t i = 1; i < count; ++i)
        text += ",{}";
    return text + "]}";
}

struct ManyCase
{
    const char* name;
    std::string text;
    const char* message; ///< part of the error; empty: the model is drawn
};

} // namespace

TEST(ManyElementsTest, staySmallAndQuick)
{
    const ManyCase cases[] = {
        {"static", staticNodes(), ""},
        {"on an animated joint", nodesOnAnAnimatedJoint(), ""},
        {"skinned", skinnedNodes(), ""},
        {"morphing", morphingNodes(), ""},
        {"ten data URIs of 12 MB", dataUris(12000000), ""},
        {"a long string", longName(70000000), ""},
        {"a longer string", longName(100000000), "JSON: expected strings of at most"},
        {"300,000 empty nodes", emptyObjects("nodes", 300000), ""},
        {"1,000,000 empty nodes", emptyObjects("nodes", 1000000), "nodes: expected a document of at most"},
        {"1,000,000 empty materials", emptyObjects("materials", 1000000), "materials: expected a document of at most"},
    };
    for (const ManyCase& many : cases)
    {
        const long before = peakMemory();
        SCOPED_TRACE(many.name);
        const std::clock_t start = std::clock(); // CPU time: other programs may run
        const Result<ImportedModel> model = importModel(many.text, "", {});
        EXPECT_EQ(bool(model), *many.message == '\0');
        if (!model)
        {
            EXPECT_NE(model.error().message.find(many.message), std::string::npos) << model.error().message;
        }
        EXPECT_LT(double(std::clock() - start) / CLOCKS_PER_SEC, mostSeconds);
        if (memoryIsMeasurable)
        {
            EXPECT_LT(peakMemory() - before, mostMebibytes);
        }
    }
}

// OSG removes a parent by linear search, so objects with many parents take quadratic time at their release.
TEST(ManyElementsTest, noObjectHasManyParents)
{
    struct MostParents : osg::NodeVisitor
    {
        MostParents() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
        void apply(osg::Node& node) override
        {
            most = std::max(most, node.getNumParents());
            if (const osg::StateSet* state = node.getStateSet())
            {
                stateSets.insert(state);
                most = std::max(most, state->getNumParents());
                for (const auto& attribute : state->getAttributeList())
                    most = std::max(most, attribute.second.first->getNumParents());
            }
            traverse(node);
        }
        unsigned int most = 0;
        std::set<const osg::StateSet*> stateSets;
    };
    for (bool isMoving : {false, true})
        for (bool isOneMesh : {false, true})
        {
            SCOPED_TRACE(std::to_string(isMoving) + std::to_string(isOneMesh));
            ModelBuilder file;
            const int mesh = file.triangle();
            const int node = file.node("many", -1, mesh);
            if (isMoving)
            {
                file.animation("slide");
                file.slide(node);
            }
            if (isOneMesh)
            {
                file.primitive(mesh).mode = TINYGLTF_MODE_TRIANGLE_STRIP; // so that each has a drawable of its own
                file.model.meshes[0].primitives.resize(10000, file.primitive(mesh));
            }
            else
                for (int i = 0; i < 10000; ++i)
                    file.node("", node, mesh);
            const Result<ImportedModel> model = importModel(file.text(), "", {});
            ASSERT_TRUE(model) << model.error().message;
            EXPECT_GE(model.value().primitives.size(), 10000u);
            MostParents visitor;
            model.value().root->accept(visitor);
            EXPECT_LE(visitor.most, 4096u);
            EXPECT_LE(visitor.stateSets.size(), 3u) << "still shared: OSG sorts by them";
        }
}

TEST(ManyElementsTest, dataUrisCountBeforeTheyAreDecoded)
{
    ImportOptions options;
    options.maxDecodedBytes = 100000000;
    const Result<ImportedModel> model = importModel(dataUris(12000000), "", options);
    ASSERT_FALSE(model);
    EXPECT_EQ(model.error().message.rfind("buffers[8].byteLength: expected at most 100000000 bytes", 0), 0u)
        << model.error().message;
}

TEST(ManyElementsTest, theDocumentsLimitIsTheCallers)
{
    ImportOptions options;
    options.maxDocumentBytes = 1000000;
    EXPECT_TRUE(importModel(emptyObjects("nodes", 1000), "", options));
    const Result<ImportedModel> refused = importModel(emptyObjects("nodes", 2000), "", options);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("limit maxDocumentBytes), found 2000"), std::string::npos)
        << refused.error().message;
}

// A value of extras takes more than twice the 48 bytes of a value in the tree.
TEST(ManyElementsTest, everyValueOfExtrasCounts)
{
    const auto withExtras = [](int values)
    {
        std::string text = R"({"asset":{"version":"2.0"},"nodes":[{"extras":{"all":[0)";
        for (int i = 1; i < values; ++i)
            text += ",0";
        return text + "]}}]}";
    };
    ImportOptions options;
    options.maxDocumentBytes = 100000;
    EXPECT_TRUE(importModel(withExtras(250), "", options));
    const Result<ImportedModel> refused = importModel(withExtras(500), "", options);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("limit maxDocumentBytes"), std::string::npos) << refused.error().message;
}

} // namespace osgGpuAnimation::gltf
