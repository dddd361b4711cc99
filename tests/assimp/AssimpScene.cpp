// SPDX-License-Identifier: MIT
#include "assimp/AssimpScene.h"

#include "assimp/AssimpFile.h"

#include <glm/ext/matrix_transform.hpp>
#include <glm/ext/quaternion_double.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <functional>
#include <limits>

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

glm::dvec3 between(const glm::dvec3& from, const glm::dvec3& to, double share)
{
    return glm::mix(from, to, share);
}

glm::dquat between(const glm::dquat& from, const glm::dquat& to, double share)
{
    return glm::slerp(from, to, share); // the shorter way
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
    return between(valueOf(before), valueOf(*after), (ticks - before.mTime) / (after->mTime - before.mTime));
}

template <class Visit>
void forEachKeyTime(const aiAnimation& animation, const Visit& visit)
{
    for (unsigned int i = 0; i < animation.mNumChannels; ++i)
    {
        const aiNodeAnim& channel = *animation.mChannels[i];
        for (unsigned int k = 0; k < channel.mNumPositionKeys; ++k)
            visit(channel.mPositionKeys[k].mTime);
        for (unsigned int k = 0; k < channel.mNumRotationKeys; ++k)
            visit(channel.mRotationKeys[k].mTime);
        for (unsigned int k = 0; k < channel.mNumScalingKeys; ++k)
            visit(channel.mScalingKeys[k].mTime);
    }
}

} // namespace

AssimpScene::AssimpScene(const std::string& file)
{
    if (const Result<const aiScene*> read = assimp::readScene(_importer, file, {})) _scene = read.value();
}

double AssimpScene::start(unsigned int animation) const
{
    double first = 0.0;
    forEachKeyTime(*_scene->mAnimations[animation], [&](double ticks) { first = std::min(first, ticks); });
    return first / ticksPerSecond(*_scene->mAnimations[animation]);
}

double AssimpScene::duration(unsigned int animation) const
{
    double last = 0.0;
    forEachKeyTime(*_scene->mAnimations[animation], [&](double ticks) { last = std::max(last, ticks); });
    return last / ticksPerSecond(*_scene->mAnimations[animation]) - start(animation);
}

std::map<std::string, glm::dmat4> AssimpScene::nodes(unsigned int number, double time) const
{
    const aiAnimation& animation = *_scene->mAnimations[number];
    std::map<std::string, const aiNodeAnim*> channels;
    for (unsigned int i = 0; i < animation.mNumChannels; ++i)
        channels[animation.mChannels[i]->mNodeName.C_Str()] = animation.mChannels[i];
    const double ticks = time * ticksPerSecond(animation);
    std::map<std::string, glm::dmat4> result;
    const std::function<void(const aiNode&, const glm::dmat4&)> visit = [&](const aiNode& node, const glm::dmat4& above)
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
            local = glm::translate(glm::dmat4(1.0), at(keys.mPositionKeys, keys.mNumPositionKeys, ticks, translation)) *
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

std::vector<glm::dvec3> AssimpScene::vertices(const aiMesh& mesh, const std::string& node,
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

} // namespace osgGpuAnimation
