// SPDX-License-Identifier: MIT
#include "gltf/import/Joints.h"

#include "gltf/data/Accessor.h"
#include "gltf/data/AnimationPointers.h"
#include "gltf/data/MaterialVariants.h"
#include "gltf/file/Elements.h"
#include "gltf/file/Report.h"
#include "gltf/import/NodeTransform.h"

#include <osgGpuAnimation/animation/bounds/TransformBound.h>

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <optional>

namespace osgGpuAnimation::gltf
{

namespace
{

/// Null where the node has none.
const tinygltf::Mesh* meshOf(const tinygltf::Model& model, const tinygltf::Node& node)
{
    return node.mesh < 0 ? nullptr : &elementOf(model.meshes, node.mesh);
}

/// The number of morph targets of the mesh: that of its first primitive (all have the same; section 3.7.2.2).
std::size_t morphTargetCount(const tinygltf::Mesh& mesh)
{
    return mesh.primitives.front().targets.size();
}

/// True if a primitive of the node's mesh follows the node.
bool carriesRigidMesh(const tinygltf::Node& node, const tinygltf::Mesh& mesh)
{
    return std::any_of(mesh.primitives.begin(), mesh.primitives.end(),
                       [&](const tinygltf::Primitive& p) { return !isSkinned(node, p); });
}

void mark(std::vector<bool>& flags, int node)
{
    if (node >= 0) elementOf(flags, node) = true;
}

/// movedNodes, all joints of skins, and the targets of channels. withWeights: those of weights, too.
std::vector<bool> driven(const tinygltf::Model& model, const std::vector<bool>& movedNodes, bool withWeights)
{
    std::vector<bool> nodes = movedNodes;
    nodes.resize(model.nodes.size(), false);
    for (const tinygltf::Skin& skin : model.skins)
        for (const int joint : skin.joints)
            mark(nodes, joint);
    for (const tinygltf::Animation& animation : model.animations)
        for (const tinygltf::AnimationChannel& channel : animation.channels)
            if (withWeights || channel.target_path != "weights") mark(nodes, channel.target_node);
    return nodes;
}

std::vector<bool> movingNodes(const tinygltf::Model& model, const NodeTree& tree, const std::vector<bool>& movedNodes)
{
    std::vector<bool> moves = driven(model, movedNodes, false);
    for (const int node : tree.order)
        if (const int parent = elementOf(tree.parents, node); parent >= 0 && elementOf(moves, parent))
            mark(moves, node);
    return moves;
}

/// `moves` includes everything below a moving node; of those only nodes with a mesh become joints.
std::vector<bool> jointNodes(const tinygltf::Model& model, const NodeTree& tree, const std::vector<bool>& moves,
                             const std::vector<bool>& movedNodes)
{
    std::vector<bool> joints = driven(model, movedNodes, true);
    for (std::size_t index = 0; index < joints.size(); ++index)
    {
        const tinygltf::Node& node = model.nodes[index];
        const tinygltf::Mesh* mesh = meshOf(model, node);
        if (mesh && (morphTargetCount(*mesh) > 0 || (moves[index] && carriesRigidMesh(node, *mesh))))
            joints[index] = true;
    }
    for (auto node = tree.order.rbegin(); node != tree.order.rend(); ++node)
        if (elementOf(joints, *node)) mark(joints, elementOf(tree.parents, *node));
    return joints;
}

/// True if the drawn part has a mesh that does not move.
bool hasStillMeshes(const tinygltf::Model& model, const NodeTree& tree, const std::vector<bool>& moves)
{
    for (std::size_t index = 0; index < model.nodes.size(); ++index)
    {
        const tinygltf::Node& node = model.nodes[index];
        const tinygltf::Mesh* mesh = tree.drawn[index] && !moves[index] ? meshOf(model, node) : nullptr;
        if (mesh && morphTargetCount(*mesh) == 0 && carriesRigidMesh(node, *mesh)) return true;
    }
    return false;
}

std::vector<AffineMatrix> readInverseBinds(const tinygltf::Model& model, const tinygltf::Skin& skin)
{
    std::vector<AffineMatrix> matrices(skin.joints.size());
    if (skin.inverseBindMatrices < 0) return matrices;
    const std::vector<float> numbers = readFloats(model, skin.inverseBindMatrices);
    for (std::size_t place = 0; place < matrices.size(); ++place)
        matrices[place] = AffineMatrix::fromColumns(glm::make_mat4(numbers.data() + 16 * place));
    return matrices;
}

} // namespace

int lightOf(const tinygltf::Node& node)
{
    const tinygltf::Value& extension = extensionOf(node.extensions, "KHR_lights_punctual");
    return extension.Has("light") ? extension.Get("light").GetNumberAsInt() : -1;
}

void addNodesOfProperties(const tinygltf::Model& model, const NodeTree& tree, std::vector<bool>& nodes)
{
    using Object = PropertyMember::Object;
    const std::vector<bool> materials = animatedObjects(model, Object::Material, model.materials.size());
    const std::vector<bool> lights = animatedObjects(model, Object::Light, model.lights.size());
    const std::vector<bool> cameras = animatedObjects(model, Object::Camera, model.cameras.size());
    const auto isIn = [](const std::vector<bool>& flags, int index) { return index >= 0 && elementOf(flags, index); };
    const auto isPrimitive = [&](const tinygltf::Primitive& primitive)
    {
        bool isAnimated = isIn(materials, primitive.material);
        forEachVariantMaterial(primitive, [&](int material, const tinygltf::Value&)
                               { isAnimated = isAnimated || isIn(materials, material); });
        return isAnimated;
    };
    std::vector<bool> meshes;
    for (const tinygltf::Mesh& mesh : model.meshes)
        meshes.push_back(std::any_of(mesh.primitives.begin(), mesh.primitives.end(), isPrimitive));
    for (std::size_t index = 0; index < model.nodes.size(); ++index)
    {
        const tinygltf::Node& node = model.nodes[index];
        const int light = lightOf(node);
        const bool isHidable = tree.visibility[index] >= 0 && (node.mesh >= 0 || light >= 0);
        if (isHidable || isIn(meshes, node.mesh) || isIn(lights, light) || isIn(cameras, node.camera))
            nodes[index] = true;
    }
}

void addStillNodes(const tinygltf::Model& model, const NodeTree& tree, std::vector<bool>& nodes)
{
    const std::vector<bool> moved = driven(model, nodes, true);
    if (!contains(moved, true)) return;
    for (std::size_t index = 0; index < model.nodes.size(); ++index)
    {
        const tinygltf::Mesh* mesh = meshOf(model, model.nodes[index]);
        if (mesh && tree.drawn[index] && carriesRigidMesh(model.nodes[index], *mesh)) nodes[index] = true;
    }
}

bool isSkinned(const tinygltf::Node& node, const tinygltf::Primitive& primitive)
{
    return node.skin >= 0 && primitive.attributes.count("JOINTS_0") > 0;
}

bool isRigidOnJoint(const tinygltf::Model& model, const Joints& joints, std::size_t node,
                    const tinygltf::Primitive& primitive)
{
    const tinygltf::Node& source = model.nodes[node];
    const tinygltf::Mesh* mesh = meshOf(model, source);
    return mesh && joints.ofNode[node] >= 0 && (joints.moves[node] || morphTargetCount(*mesh) > 0) &&
           !isSkinned(source, primitive);
}

std::vector<int> rigidJoints(const tinygltf::Model& model, const NodeTree& tree, const Joints& joints)
{
    std::vector<int> result;
    for (std::size_t node = 0; node < model.nodes.size(); ++node)
    {
        const tinygltf::Mesh* mesh = tree.drawn[node] ? meshOf(model, model.nodes[node]) : nullptr;
        const auto isRigid = [&](const tinygltf::Primitive& p) { return isRigidOnJoint(model, joints, node, p); };
        if (mesh && std::any_of(mesh->primitives.begin(), mesh->primitives.end(), isRigid))
            result.push_back(joints.ofNode[node]);
    }
    if (joints.ofStillMeshes >= 0 && !contains(result, joints.ofStillMeshes)) result.push_back(joints.ofStillMeshes);
    return result;
}

Result<Joints> buildJoints(const tinygltf::Model& model, const NodeTree& tree, const std::vector<bool>& movedNodes)
{
    std::vector<bool> moves = movingNodes(model, tree, movedNodes);
    const std::vector<bool> isJoint = jointNodes(model, tree, moves, movedNodes);
    std::vector<int> inputOfNode(model.nodes.size(), -1);
    std::vector<bool> isSheared(model.nodes.size(), false);
    std::vector<Joint> joints;
    std::optional<std::size_t> still; // of the joints, the first that does not move
    for (const int node : tree.order)
    {
        const auto index = static_cast<std::size_t>(node);
        if (!isJoint[index]) continue;
        const NodeTransform transform = decompose(model.nodes[index]);
        if (!transform.inner.isFinite() || (transform.outer && !transform.outer->isFinite()))
            return Error{namedElement("nodes", index, model.nodes[index].name) +
                         ": its transform is beyond what float numbers hold"};
        int parent = tree.parents[index] < 0 ? -1 : elementOf(inputOfNode, tree.parents[index]);
        if (transform.outer)
        {
            joints.push_back({"", parent, *transform.outer, -1});
            parent = static_cast<int>(joints.size()) - 1;
            isSheared[index] = true;
        }
        inputOfNode[index] = static_cast<int>(joints.size());
        if (!still && !moves[index]) still = joints.size();
        joints.push_back({model.nodes[index].name, parent, transform.inner, node});
    }
    const bool needsStill = !joints.empty() && hasStillMeshes(model, tree, moves);
    if (needsStill && !still)
    {
        still = joints.size();
        joints.push_back({"", -1, JointTransform(), -1});
    }
    Result<Skeleton> skeleton = Skeleton::create(std::move(joints));
    if (!skeleton) return skeleton.error();
    const std::vector<TransformBound> atRest = boundsAtRest(skeleton.value());
    for (std::size_t joint = 0; joint < atRest.size(); ++joint)
        if (!atRest[joint].fits())
        {
            const auto node = static_cast<std::size_t>(std::max(skeleton.value().joint(joint).sourceNode, 0));
            return Error{namedElement("nodes", node, model.nodes[node].name) +
                         ": its transform and those above take it " + outOfRangeText()};
        }
    Joints result{std::move(skeleton).value(), std::move(inputOfNode), std::move(moves), std::move(isSheared)};
    for (int& joint : result.ofNode)
    {
        if (joint >= 0) joint = result.skeleton.jointOfInput(static_cast<std::size_t>(joint));
    }
    if (needsStill) result.ofStillMeshes = result.skeleton.jointOfInput(*still);
    return result;
}

std::vector<Skin> readSkins(const tinygltf::Model& model, const Joints& joints)
{
    std::vector<Skin> skins;
    skins.reserve(model.skins.size());
    for (const tinygltf::Skin& source : model.skins)
    {
        Skin skin;
        skin.name = source.name;
        for (const int node : source.joints)
            skin.joints.push_back(elementOf(joints.ofNode, node));
        skin.inverseBinds = readInverseBinds(model, source);
        skins.push_back(std::move(skin));
    }
    return skins;
}

Morphs readMorphs(const tinygltf::Model& model)
{
    Morphs morphs;
    morphs.ofNode.assign(model.nodes.size(), -1);
    for (std::size_t index = 0; index < model.nodes.size(); ++index)
    {
        const tinygltf::Node& node = model.nodes[index];
        const tinygltf::Mesh* mesh = meshOf(model, node);
        if (!mesh || morphTargetCount(*mesh) == 0) continue;
        MorphWeights morph;
        morph.name = node.name.empty() ? mesh->name : node.name;
        morph.sourceNode = static_cast<int>(index);
        const std::vector<double>& source = node.weights.empty() ? mesh->weights : node.weights;
        morph.defaults.assign(source.begin(), source.end()); // as many as targets, or none
        morph.defaults.resize(morphTargetCount(*mesh), 0.0f);
        morphs.ofNode[index] = static_cast<int>(morphs.weights.size());
        morphs.weights.push_back(std::move(morph));
    }
    for (MorphWeights& property : propertiesOf(model))
    {
        morphs.ofPointer[property.name] = static_cast<int>(morphs.weights.size());
        morphs.weights.push_back(std::move(property));
    }
    return morphs;
}

} // namespace osgGpuAnimation::gltf
