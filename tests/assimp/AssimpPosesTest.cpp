// SPDX-License-Identifier: MIT
#include "assimp/AssimpFile.h"
#include "assimp/SmallFiles.h"
#include "plugin/ModelVertices.h"
#include "plugin/PluginFolder.h"
#include "plugin/SharedAssets.h"
#include "serializers/RoundTrip.h"
#include "support/ScratchFolder.h"

#include <assimp/Importer.hpp>
#include <assimp/scene.h>

#include <glm/ext/matrix_transform.hpp>
#include <glm/ext/quaternion_double.hpp>
#include <glm/gtc/quaternion.hpp>

#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <algorithm>
#include <functional>
#include <random>
#include <type_traits>

namespace osgGpuAnimation
{

namespace
{

double ticksPerSecond(const aiAnimation& animation)
{
    return animation.mTicksPerSecond > 0.0 ? animation.mTicksPerSecond : 25.0;
}

glm::dmat4 toGlm(const aiMatrix4x4& matrix)
{
    glm::dmat4 result;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            result[column][row] = static_cast<double>(matrix[static_cast<unsigned int>(row)][column]);
    return result;
}

glm::dvec3 valueOf(const aiVectorKey& key)
{
    return {key.mValue.x, key.mValue.y, key.mValue.z};
}

glm::dquat valueOf(const aiQuatKey& key)
{
    return glm::normalize(glm::dquat(key.mValue.w, key.mValue.x, key.mValue.y, key.mValue.z));
}

template <class Value, class Key>
Value at(const Key* keys, unsigned int count, double ticks, const Value& without)
{
    if (count == 0) return without;
    const Key* const after =
        std::upper_bound(keys, keys + count, ticks, [](double time, const Key& key) { return time < key.mTime; });
    if (after == keys) return valueOf(keys[0]);
    if (after == keys + count) return valueOf(keys[count - 1]);
    const Key& before = after[-1];
    const double share = (ticks - before.mTime) / (after->mTime - before.mTime);
    if constexpr (std::is_same_v<Value, glm::dquat>)
        return glm::slerp(valueOf(before), valueOf(*after), share); // the shorter way
    else
        return glm::mix(valueOf(before), valueOf(*after), share);
}

/// A file as Assimp has it, evaluated key by key in double precision: an opinion on poses that shares nothing with the
/// conversion.
class AssimpScene
{
public:
    explicit AssimpScene(const std::string& file)
    {
        gltf::Messages messages;
        gltf::Report report(messages);
        if (const Result<const aiScene*> read = assimp::readScene(_importer, file, {}, report)) _scene = read.value();
    }

    const aiScene* scene() const { return _scene; } ///< null: Assimp cannot read it
    /// The times of the first key, or 0, and of the last one, in seconds.
    std::pair<double, double> range(unsigned int number) const
    {
        const aiAnimation& animation = *_scene->mAnimations[number];
        double first = 0.0, last = 0.0;
        const auto add = [&](const auto* keys, unsigned int count)
        {
            for (unsigned int i = 0; i < count; ++i)
            {
                first = std::min(first, keys[i].mTime);
                last = std::max(last, keys[i].mTime);
            }
        };
        for (unsigned int i = 0; i < animation.mNumChannels; ++i)
        {
            const aiNodeAnim& channel = *animation.mChannels[i];
            add(channel.mPositionKeys, channel.mNumPositionKeys);
            add(channel.mRotationKeys, channel.mNumRotationKeys);
            add(channel.mScalingKeys, channel.mNumScalingKeys);
        }
        return {first / ticksPerSecond(animation), last / ticksPerSecond(animation)};
    }

    /// The matrices of all nodes to the scene, by name; time: seconds of the animation.
    std::map<std::string, glm::dmat4> nodes(unsigned int number, double time) const
    {
        const aiAnimation& animation = *_scene->mAnimations[number];
        std::map<std::string, const aiNodeAnim*> channels;
        for (unsigned int i = 0; i < animation.mNumChannels; ++i)
            channels[animation.mChannels[i]->mNodeName.C_Str()] = animation.mChannels[i];
        const double ticks = time * ticksPerSecond(animation);
        std::map<std::string, glm::dmat4> result;
        const std::function<void(const aiNode&, const glm::dmat4&)> visit =
            [&](const aiNode& node, const glm::dmat4& above)
        {
            glm::dmat4 local = toGlm(node.mTransformation);
            if (const auto found = channels.find(node.mName.C_Str()); found != channels.end())
            {
                const aiNodeAnim& keys = *found->second;
                const glm::dvec3 translation(local[3]);
                const glm::dvec3 scale(glm::length(glm::dvec3(local[0])), glm::length(glm::dvec3(local[1])),
                                       glm::length(glm::dvec3(local[2])));
                const glm::dquat rotation = glm::quat_cast(glm::dmat3(
                    glm::dvec3(local[0]) / scale.x, glm::dvec3(local[1]) / scale.y, glm::dvec3(local[2]) / scale.z));
                local =
                    glm::translate(glm::dmat4(1.0), at(keys.mPositionKeys, keys.mNumPositionKeys, ticks, translation)) *
                    glm::mat4_cast(at(keys.mRotationKeys, keys.mNumRotationKeys, ticks, rotation)) *
                    glm::scale(glm::dmat4(1.0), at(keys.mScalingKeys, keys.mNumScalingKeys, ticks, scale));
            }
            const glm::dmat4 world = above * local;
            result.emplace(node.mName.C_Str(), world);
            for (unsigned int i = 0; i < node.mNumChildren; ++i)
                visit(*node.mChildren[i], world);
        };
        visit(*_scene->mRootNode, glm::dmat4(1.0));
        return result;
    }
    /// The skinned vertices of a mesh of a node.
    std::vector<glm::dvec3> vertices(const aiMesh& mesh, const std::string& node,
                                     const std::map<std::string, glm::dmat4>& nodes) const
    {
        std::vector<glm::dvec4> sums(mesh.mNumVertices);
        const auto position = [&](unsigned int vertex)
        {
            const aiVector3D& at = mesh.mVertices[vertex];
            return glm::dvec4(at.x, at.y, at.z, 1.0);
        };
        for (unsigned int b = 0; b < mesh.mNumBones; ++b)
        {
            const aiBone& bone = *mesh.mBones[b];
            const glm::dmat4 matrix = nodes.at(bone.mName.C_Str()) * toGlm(bone.mOffsetMatrix);
            for (unsigned int w = 0; w < bone.mNumWeights; ++w)
                sums[bone.mWeights[w].mVertexId] +=
                    static_cast<double>(bone.mWeights[w].mWeight) * (matrix * position(bone.mWeights[w].mVertexId));
        }
        std::vector<glm::dvec3> result;
        for (unsigned int vertex = 0; vertex < mesh.mNumVertices; ++vertex)
            result.emplace_back(sums[vertex].w > 0.0 ? glm::dvec3(sums[vertex]) / sums[vertex].w
                                                     : glm::dvec3(nodes.at(node) * position(vertex)));
        return result;
    }

private:
    Assimp::Importer _importer;
    const aiScene* _scene = nullptr;
};

constexpr double tolerance = 1e-4; // of the model's size

gltf::ImportOptions asInTheFile()
{
    gltf::ImportOptions options;
    options.noRotation = true;
    return options;
}

gltf::ImportedModel imported(const std::string& file, const gltf::ImportOptions& options = asInTheFile())
{
    gltf::Messages messages;
    gltf::Report report(messages);
    gltf::ImportedModel model =
        valueOf(gltf::importModel(valueOf(assimp::readAsGlb(file, options, report)), file, options));
    EXPECT_TRUE(model.messages.warnings.empty()) << model.messages.warnings.front();
    return model;
}

/// The largest distance between the two, and the size of all.
struct Difference
{
    double distance = 0.0;
    double size = 0.0;

    void add(const glm::dvec3& expected, const glm::dvec3& found)
    {
        distance = std::max(distance, glm::length(expected - found));
        for (int axis = 0; axis < 3; ++axis)
            size = std::max(size, std::abs(expected[axis]));
    }
};

Difference differenceAt(const AssimpScene& expected, const gltf::ImportedModel& model, unsigned int animation,
                        double time)
{
    Difference difference;
    const auto nodes = expected.nodes(animation, expected.range(animation).first + time);
    const gltf::ModelVertices pose(model, static_cast<int>(animation), time);
    for (const auto& [name, matrix] : nodes)
    {
        const int joint = model.set->skeleton().findJoint(name);
        if (joint < 0) continue; // nothing moves it
        const AffineMatrix& found = pose.jointToModel()[static_cast<std::size_t>(joint)];
        for (int column = 0; column < 4; ++column)
        {
            const glm::dvec3 at(found.rows[0][column], found.rows[1][column], found.rows[2][column]);
            if (column == 3)
                difference.add(glm::dvec3(matrix[3]), at);
            else
                EXPECT_LE(glm::length(glm::dvec3(matrix[column]) - at),
                          tolerance * std::max(1.0, glm::length(glm::dvec3(matrix[column]))))
                    << name << " at " << time;
        }
    }
    for (const gltf::ImportedPrimitive& primitive : model.primitives)
    {
        const std::string& node = model.nodeNames[static_cast<std::size_t>(primitive.node)];
        const aiNode* const owner = expected.scene()->mRootNode->FindNode(node.c_str());
        if (!owner || owner->mNumMeshes != 1) continue;
        const auto vertices = expected.vertices(*expected.scene()->mMeshes[owner->mMeshes[0]], node, nodes);
        const std::vector<glm::dvec3> found = pose.positions(primitive);
        EXPECT_EQ(vertices.size(), found.size());
        for (std::size_t vertex = 0; vertex < std::min(vertices.size(), found.size()); ++vertex)
            difference.add(vertices[vertex], found[vertex]);
    }
    return difference;
}

void expectSamePoses(const std::string& file)
{
    const AssimpScene expected(file);
    ASSERT_TRUE(expected.scene());
    const gltf::ImportedModel model = imported(file);
    ASSERT_TRUE(model.set);
    ASSERT_EQ(model.set->clips().size(), expected.scene()->mNumAnimations);
    std::mt19937 random(7);
    for (unsigned int animation = 0; animation < expected.scene()->mNumAnimations; ++animation)
    {
        const double duration = expected.range(animation).second - expected.range(animation).first;
        EXPECT_NEAR(model.set->clips()[animation].duration(), duration, 1e-5);
        for (int i = 0; i < 20; ++i)
        {
            const double time = std::uniform_real_distribution<double>(0.0, duration)(random);
            const Difference difference = differenceAt(expected, model, animation, time);
            EXPECT_GT(difference.size, 0.0);
            EXPECT_LE(difference.distance, tolerance * difference.size) << "at " << time;
        }
    }
}

class AssimpPosesTest : public ::testing::Test
{
protected:
    ScratchFolder folder;
};

TEST_F(AssimpPosesTest, sharedFilesTakeThePosesOfAssimpsScene)
{
    for (const char* file : {"animation_with_skeleton.fbx", "huesitos.fbx", "01_01.bvh"})
    {
        SCOPED_TRACE(file);
        SKIP_WITHOUT_SHARED_FILE("assets/assimp/" + std::string(file));
        expectSamePoses(sharedFile("assets/assimp/" + std::string(file)));
    }
}

TEST_F(AssimpPosesTest, filesOfDoom3TakeThePosesOfAssimpsScene)
{
    folder.write("arm.md5anim", md5Anim());
    expectSamePoses(folder.write("arm.md5mesh", md5Mesh()));
}

// Assimp 5.4 gives other offset matrices, and turns the root itself.
TEST_F(AssimpPosesTest, skinsOfFbxRestWhereTheFileHasThem)
{
    const gltf::ImportedModel model = imported(folder.write("sheet.fbx", skinnedFbx()));
    ASSERT_TRUE(model.set);
    const std::vector<glm::dvec3> found = gltf::ModelVertices(model, -1, 0.0).positions(model.primitives.at(0));
    const glm::dvec3 expected[] = {{2, 3, 0}, {3, 3, 0}, {2, 4, 0}};
    ASSERT_EQ(found.size(), 3u);
    for (std::size_t vertex = 0; vertex < 3; ++vertex)
        EXPECT_LT(glm::length(found[vertex] - expected[vertex]), 1e-5) << vertex;
}

using ExportedFilesTest = AssimpPosesTest;

TEST_F(ExportedFilesTest, filesOfOtherFormatsComeBackFromAGlb)
{
    for (const char* name : {"animation_with_skeleton.fbx", "huesitos.fbx", "01_01.bvh"})
    {
        SCOPED_TRACE(name);
        SKIP_WITHOUT_SHARED_FILE(std::string("assets/assimp/") + name);
        const gltf::ImportedModel model = imported(sharedFile(std::string("assets/assimp/") + name), {});
        const osg::ref_ptr<osg::Group> read = throughGlb(*model.root);
        expectSameClips(*model.root, *read);
    }
}

/// The clips of another file, of a format that Assimp reads, and the plugin's writer.
TEST_F(ExportedFilesTest, clipsOfOtherFormatsAreMergedAndWritten)
{
    usePluginsOfTheBuild();
    folder.write("arm.md5anim", md5Anim());
    folder.write("other.md5anim", md5Anim());
    folder.write("other.md5mesh", md5Mesh());
    const std::string file = folder.write("arm.md5mesh", md5Mesh());
    const osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile(file, new osgDB::Options("clips=other.md5mesh"));
    ASSERT_TRUE(scene);
    ASSERT_EQ(findCharacter(*scene)->getAnimationSet().clips().size(), 2u);
    const std::string written = folder.file("arm.glb");
    ASSERT_TRUE(osgDB::writeNodeFile(*scene, written));
    const osg::ref_ptr<osg::Node> read = osgDB::readRefNodeFile(written);
    ASSERT_TRUE(read);
    expectSameClips(*scene, *read);
}

} // namespace

} // namespace osgGpuAnimation
