// SPDX-License-Identifier: MIT
// Small files that require much memory or time.
#include "gltf/ImportedFile.h"
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

enum class Kind
{
    Static,
    OnAnimatedJoint,
    Skinned, ///< one skin per node, all with the same joint
    Morphing ///< with their own weights
};

/// 20,000 nodes with one mesh of 99,999 vertices.
std::string manyNodes(Kind kind)
{
    constexpr std::size_t vertices = 99999;
    ModelBuilder file;
    std::map<std::string, int> attributes;
    attributes["POSITION"] = file.floats(TINYGLTF_TYPE_VEC3, std::vector<float>(3 * vertices, 1.0f));
    if (kind == Kind::Skinned)
    {
        attributes["JOINTS_0"] = file.integers(TINYGLTF_TYPE_VEC4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE,
                                               std::vector<unsigned int>(4 * vertices, 0));
        std::vector<float> weights;
        for (std::size_t i = 0; i < vertices; ++i)
            weights.insert(weights.end(), {1, 0, 0, 0});
        attributes["WEIGHTS_0"] = file.floats(TINYGLTF_TYPE_VEC4, weights);
    }
    const int mesh = file.mesh(attributes), joint = file.node("joint");
    if (kind == Kind::OnAnimatedJoint) file.slidingClip("slide", joint);
    if (kind == Kind::Morphing) file.primitive(mesh).targets.push_back(attributes);
    for (int i = 0; i < 20000; ++i)
    {
        const int node = file.node("", kind == Kind::OnAnimatedJoint ? joint : -1, mesh);
        if (kind == Kind::Skinned) file.at(node).skin = file.skin({joint});
        if (kind == Kind::Morphing) file.at(node).weights = {0.5};
    }
    return file.text();
}

/// The element so many times.
std::string list(const std::string& element, std::size_t count)
{
    std::string text = element;
    for (std::size_t i = 1; i < count; ++i)
        text += ',' + element;
    return text;
}

std::string documentOf(const std::string& members)
{
    return R"({"asset":{"version":"2.0"},)" + members + '}';
}

/// Ten buffers of that many bytes each in data URIs.
std::string dataUris(std::size_t bytes)
{
    const std::string buffer = R"({"byteLength":)" + std::to_string(bytes) + R"(,"uri":"data:;base64,)" +
                               std::string(bytes / 3 * 4, 'A') + "\"}";
    return documentOf("\"buffers\":[" + list(buffer, 10) + ']');
}

/// One long string that is not a data URI.
std::string longName(std::size_t letters)
{
    return R"({"asset":{"version":"2.0","generator":")" + std::string(letters, 'x') + R"("}})";
}

/// A document with a list of `count` empty objects.
std::string emptyObjects(const std::string& name, std::size_t count)
{
    return documentOf('"' + name + "\":[" + list("{}", count) + ']');
}

std::string extras(std::size_t values)
{
    return documentOf(R"("nodes":[{"extras":{"all":[)" + list("0", values) + "]}}]");
}

struct Case
{
    const char* name;
    std::string text;
    const char* message = ""; ///< part of the error; empty: the model is drawn
    std::size_t ImportOptions::*limit = nullptr;
    std::size_t value = 0; ///< of the limit
};

} // namespace

TEST(ManyElementsTest, staySmallAndQuick)
{
    const auto maxDocument = &ImportOptions::maxDocumentBytes;
    const Case cases[] = {
        {"static", manyNodes(Kind::Static)},
        {"on an animated joint", manyNodes(Kind::OnAnimatedJoint)},
        {"skinned", manyNodes(Kind::Skinned)},
        {"morphing", manyNodes(Kind::Morphing)},
        {"ten data URIs of 12 MB", dataUris(12000000)},
        {"data URIs count before they are decoded", dataUris(12000000),
         "buffers[8].byteLength: expected at most 100000000 bytes", &ImportOptions::maxDecodedBytes, 100000000},
        {"a long string", longName(70000000)},
        {"a longer string", longName(100000000), "JSON: expected strings of at most"},
        {"300,000 empty nodes", emptyObjects("nodes", 300000)},
        {"1,000,000 empty nodes", emptyObjects("nodes", 1000000), "nodes: expected a document of at most"},
        {"1,000,000 empty materials", emptyObjects("materials", 1000000), "materials: expected a document of at most"},
        {"1,000 empty nodes", emptyObjects("nodes", 1000), "", maxDocument, 1000000},
        {"2,000 empty nodes", emptyObjects("nodes", 2000), "limit maxDocumentBytes), found 2000", maxDocument, 1000000},
        // A value of extras takes more than twice the 48 bytes of a value in the tree.
        {"extras", extras(250), "", maxDocument, 100000},
        {"more extras", extras(500), "limit maxDocumentBytes", maxDocument, 100000},
    };
    for (const Case& one : cases)
    {
        const long before = peakMemory();
        SCOPED_TRACE(one.name);
        ImportOptions options;
        if (one.limit) options.*one.limit = one.value;
        const std::clock_t start = std::clock(); // CPU time: other programs may run
        if (*one.message == '\0')
            imported(one.text, options);
        else
            expectRefused(one.text, one.message, options);
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
            if (isMoving) file.slidingClip("slide", node);
            if (isOneMesh)
            {
                file.primitive(mesh).mode = TINYGLTF_MODE_TRIANGLE_STRIP; // so that each has a drawable of its own
                file.model.meshes[0].primitives.resize(10000, file.primitive(mesh));
            }
            else
                for (int i = 0; i < 10000; ++i)
                    file.node("", node, mesh);
            const ImportedModel model = imported(file);
            EXPECT_GE(model.primitives.size(), 10000u);
            MostParents visitor;
            model.root->accept(visitor);
            EXPECT_LE(visitor.most, 4096u);
            EXPECT_LE(visitor.stateSets.size(), 3u) << "still shared: OSG sorts by them";
        }
}

} // namespace osgGpuAnimation::gltf
