// SPDX-License-Identifier: MIT
#include "assimp/AnimationConversion.h"

#include <assimp/scene.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace osgGpuAnimation::assimp
{

namespace
{

using nlohmann::json;

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

class AnimationWriter
{
public:
    AnimationWriter(const aiAnimation& animation, gltf::GlbWriter& writer) : _animation(animation), _writer(writer)
    {
        _secondsATick = 1.0 / (animation.mTicksPerSecond > 0.0 ? animation.mTicksPerSecond : usualTicksPerSecond);
        for (unsigned int i = 0; i < animation.mNumChannels; ++i)
        {
            const aiNodeAnim& channel = *animation.mChannels[i];
            if (channel.mNumPositionKeys > 0) startAt(channel.mPositionKeys[0].mTime);
            if (channel.mNumRotationKeys > 0) startAt(channel.mRotationKeys[0].mTime);
            if (channel.mNumScalingKeys > 0) startAt(channel.mScalingKeys[0].mTime);
        }
        for (unsigned int i = 0; i < animation.mNumMorphMeshChannels; ++i)
            if (animation.mMorphMeshChannels[i]->mNumKeys > 0) startAt(animation.mMorphMeshChannels[i]->mKeys[0].mTime);
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
    void startAt(double ticks)
    {
        if (std::isfinite(ticks)) _start = std::min(_start, ticks);
    }

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

} // namespace

std::string morphedNode(const aiMeshMorphAnim& channel)
{
    const std::string name = channel.mName.C_Str();
    return name.substr(0, name.rfind('*'));
}

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

} // namespace osgGpuAnimation::assimp
