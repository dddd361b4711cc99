// SPDX-License-Identifier: MIT
#include "assimp/SceneConversion.h"

#include "assimp/FbxConversion.h"
#include "assimp/MaterialConversion.h"
#include "assimp/MeshConversion.h"
#include "gltf/export/GlbWriter.h"

#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace osgGpuAnimation::assimp
{

namespace
{

using nlohmann::json;

/// The glTF nodes with morph targets below (or at) a node of Assimp's, and their numbers of targets.
using MorphedNodes = std::multimap<std::size_t, std::pair<std::size_t, std::size_t>>;

constexpr double usualTicksPerSecond = 25.0;

std::vector<float> numbersOf(const aiVectorKey& key)
{
    return {key.mValue.x, key.mValue.y, key.mValue.z};
}

std::vector<float> numbersOf(const aiQuatKey& key)
{
    aiQuaternion rotation = key.mValue;
    rotation.Normalize();
    return {rotation.x, rotation.y, rotation.z, rotation.w};
}

/// The node of a channel. Assimp's reader of FBX appends "*" and the number of the geometry to the node's name.
std::string morphedNode(const aiMeshMorphAnim& channel)
{
    const std::string name = channel.mName.C_Str();
    return name.substr(0, name.rfind('*'));
}

class AnimationWriter
{
public:
    AnimationWriter(const aiAnimation& animation, gltf::GlbWriter& writer) : _animation(animation), _writer(writer)
    {
        _secondsATick = 1.0 / (animation.mTicksPerSecond > 0.0 ? animation.mTicksPerSecond : usualTicksPerSecond);
        const auto startWith = [this](const auto* keys, unsigned int count)
        {
            if (count > 0 && std::isfinite(keys[0].mTime)) _start = std::min(_start, keys[0].mTime);
        };
        for (unsigned int i = 0; i < animation.mNumChannels; ++i)
        {
            const aiNodeAnim& channel = *animation.mChannels[i];
            startWith(channel.mPositionKeys, channel.mNumPositionKeys);
            startWith(channel.mRotationKeys, channel.mNumRotationKeys);
            startWith(channel.mScalingKeys, channel.mNumScalingKeys);
        }
        for (unsigned int i = 0; i < animation.mNumMorphMeshChannels; ++i)
            startWith(animation.mMorphMeshChannels[i]->mKeys, animation.mMorphMeshChannels[i]->mNumKeys);
    }

    /// Null: nothing moves.
    json written(const NodeNumbers& nodes, const MorphedNodes& morphed)
    {
        for (unsigned int i = 0; i < _animation.mNumChannels; ++i)
            if (const auto node = nodes.find(_animation.mChannels[i]->mNodeName.C_Str()); node != nodes.end())
                addNode(*_animation.mChannels[i], node->second);
        for (unsigned int i = 0; i < _animation.mNumMorphMeshChannels; ++i)
            addWeights(*_animation.mMorphMeshChannels[i], nodes, morphed);
        if (_channels.empty()) return {};
        return {{"name", _animation.mName.C_Str()}, {"channels", _channels}, {"samplers", _samplers}};
    }

private:
    /// numbers: of a key, all of one length.
    template <class Key, class Numbers>
    void add(const Key* keys, std::size_t count, const Numbers& numbers, std::size_t node, const char* path,
             const char* type)
    {
        std::vector<float> times, values;
        for (std::size_t i = 0; i < count; ++i)
        {
            const double seconds = (keys[i].mTime - _start) * _secondsATick;
            const std::vector<float> key = numbers(keys[i]);
            if (!std::isfinite(static_cast<float>(seconds)) ||
                !std::all_of(key.begin(), key.end(), [](float number) { return std::isfinite(number); }))
                continue;
            auto time = static_cast<float>(seconds);
            if (!times.empty() && time < times.back()) continue;
            if (!times.empty() && time == times.back())
                time = std::nextafter(time, std::numeric_limits<float>::infinity());
            times.push_back(time);
            values.insert(values.end(), key.begin(), key.end());
        }
        if (times.empty()) return;
        const std::size_t sampler =
            gltf::append(_samplers, {{"input", _writer.addFloats(times, "SCALAR", gltf::GlbWriter::Use::Times)},
                                     {"output", _writer.addFloats(values, type, gltf::GlbWriter::Use::Values)}});
        gltf::append(_channels, {{"sampler", sampler}, {"target", {{"node", node}, {"path", path}}}});
    }

    void addNode(const aiNodeAnim& channel, std::size_t node)
    {
        const auto numbers = [](const auto& key) { return numbersOf(key); };
        add(channel.mPositionKeys, channel.mNumPositionKeys, numbers, node, "translation", "VEC3");
        add(channel.mRotationKeys, channel.mNumRotationKeys, numbers, node, "rotation", "VEC4");
        add(channel.mScalingKeys, channel.mNumScalingKeys, numbers, node, "scale", "VEC3");
    }

    void addWeights(const aiMeshMorphAnim& channel, const NodeNumbers& nodes, const MorphedNodes& morphed)
    {
        const auto node = nodes.find(morphedNode(channel));
        if (node == nodes.end()) return;
        const auto [first, last] = morphed.equal_range(node->second);
        for (auto each = first; each != last; ++each)
        {
            const auto [drawn, targets] = each->second;
            const auto numbers = [count = targets](const aiMeshMorphKey& key)
            {
                std::vector<float> weights(count);
                for (unsigned int i = 0; i < key.mNumValuesAndWeights; ++i)
                    if (key.mValues[i] < count) weights[key.mValues[i]] = static_cast<float>(key.mWeights[i]);
                return weights;
            };
            add(channel.mKeys, channel.mNumKeys, numbers, drawn, "weights", "SCALAR");
        }
    }

    const aiAnimation& _animation;
    gltf::GlbWriter& _writer;
    double _secondsATick;
    double _start = 0.0; ///< ticks; below 0 where keys are
    json _channels = json::array();
    json _samplers = json::array();
};

/// Writes all animations, with linear keys. Times become seconds, from 0 on; without ticks per second, 25 are assumed.
/// Keys that are not finite or go back in time are left out; of two keys at one time, the second follows at the next
/// float.
void writeAnimations(const aiScene& scene, const NodeNumbers& nodes, const MorphedNodes& morphed,
                     gltf::GlbWriter& writer, gltf::Report& report)
{
    for (unsigned int i = 0; i < scene.mNumAnimations; ++i)
    {
        json made = AnimationWriter(*scene.mAnimations[i], writer).written(nodes, morphed);
        if (made.is_null())
            report.note(gltf::namedElement("animations", i, scene.mAnimations[i]->mName.C_Str()) +
                        " moves no node of the scene; left out");
        else
            gltf::append(writer.document["animations"], std::move(made));
    }
}

/// Turns the scene's axes to glTF's: +Y up, +Z forward. Identity where the metadata says nothing else, and where the
/// root is turned already, as by Assimp from 5.4 on.
aiMatrix4x4 axesToYUp(const aiScene& scene)
{
    const char* const keys[3][2] = {
        {"CoordAxis", "CoordAxisSign"}, {"UpAxis", "UpAxisSign"}, {"FrontAxis", "FrontAxisSign"}};
    aiMatrix4x4 turn(aiVector3D(0.0f), aiQuaternion(), aiVector3D());
    for (unsigned int row = 0; row < 3; ++row)
    {
        int axis = 0, sign = 0;
        if (!scene.mMetaData || !scene.mMetaData->Get(keys[row][0], axis) ||
            !scene.mMetaData->Get(keys[row][1], sign) || axis < 0 || axis > 2)
            return {};
        turn[row][axis] = sign < 0 ? -1.0f : 1.0f;
    }
    const bool isTurned = scene.mRootNode->mTransformation.Equal(turn);
    return std::abs(turn.Determinant()) == 1.0f && !isTurned ? turn : aiMatrix4x4();
}

class SceneWriter
{
public:
    SceneWriter(const aiScene& scene, gltf::Report& report) : _scene(scene), _report(report)
    {
        for (unsigned int i = 0; i < scene.mNumAnimations; ++i)
        {
            const aiAnimation& animation = *scene.mAnimations[i];
            for (unsigned int channel = 0; channel < animation.mNumChannels; ++channel)
                _animated.insert(animation.mChannels[channel]->mNodeName.C_Str());
            for (unsigned int channel = 0; channel < animation.mNumMorphMeshChannels; ++channel)
                _animated.insert(morphedNode(*animation.mMorphMeshChannels[channel]));
        }
    }

    Result<std::string> write(const std::string& modelFile, const gltf::ImportOptions& options);

private:
    struct Node
    {
        const aiNode* node;
        std::size_t parent;
        std::size_t depth;
    };

    std::optional<Error> addNodes(std::size_t maxDepth);
    void addMeshes(std::size_t number, MeshWriter& meshes);
    json transformOf(const aiNode& node);

    const aiScene& _scene;
    gltf::Report& _report;
    gltf::GlbWriter _writer;
    std::vector<Node> _nodes;
    NodeNumbers _numbers;
    std::set<std::string> _animated; ///< names of nodes with channels, which need translation, rotation and scale
    MorphedNodes _morphed;
};

Result<std::string> SceneWriter::write(const std::string& modelFile, const gltf::ImportOptions& options)
{
    const auto isTooLarge = [&] { return _writer.size() > options.maxDecodedBytes; };
    const Error tooLarge{"the scene has more than " + std::to_string(options.maxDecodedBytes) +
                         " bytes of vertices and keys"};
    if (const std::optional<Error> fault = addNodes(options.maxNodeDepth)) return *fault;
    MeshWriter meshes(_numbers, _writer, _report);
    for (std::size_t number = 0; number < _nodes.size(); ++number)
    {
        addMeshes(number, meshes);
        if (isTooLarge()) return tooLarge;
    }
    writeAnimations(_scene, _numbers, _morphed, _writer, _report);
    writeMaterials(_scene, modelFile, _writer, _report);
    if (isTooLarge()) return tooLarge;

    std::size_t root = 0;
    if (const aiMatrix4x4 turn = axesToYUp(_scene); turn != aiMatrix4x4())
        root = gltf::append(_writer.document["nodes"],
                            {{"name", "axes"}, {"matrix", columnMajor(turn)}, {"children", json::array({0})}});
    _writer.document["scenes"] = json::array({json::object({{"nodes", json::array({root})}})});
    _writer.document["scene"] = 0;
    return _writer.glb(_report);
}

std::optional<Error> SceneWriter::addNodes(std::size_t maxDepth)
{
    json& nodes = _writer.document["nodes"] = json::array();
    std::vector<Node> open{{_scene.mRootNode, 0, 1}};
    std::set<std::string> ambiguous;
    while (!open.empty())
    {
        const Node next = open.back();
        open.pop_back();
        if (next.depth > maxDepth) return Error{"the hierarchy of nodes is deeper than " + std::to_string(maxDepth)};
        const std::size_t number = gltf::append(nodes, {{"name", marksOf(*next.node).name}});
        if (number > 0) nodes[next.parent]["children"].push_back(number);
        _nodes.push_back(next);
        const std::string name = next.node->mName.C_Str();
        if (!_numbers.emplace(name, number).second && _animated.erase(name) > 0) ambiguous.insert(name);
        for (unsigned int i = next.node->mNumChildren; i > 0; --i)
            open.push_back({next.node->mChildren[i - 1], number, next.depth + 1});
    }
    for (const std::string& name : ambiguous)
        _report.warn(
            "node " + gltf::quoted(name) +
            ": several have the name, and animations name it; the first one moves. Give them names of their own");
    _animated.insert(ambiguous.begin(), ambiguous.end());
    for (std::size_t number = 0; number < _nodes.size(); ++number)
    {
        nodes[number].update(transformOf(*_nodes[number].node));
        if (!marksOf(*_nodes[number].node).isHidden) continue;
        nodes[number]["extensions"]["KHR_node_visibility"]["visible"] = false;
        _writer.useExtension("KHR_node_visibility");
    }
    return std::nullopt;
}

json SceneWriter::transformOf(const aiNode& node)
{
    const aiMatrix4x4& matrix = node.mTransformation;
    const std::array<float, 16> numbers = columnMajor(matrix);
    if (!std::all_of(numbers.begin(), numbers.end(), [](float number) { return std::isfinite(number); }))
    {
        _report.warn("node " + gltf::quoted(marksOf(node).name) + ": its matrix is not finite; taken as identity");
        return json::object();
    }
    if (matrix == aiMatrix4x4()) return json::object(); // IsIdentity() would take 1 cm as nothing
    if (_animated.count(node.mName.C_Str()) == 0) return {{"matrix", numbers}};
    aiVector3D scale, translation;
    aiQuaternion rotation;
    matrix.Decompose(scale, rotation, translation);
    rotation.Normalize();
    return {{"translation", {translation.x, translation.y, translation.z}},
            {"rotation", {rotation.x, rotation.y, rotation.z, rotation.w}},
            {"scale", {scale.x, scale.y, scale.z}}};
}

void SceneWriter::addMeshes(std::size_t number, MeshWriter& meshes)
{
    const aiNode& node = *_nodes[number].node;
    std::vector<std::vector<const aiMesh*>> groups(1); // first the meshes that become primitives of one
    for (unsigned int i = 0; i < node.mNumMeshes; ++i)
    {
        const aiMesh* const mesh = _scene.mMeshes[node.mMeshes[i]];
        if (standsAlone(*mesh))
            groups.push_back({mesh});
        else
            groups.front().push_back(mesh);
    }
    for (const std::vector<const aiMesh*>& group : groups)
    {
        if (group.empty()) continue;
        const std::optional<WrittenMesh> written = meshes.write(group, number);
        if (!written) continue;
        json& nodes = _writer.document["nodes"];
        std::size_t drawn = number;
        if (nodes[number].contains("mesh"))
        {
            drawn = gltf::append(nodes, {{"name", marksOf(node).name}});
            nodes[number]["children"].push_back(drawn);
        }
        json& made = nodes[drawn];
        made["mesh"] = written->mesh;
        if (written->skin) made["skin"] = *written->skin;
        if (group.front()->mNumAnimMeshes > 0)
            _morphed.emplace(number, std::pair(drawn, group.front()->mNumAnimMeshes));
    }
}

} // namespace

Result<std::string> glbOf(const aiScene& scene, const std::string& modelFile, const gltf::ImportOptions& options,
                          gltf::Report& report)
{
    if (!scene.mRootNode) return Error{"the file has no nodes"};
    return SceneWriter(scene, report).write(modelFile, options);
}

} // namespace osgGpuAnimation::assimp
