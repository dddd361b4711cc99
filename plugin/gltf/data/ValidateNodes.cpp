// SPDX-License-Identifier: MIT
#include "gltf/data/Validation.h"
#include "gltf/file/Elements.h"

#include "gltf/data/Accessor.h"
#include "gltf/data/AnimationPointers.h"
#include "gltf/document/AttributeSemantic.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

using Model = tinygltf::Model;

struct NodeForest
{
    std::vector<int> parents; ///< one per node, -1 for a root
    std::vector<int> roots;   ///< one per node: the root of its tree
};

std::optional<Error> findParents(const Model& model, std::vector<int>& parents)
{
    for (std::size_t node = 0; node < model.nodes.size(); ++node)
    {
        const std::vector<int>& children = model.nodes[node].children;
        for (std::size_t c = 0; c < children.size(); ++c)
        {
            int& parent = elementOf(parents, children[c]);
            if (parent >= 0)
                return fault(elementName("nodes", node, "children", c), "a node without another parent",
                             elementName("nodes", children[c]) + ", a child of " + elementName("nodes", parent));
            parent = static_cast<int>(node);
        }
    }
    return std::nullopt;
}

/// Walks the trees level by level from their roots. A node that is not reached is part of a cycle.
std::optional<Error> findRoots(const Model& model, const std::vector<int>& parents, std::size_t maxDepth,
                               std::vector<int>& roots)
{
    std::vector<int> level, next;
    for (std::size_t node = 0; node < parents.size(); ++node)
        if (parents[node] < 0)
        {
            roots[node] = static_cast<int>(node);
            level.push_back(static_cast<int>(node));
        }
    for (std::size_t depth = 1; !level.empty(); ++depth, level.swap(next), next.clear())
    {
        if (depth > maxDepth)
            return fault(elementName("nodes", level.front()),
                         "a depth of at most " + std::to_string(maxDepth) + " nodes (limit maxNodeDepth)", "more");
        for (int node : level)
            for (int child : elementOf(model.nodes, node).children)
            {
                elementOf(roots, child) = elementOf(roots, node);
                next.push_back(child);
            }
    }
    const auto unreached = std::find(roots.begin(), roots.end(), -1);
    if (unreached == roots.end()) return std::nullopt;
    return fault(elementName("nodes", unreached - roots.begin()), "a tree of nodes", "a cycle of parents and children");
}

std::optional<Error> validateScenes(const Model& model, const NodeForest& forest)
{
    const std::size_t none = std::size_t(-1);
    std::vector<std::size_t> sceneOfNode(model.nodes.size(), none); // the last scene that names the node
    for (std::size_t s = 0; s < model.scenes.size(); ++s)
        for (std::size_t i = 0; i < model.scenes[s].nodes.size(); ++i)
        {
            const std::size_t node = static_cast<std::size_t>(model.scenes[s].nodes[i]);
            const std::string name = elementName("scenes", s, "nodes", i);
            if (forest.parents[node] >= 0)
                return fault(name, "a root node",
                             elementName("nodes", node) + ", a child of " + elementName("nodes", forest.parents[node]));
            if (sceneOfNode[node] == s) return fault(name, "each node once", elementName("nodes", node) + " again");
            sceneOfNode[node] = s;
        }
    return std::nullopt;
}

std::optional<Error> validateJoints(const Model& model, std::vector<std::size_t>& skinOfNode, std::size_t s)
{
    const std::vector<int>& joints = model.skins[s].joints;
    for (std::size_t j = 0; j < joints.size(); ++j)
    {
        std::size_t& last = elementOf(skinOfNode, joints[j]);
        if (last == s)
            return fault(elementName("skins", s, "joints", j), "each node once",
                         elementName("nodes", joints[j]) + " again");
        last = s;
    }
    return std::nullopt;
}

std::optional<Error> validateInverseBinds(const Model& model, std::size_t s)
{
    const tinygltf::Skin& skin = model.skins[s];
    if (skin.inverseBindMatrices < 0) return std::nullopt;
    const tinygltf::Accessor& accessor = elementOf(model.accessors, skin.inverseBindMatrices);
    const std::string name = elementName("skins", s) + ".inverseBindMatrices";
    const std::string accessorName = elementName("accessors", skin.inverseBindMatrices);
    if (accessor.type != TINYGLTF_TYPE_MAT4 || accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT)
        return fault(name, "matrices of type MAT4 of floats", accessorName + ", which has others");
    if (accessor.count < skin.joints.size())
        return fault(name, std::to_string(skin.joints.size()) + " matrices (one a joint)",
                     std::to_string(accessor.count) + " in " + accessorName);
    return std::nullopt;
}

void warnOfLastRows(const Model& model, std::size_t s, Report& report)
{
    const std::vector<float> matrices = readFloats(model, model.skins[s].inverseBindMatrices);
    const float lastRow[] = {0.0f, 0.0f, 0.0f, 1.0f};
    for (std::size_t i = 0; i < matrices.size(); i += 16)
        for (std::size_t column = 0; column < 4; ++column)
            if (std::abs(matrices[i + column * 4 + 3] - lastRow[column]) > 1e-6f)
                return report.warn(elementName("skins", s) + ".inverseBindMatrices: the last row of matrix " +
                                   std::to_string(i / 16) + " is not 0 0 0 1; taken as such");
}

/// One flag a root node: the scene to show holds its tree. All are shown if there is no scene.
std::vector<bool> shownRoots(const Model& model)
{
    std::vector<bool> shown(model.nodes.size(), model.scenes.empty());
    if (model.scenes.empty()) return shown;
    for (int node : elementOf(model.scenes, std::max(model.defaultScene, 0)).nodes)
        elementOf(shown, node) = true;
    return shown;
}

void warnOfPlaces(const Model& model, const NodeForest& forest, Report& report)
{
    const std::vector<bool> shown = shownRoots(model);
    std::vector<bool> allShown(model.skins.size());
    for (std::size_t s = 0; s < model.skins.size(); ++s)
    {
        const std::vector<int>& joints = model.skins[s].joints;
        const auto root = [&](int joint) { return elementOf(forest.roots, joint); };
        allShown[s] =
            std::all_of(joints.begin(), joints.end(), [&](int joint) { return elementOf(shown, root(joint)); });
        if (std::any_of(joints.begin(), joints.end(), [&](int joint) { return root(joint) != root(joints[0]); }))
            report.warn(elementName("skins", s) + ".joints: expected joints of one tree, found several roots");
    }
    for (std::size_t n = 0; n < model.nodes.size(); ++n)
    {
        const int skin = model.nodes[n].skin;
        if (skin >= 0 && elementOf(shown, forest.roots[n]) && !elementOf(allShown, skin))
            report.warn(elementName("nodes", n) + ".skin: expected joints in the scene of the mesh, found that " +
                        elementName("skins", skin) + " has some outside");
    }
}

std::optional<Error> validateSkins(const Model& model, const NodeForest& forest, Report& report)
{
    std::vector<std::size_t> skinOfNode(model.nodes.size(), std::size_t(-1));
    std::vector<bool> seen(model.accessors.size());
    for (std::size_t s = 0; s < model.skins.size(); ++s)
    {
        std::optional<Error> error = validateJoints(model, skinOfNode, s);
        if (!error) error = validateInverseBinds(model, s);
        if (error) return error;
        const int matrices = model.skins[s].inverseBindMatrices;
        if (matrices < 0 || elementOf(seen, matrices)) continue;
        elementOf(seen, matrices) = true;
        warnOfLastRows(model, s, report);
    }
    warnOfPlaces(model, forest, report);
    return std::nullopt;
}

bool isFloat(const tinygltf::Accessor& accessor)
{
    return accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT;
}

std::string in(int accessor)
{
    return " in " + elementName("accessors", accessor);
}

bool isCubic(const tinygltf::AnimationSampler& sampler)
{
    return std::string_view(sampler.interpolation) == "CUBICSPLINE";
}

/// Empty if an output may drive the path, else the expected format.
std::string wrongOutputFormat(const tinygltf::Accessor& output, std::string_view path)
{
    static const std::string small = " of float or normalized byte, unsigned byte, short or unsigned short";
    const bool isSmall = isFloat(output) || (output.normalized && componentBytes(output.componentType) <= 2);
    if (path == "rotation") return output.type == TINYGLTF_TYPE_VEC4 && isSmall ? "" : "VEC4" + small;
    if (path == "weights") return output.type == TINYGLTF_TYPE_SCALAR && isSmall ? "" : "SCALAR" + small;
    return output.type == TINYGLTF_TYPE_VEC3 && isFloat(output) ? "" : "VEC3 of float";
}

/// The same for a target of KHR_animation_pointer, which takes integers, too.
std::string wrongPointerOutput(const tinygltf::Accessor& output, const tinygltf::AnimationChannel& channel)
{
    static constexpr std::pair<const char*, int> types[] = {{"SCALAR", TINYGLTF_TYPE_SCALAR},
                                                            {"VEC2", TINYGLTF_TYPE_VEC2},
                                                            {"VEC3", TINYGLTF_TYPE_VEC3},
                                                            {"VEC4", TINYGLTF_TYPE_VEC4}};
    const std::string_view path = channel.target_path;
    const std::optional<PropertyPointer> property = propertyOf(channel);
    const std::size_t count = property ? property->member->count : path == "weights" ? 1 : path == "rotation" ? 4 : 3;
    if (property && property->member->isBoolean)
        return output.type == TINYGLTF_TYPE_SCALAR && output.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
                       !output.normalized
                   ? ""
                   : "SCALAR of unsigned byte";
    return output.type == types[count - 1].second ? "" : types[count - 1].first;
}

/// Checks one animation after another and remembers its findings about shared accessors.
class AnimationValidation
{
public:
    AnimationValidation(Model& model, Report& report) : _model(model), _report(report) {}

    std::optional<Error> validate(std::size_t a)
    {
        const tinygltf::Animation& animation = _model.animations[a];
        for (std::size_t s = 0; s < animation.samplers.size(); ++s)
            if (std::optional<Error> error =
                    validateInput(animation.samplers[s].input, elementName("animations", a, "samplers", s) + ".input"))
                return error;
        for (std::size_t c = 0; c < animation.channels.size(); ++c)
        {
            if (animation.channels[c].target_node < 0 && !propertyOf(animation.channels[c])) continue;
            const std::optional<Error> error = validateChannel(a, c);
            if (!error) continue;
            if (!hasPointer(animation.channels[c])) return error;
            _report.warn(error->message + "; channel ignored");
            dropTarget(_model.animations[a].channels[c]);
        }
        return std::nullopt;
    }

private:
    const tinygltf::Accessor& accessorOf(int index) const { return elementOf(_model.accessors, index); }

    std::optional<Error> validateInput(int input, const std::string& name) const
    {
        const tinygltf::Accessor& accessor = accessorOf(input);
        if (accessor.type == TINYGLTF_TYPE_SCALAR && isFloat(accessor)) return std::nullopt;
        return fault(name, "SCALAR of float", formatText(accessor) + in(input));
    }

    std::optional<Error> validateChannel(std::size_t a, std::size_t c)
    {
        const tinygltf::AnimationChannel& channel = _model.animations[a].channels[c];
        tinygltf::AnimationSampler& sampler = elementOf(_model.animations[a].samplers, channel.sampler);
        const tinygltf::Accessor& output = accessorOf(sampler.output);
        const auto samplerName = [&] { return elementName("animations", a, "samplers", channel.sampler) + ".output"; };
        const auto channelName = [&] { return elementName("animations", a, "channels", c); };

        const std::string wrong =
            hasPointer(channel) ? wrongPointerOutput(output, channel) : wrongOutputFormat(output, channel.target_path);
        if (!wrong.empty())
            return fault(samplerName(), wrong + " for " + channel.target_path, formatText(output) + in(sampler.output));
        const std::optional<PropertyPointer> property = propertyOf(channel);
        if (property && property->member->isBoolean && sampler.interpolation != "STEP")
            return fault(elementName("animations", a, "samplers", channel.sampler) + ".interpolation",
                         "STEP for " + channel.target_path, sampler.interpolation);
        const std::size_t values = valuesOfKey(channel);
        if (values == 0)
            return fault(channelName() + ".target", "a node with morph targets for weights",
                         elementName("nodes", channel.target_node) + ", which has none");
        const std::size_t perTime = values * (isCubic(sampler) ? 3 : 1);
        const std::size_t times = accessorOf(sampler.input).count;
        if (output.count / perTime != times || output.count % perTime != 0)
            return fault(samplerName(),
                         std::to_string(perTime) + " values for each of " + std::to_string(times) + " times",
                         std::to_string(output.count) + " values" + in(sampler.output));
        if (property) return std::nullopt;
        if (!elementOf(_model.nodes, channel.target_node).matrix.empty())
            _report.warn(channelName() + ".target: " + elementName("nodes", channel.target_node) +
                         " has a matrix, which no animation should change");
        if (std::string_view(channel.target_path) == "rotation") mendRotations(sampler, samplerName);
        return std::nullopt;
    }

    /// 1, or the number of morph targets for weights.
    std::size_t valuesOfKey(const tinygltf::AnimationChannel& channel) const
    {
        if (std::string_view(channel.target_path) != "weights" || weightOf(channel) >= 0) return 1;
        const int mesh = elementOf(_model.nodes, channel.target_node).mesh;
        return mesh < 0 ? 0 : elementOf(_model.meshes, mesh).primitives.front().targets.size();
    }

    /// Replaces a quaternion of length 0, which is not a rotation, by the one before it.
    template <typename Name>
    void mendRotations(tinygltf::AnimationSampler& sampler, const Name& name)
    {
        const bool cubic = isCubic(sampler);
        int& seen = _rotations.try_emplace(std::pair(sampler.output, cubic), unseen).first->second;
        if (seen != unseen)
        {
            sampler.output = seen;
            return;
        }
        seen = sampler.output;
        std::vector<float> rotations = readFloats(_model, sampler.output);
        const float* held = identity;
        bool mended = false;
        for (std::size_t i = cubic ? 4 : 0; i < rotations.size(); i += cubic ? 12 : 4)
        {
            float* const q = &rotations[i];
            const double squares = static_cast<double>(q[0]) * q[0] + static_cast<double>(q[1]) * q[1] +
                                   static_cast<double>(q[2]) * q[2] + static_cast<double>(q[3]) * q[3];
            if (squares < 1e-12)
            {
                std::copy_n(held, 4, q);
                mended = true;
            }
            held = q;
        }
        if (!mended) return;
        _report.warn(name() + ": expected unit quaternions, found one of length 0; the rotation before it is held" +
                     in(sampler.output));
        sampler.output = seen = addAccessor(_model, rotations, TINYGLTF_TYPE_VEC4);
    }

    static constexpr int unseen = -1;
    static constexpr float identity[4] = {0.0f, 0.0f, 0.0f, 1.0f};

    Model& _model;
    Report& _report;
    /// The accessor to take for a rotation output, by the file's accessor and whether it is read as CUBICSPLINE.
    std::map<std::pair<int, bool>, int> _rotations;
};

} // namespace

std::optional<Error> validateNodes(const Model& model, std::size_t maxDepth, Report& report)
{
    NodeForest forest{std::vector<int>(model.nodes.size(), -1), std::vector<int>(model.nodes.size(), -1)};
    std::optional<Error> error = findParents(model, forest.parents);
    if (!error) error = findRoots(model, forest.parents, maxDepth, forest.roots);
    if (!error) error = validateScenes(model, forest);
    if (!error) error = validateSkins(model, forest, report);
    return error;
}

std::optional<Error> validateAnimations(Model& model, Report& report)
{
    AnimationValidation validation(model, report);
    for (std::size_t a = 0; a < model.animations.size(); ++a)
        if (std::optional<Error> error = validation.validate(a)) return error;
    return std::nullopt;
}

} // namespace osgGpuAnimation::gltf
