// SPDX-License-Identifier: MIT
#include "assimp/FbxConversion.h"

#include <osgGpuAnimation/authoring/keyframes/SampledTrack.h>

#include <glm/ext/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace osgGpuAnimation::assimp
{

namespace
{

constexpr double rotationTolerance = 1e-3, relativeTolerance = 1e-4;

aiMatrix4x4 toAssimp(const glm::dmat4& matrix)
{
    aiMatrix4x4 made;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            made[static_cast<unsigned int>(row)][column] = static_cast<float>(matrix[column][row]);
    return made;
}

glm::dmat4 matrixOf(const fbx::Placement& placement)
{
    return glm::translate(glm::dmat4(1.0), placement.translation) * glm::mat4_cast(placement.rotation) *
           glm::scale(glm::dmat4(1.0), placement.scale);
}

aiVector3D toAssimp(const glm::dvec3& vector)
{
    return {static_cast<float>(vector.x), static_cast<float>(vector.y), static_cast<float>(vector.z)};
}

bool isOne(const glm::dvec3& scale)
{
    constexpr double same = 1e-6;
    return glm::length(scale - glm::dvec3(1.0)) < same;
}

glm::dvec3 inverseScale(const glm::dvec3& scale)
{
    glm::dvec3 inverse(1.0);
    for (int axis = 0; axis < 3; ++axis)
        if (scale[axis] != 0.0) inverse[axis] = 1.0 / scale[axis];
    return inverse;
}

template <class T>
T** newArray(const std::vector<T*>& elements, unsigned int& count)
{
    count = static_cast<unsigned int>(elements.size());
    T** const array = elements.empty() ? nullptr : new T*[elements.size()];
    std::copy(elements.begin(), elements.end(), array);
    return array;
}

const fbx::ModelTracks* tracksOf(const fbx::Take& take, int model)
{
    const auto found = take.models.find(static_cast<std::size_t>(model)); // -1 becomes huge
    return found == take.models.end() ? nullptr : &found->second;
}

/// Keys of the take from time 0 on. times: where the function bends or jumps, in any order; only those within the take
/// count. distance(a, b) is compared with the tolerance, which is relative to the largest magnitude at these times.
template <class Function, class Between, class Distance, class Magnitude>
auto keysOf(const fbx::Take& take, std::vector<double> times, const Function& function, const Between& between,
            const Distance& distance, double tolerance, const Magnitude& magnitude)
{
    times.insert(times.end(), {take.begin, take.end});
    std::sort(times.begin(), times.end()); // curves of one track share many
    times.erase(std::unique(times.begin(), times.end()), times.end());
    times.erase(std::upper_bound(times.begin(), times.end(), take.end), times.end());
    times.erase(times.begin(), std::lower_bound(times.begin(), times.end(), take.begin));
    double size = 0.0;
    for (const double time : times)
        size = std::max(size, static_cast<double>(magnitude(function(time, false))));
    const auto inTake = [&](double time, bool before)
    { return function(time, before || (time >= take.end && time > take.begin)); };
    const auto deviation = [&](const auto& a, const auto& b)
    {
        const double apart = distance(a, b);
        return apart > 0.0 ? apart / (tolerance * size) : 0.0;
    };
    auto keys = sampledTrack(times, inTake, between, deviation, 1.0);
    for (auto& key : keys)
        key.first -= take.begin;
    return keys;
}

/// How a node moves in a take: its placement, and the times where the parts of it bend or jump.
struct Motion
{
    std::function<fbx::Placement(double time, bool before)> at;
    std::vector<double> translationTimes{}, rotationTimes{}, scaleTimes{};
};

aiNodeAnim* transforms(const std::string& node, const fbx::Take& take, const Motion& motion)
{
    const auto vectorKeys = [&](const std::vector<double>& times, glm::dvec3 fbx::Placement::*part, unsigned int& count)
    {
        const auto keys = keysOf(
            take, times, [&](double time, bool before) { return motion.at(time, before).*part; },
            [](const glm::dvec3& a, const glm::dvec3& b, double share) { return glm::mix(a, b, share); },
            [](const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b); }, relativeTolerance,
            [](const glm::dvec3& vector) { return glm::length(vector); });
        count = static_cast<unsigned int>(keys.size());
        aiVectorKey* const array = new aiVectorKey[keys.size()];
        for (std::size_t i = 0; i < keys.size(); ++i)
            array[i] = aiVectorKey(keys[i].first, toAssimp(keys[i].second));
        return array;
    };
    const auto angle = [](const glm::dquat& a, const glm::dquat& b)
    {
        const glm::dquat difference = glm::conjugate(a) * b; // the acos of the product is inexact near 1
        return 2.0 * std::asin(std::min(1.0, glm::length(glm::dvec3(difference.x, difference.y, difference.z))));
    };
    const auto rotations = keysOf(
        take, motion.rotationTimes, [&](double time, bool before) { return motion.at(time, before).rotation; },
        [](const glm::dquat& a, const glm::dquat& b, double share) { return glm::slerp(a, b, share); }, angle,
        rotationTolerance, [](const glm::dquat&) { return 1.0; });
    aiNodeAnim* const made = new aiNodeAnim;
    made->mNodeName = node;
    made->mPositionKeys = vectorKeys(motion.translationTimes, &fbx::Placement::translation, made->mNumPositionKeys);
    made->mScalingKeys = vectorKeys(motion.scaleTimes, &fbx::Placement::scale, made->mNumScalingKeys);
    made->mNumRotationKeys = static_cast<unsigned int>(rotations.size());
    made->mRotationKeys = new aiQuatKey[rotations.size()];
    for (std::size_t i = 0; i < rotations.size(); ++i)
    {
        const glm::dquat& each = rotations[i].second;
        made->mRotationKeys[i] =
            aiQuatKey(rotations[i].first, aiQuaternion(static_cast<float>(each.w), static_cast<float>(each.x),
                                                       static_cast<float>(each.y), static_cast<float>(each.z)));
    }
    return made;
}

class FbxCompletion
{
public:
    FbxCompletion(aiScene& scene, const fbx::Scene& fbx, gltf::Report& report)
        : _scene(scene), _fbx(fbx), _report(report), _metres(fbx.metresPerUnit)
    {
        for (std::size_t model = 0; model < fbx.models.size(); ++model)
            _models.emplace(fbx.models[model].uniqueName, model);
    }

    void complete()
    {
        for (const std::string& warning : _fbx.warnings)
            _report.warn(warning);
        findCompensated();
        placeNodes();
        writeTakes();
    }

private:
    glm::dmat4 inMetres(glm::dmat4 matrix) const
    {
        matrix[3] *= glm::dvec4(_metres, _metres, _metres, 1.0);
        return matrix;
    }

    void findCompensated();
    void placeNodes();
    void place(aiNode& node, const fbx::Model& model, bool isBelowHidden);
    void moveMeshes(aiNode& node, const fbx::Model& model);
    void setBones(aiMesh& mesh, const fbx::Model& model, const glm::dmat4& geometric) const;
    void setShapes(aiMesh& mesh, const fbx::Model& model);

    void writeTakes();
    void addModel(const fbx::Take& take, std::size_t model, std::vector<aiNodeAnim*>& channels) const;
    aiMeshMorphAnim* weights(const fbx::Take& take, std::size_t model) const;

    aiScene& _scene;
    const fbx::Scene& _fbx;
    gltf::Report& _report;
    double _metres; ///< a unit of the file
    std::map<std::string, std::size_t> _models;
    std::set<std::size_t> _compensated;          ///< models with a node of the parent's inverse scale above
    std::map<std::size_t, std::string> _morphed; ///< the nodes of the meshes with shapes, by model
    std::set<const aiMesh*> _completed;
};

std::string compensationName(const fbx::Model& model)
{
    return model.uniqueName + "_ScaleCompensation";
}

/// A model with Segment Scale Compensate needs another node where the scale of its parent is not always 1.
void FbxCompletion::findCompensated()
{
    for (std::size_t number = 0; number < _fbx.models.size(); ++number)
    {
        const fbx::Model& model = _fbx.models[number];
        if (!model.compensatesScale || model.parent < 0) continue;
        bool isScaled = !isOne(_fbx.models[static_cast<std::size_t>(model.parent)].scale);
        for (const fbx::Take& take : _fbx.takes)
            if (const fbx::ModelTracks* const tracks = tracksOf(take, model.parent))
            {
                std::vector<double> times{take.begin};
                tracks->scale.appendTimes(times);
                for (const double time : times)
                    isScaled = isScaled || !isOne(tracks->scale.at(time));
            }
        if (isScaled) _compensated.insert(number);
    }
}

void FbxCompletion::placeNodes()
{
    struct Open
    {
        aiNode* node;
        bool isBelowHidden;
    };
    std::vector<Open> open{{_scene.mRootNode, false}};
    while (!open.empty())
    {
        const Open next = open.back();
        open.pop_back();
        const std::vector<aiNode*> children(next.node->mChildren, next.node->mChildren + next.node->mNumChildren);
        const auto found = _models.find(next.node->mName.C_Str());
        const bool isModel = found != _models.end() && next.node != _scene.mRootNode;
        const bool isHidden = isModel && _fbx.models[found->second].isHidden;
        if (isModel) place(*next.node, _fbx.models[found->second], next.isBelowHidden);
        if (!isModel && next.node != _scene.mRootNode)
            _report.warn("node " + gltf::quoted(std::string(next.node->mName.C_Str())) +
                         ": Assimp gives it a name that is not in the file; pivots and takes do not reach it");
        for (aiNode* const child : children)
            open.push_back({child, next.isBelowHidden || isHidden});
    }
}

void FbxCompletion::place(aiNode& node, const fbx::Model& model, bool isBelowHidden)
{
    fbx::Placement rest = model.rest();
    rest.translation *= _metres;
    mark(node, {model.name, model.isHidden && !isBelowHidden});
    moveMeshes(node, model);
    if (_compensated.count(_models.at(model.uniqueName)) > 0)
    {
        aiNode* const above = new aiNode(compensationName(model));
        mark(*above, {model.name + "_ScaleCompensation", false});
        fbx::Placement compensation;
        compensation.translation = rest.translation;
        compensation.scale = inverseScale(_fbx.models[static_cast<std::size_t>(model.parent)].scale);
        above->mTransformation = toAssimp(matrixOf(compensation));
        aiNode& parent = *node.mParent;
        aiNode* below = &node;
        std::replace(parent.mChildren, parent.mChildren + parent.mNumChildren, below, above);
        above->mParent = &parent;
        above->addChildren(1, &below);
        rest.translation = glm::dvec3(0.0);
    }
    node.mTransformation = toAssimp(matrixOf(rest));
}

void FbxCompletion::moveMeshes(aiNode& node, const fbx::Model& model)
{
    const glm::dmat4 geometric = inMetres(model.geometric);
    const bool isMoved = geometric != glm::dmat4(1.0);
    bool hasBones = false;
    for (unsigned int i = 0; i < node.mNumMeshes; ++i)
    {
        aiMesh& mesh = *_scene.mMeshes[node.mMeshes[i]];
        hasBones = hasBones || mesh.mNumBones > 0;
        if (!_completed.insert(&mesh).second) continue;
        setShapes(mesh, model);
        setBones(mesh, model, geometric);
    }
    aiNode* drawn = &node;
    if (isMoved && node.mNumMeshes > 0 && !hasBones)
    {
        drawn = new aiNode(model.uniqueName + "_Geometry");
        mark(*drawn, {model.name, false});
        drawn->mTransformation = toAssimp(geometric);
        std::swap(drawn->mMeshes, node.mMeshes);
        std::swap(drawn->mNumMeshes, node.mNumMeshes);
        node.addChildren(1, &drawn);
    }
    if (!model.shapes.empty()) _morphed[_models.at(model.uniqueName)] = drawn->mName.C_Str();
}

/// Assimp 5.4 has other offset matrices than 5.2 and 6.0.
void FbxCompletion::setBones(aiMesh& mesh, const fbx::Model& model, const glm::dmat4& geometric) const
{
    for (unsigned int i = 0; i < mesh.mNumBones; ++i)
        for (const fbx::Binding& binding : model.bindings)
        {
            if (mesh.mBones[i]->mName != aiString(_fbx.models[binding.bone].uniqueName)) continue;
            mesh.mBones[i]->mOffsetMatrix = toAssimp(inMetres(binding.meshToBone) * geometric);
            break;
        }
}

/// Assimp's names are those of the channels, from 5.4 on with a point and the name of the target, and then in no order.
/// A channel with several targets comes once for each.
void FbxCompletion::setShapes(aiMesh& mesh, const fbx::Model& model)
{
    std::map<std::size_t, std::size_t> seen;
    for (unsigned int i = 0; i < mesh.mNumAnimMeshes && i < model.shapes.size(); ++i)
    {
        const fbx::ShapeChannel& channel = _fbx.channels[model.shapes[i]];
        const std::size_t target = seen[model.shapes[i]]++;
        aiAnimMesh** const end = mesh.mAnimMeshes + mesh.mNumAnimMeshes;
        for (const std::string& name : {channel.uniqueName + '.' + channel.targetNames[target], channel.uniqueName})
        {
            const auto isNamed = [&](const aiAnimMesh* each) { return each->mName == aiString(name); };
            aiAnimMesh** const own = std::find_if(mesh.mAnimMeshes + i, end, isNamed);
            if (own == end) continue;
            std::rotate(mesh.mAnimMeshes + i, own, own + 1);
            break;
        }
        mesh.mAnimMeshes[i]->mWeight = static_cast<float>(channel.weight(target, channel.percent));
        mesh.mAnimMeshes[i]->mName = channel.name;
    }
    if (mesh.mNumAnimMeshes != model.shapes.size())
        _report.warn("node " + gltf::quoted(model.name) + ": expected " + std::to_string(model.shapes.size()) +
                     " shapes, found " + std::to_string(mesh.mNumAnimMeshes) +
                     " in its mesh; their weights may be wrong");
}

void FbxCompletion::writeTakes()
{
    std::vector<aiAnimation*> animations;
    for (const fbx::Take& take : _fbx.takes)
    {
        std::vector<aiNodeAnim*> channels;
        std::vector<aiMeshMorphAnim*> morphs;
        for (std::size_t model = 0; model < _fbx.models.size(); ++model)
            addModel(take, model, channels);
        for (const auto& [model, node] : _morphed)
            if (aiMeshMorphAnim* const made = weights(take, model)) morphs.push_back(made);
        aiAnimation* const animation = new aiAnimation;
        animation->mName = take.name;
        animation->mTicksPerSecond = 1.0;
        animation->mDuration = take.end - take.begin;
        animation->mChannels = newArray(channels, animation->mNumChannels);
        animation->mMorphMeshChannels = newArray(morphs, animation->mNumMorphMeshChannels);
        animations.push_back(animation);
    }
    _scene.mAnimations = newArray(animations, _scene.mNumAnimations);
}

void FbxCompletion::addModel(const fbx::Take& take, std::size_t number, std::vector<aiNodeAnim*>& channels) const
{
    const fbx::Model& model = _fbx.models[number];
    const fbx::ModelTracks* const tracks = tracksOf(take, static_cast<int>(number));
    const auto placement = [&](double time, bool before)
    {
        fbx::Placement made = model.rest();
        if (tracks)
            made = model.placement(tracks->translation.at(time, before), tracks->rotation.at(time, before),
                                   tracks->scale.at(time, before));
        made.translation *= _metres;
        return made;
    };
    Motion motion{placement};
    if (tracks)
    {
        tracks->translation.appendTimes(motion.translationTimes);
        tracks->rotation.appendTimes(motion.rotationTimes);
        tracks->scale.appendTimes(motion.scaleTimes);
        for (const fbx::AnimatedVector* const other : {&tracks->rotation, &tracks->scale})
            if (model.hasPivots()) other->appendTimes(motion.translationTimes);
    }
    const fbx::ModelTracks* const parentTracks = tracksOf(take, model.parent);
    if (_compensated.count(number) > 0 && (tracks || parentTracks))
    {
        const auto compensation = [&](double time, bool before)
        {
            fbx::Placement made;
            made.translation = placement(time, before).translation;
            made.scale = inverseScale(parentTracks ? parentTracks->scale.at(time, before)
                                                   : _fbx.models[static_cast<std::size_t>(model.parent)].scale);
            return made;
        };
        Motion above{compensation, std::move(motion.translationTimes)};
        if (parentTracks) parentTracks->scale.appendTimes(above.scaleTimes);
        channels.push_back(transforms(compensationName(model), take, above));
        motion.translationTimes.clear();
        motion.at = [&](double time, bool before)
        {
            fbx::Placement made = placement(time, before);
            made.translation = glm::dvec3(0.0); // the node above has it
            return made;
        };
    }
    if (tracks) channels.push_back(transforms(model.uniqueName, take, motion));
}

aiMeshMorphAnim* FbxCompletion::weights(const fbx::Take& take, std::size_t number) const
{
    const fbx::Model& model = _fbx.models[number];
    std::map<std::size_t, const fbx::Curve*> curves;
    std::vector<double> times;
    for (const fbx::ShapeTrack& track : take.shapes)
        if (std::count(model.shapes.begin(), model.shapes.end(), track.channel) > 0)
        {
            curves[track.channel] = &track.percent;
            track.percent.appendTimes(times);
        }
    if (curves.empty()) return nullptr;
    const auto weightsAt = [&](double time, bool before)
    {
        std::vector<double> values;
        std::map<std::size_t, std::size_t> seen;
        for (const std::size_t channel : model.shapes)
        {
            const fbx::ShapeChannel& shape = _fbx.channels[channel];
            const auto curve = curves.find(channel);
            values.push_back(
                shape.weight(seen[channel]++, curve == curves.end() ? shape.percent : curve->second->at(time, before)));
        }
        return values;
    };
    const auto max = [](const std::vector<double>& values)
    { return largestDifference(values, std::vector<double>(values.size())); };
    const auto keys = keysOf(take, std::move(times), weightsAt, mixedNumbers<double>, largestDifference<double>,
                             relativeTolerance, max);
    aiMeshMorphAnim* const made = new aiMeshMorphAnim;
    made->mName = _morphed.at(number) + "*0";
    made->mNumKeys = static_cast<unsigned int>(keys.size());
    made->mKeys = new aiMeshMorphKey[keys.size()];
    for (std::size_t i = 0; i < keys.size(); ++i)
    {
        aiMeshMorphKey& key = made->mKeys[i];
        key.mTime = keys[i].first;
        key.mNumValuesAndWeights = static_cast<unsigned int>(keys[i].second.size());
        key.mValues = new unsigned int[keys[i].second.size()];
        key.mWeights = new double[keys[i].second.size()];
        for (unsigned int target = 0; target < key.mNumValuesAndWeights; ++target)
        {
            key.mValues[target] = target;
            key.mWeights[target] = keys[i].second[target];
        }
    }
    return made;
}

} // namespace

void completeFbx(aiScene& scene, const fbx::Scene& fbx, gltf::Report& report)
{
    if (scene.mRootNode) FbxCompletion(scene, fbx, report).complete();
}

} // namespace osgGpuAnimation::assimp
