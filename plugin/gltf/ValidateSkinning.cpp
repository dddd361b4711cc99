// SPDX-License-Identifier: MIT
#include "gltf/ValidateSkinning.h"

#include "gltf/AddedData.h"
#include "gltf/data/Accessor.h"
#include "gltf/ElementName.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

using Model = tinygltf::Model;

// What rounding four weights to bytes can cost; weights within it are used as the file has them.
const float sumTolerance = 0.02f;
const std::size_t unlimited = std::numeric_limits<std::size_t>::max();

/// The joints and weights of a primitive, all sets of a vertex after one another.
struct Influences
{
    std::size_t sets = 0;
    std::size_t vertices = 0;
    std::vector<std::uint32_t> joints; ///< 4 a set and vertex
    std::vector<float> weights;        ///< likewise
};

/// What one mesh asks of the skins that it is used with.
struct JointDemand
{
    bool allPrimitives = true; ///< have joints
    bool anyPrimitive = false;
    std::size_t jointsWithWeight = 0; ///< one more than the largest joint number
    std::size_t jointsInAll = 0;
    std::size_t smallestSkin = unlimited; ///< joints of the smallest skin that it is used with
};

std::string jointsName(std::size_t set)
{
    return "JOINTS_" + std::to_string(set);
}
std::string weightsName(std::size_t set)
{
    return "WEIGHTS_" + std::to_string(set);
}

Influences readInfluences(const Model& model, const tinygltf::Primitive& primitive)
{
    Influences influences;
    while (primitive.attributes.count(jointsName(influences.sets)) != 0)
        ++influences.sets;
    if (influences.sets == 0) return influences;
    influences.vertices = model.accessors[std::size_t(primitive.attributes.at("POSITION"))].count;
    const std::size_t stride = influences.sets * 4;
    influences.joints.resize(influences.vertices * stride);
    influences.weights.resize(influences.vertices * stride);
    for (std::size_t set = 0; set < influences.sets; ++set)
    {
        const std::vector<std::uint32_t> joints = readIntegers(model, primitive.attributes.at(jointsName(set)));
        const std::vector<float> weights = readFloats(model, primitive.attributes.at(weightsName(set)));
        for (std::size_t v = 0; v < influences.vertices; ++v)
        {
            std::copy_n(&joints[v * 4], 4, &influences.joints[v * stride + set * 4]);
            std::copy_n(&weights[v * 4], 4, &influences.weights[v * stride + set * 4]);
        }
    }
    return influences;
}

/// Makes the weights of one vertex non-negative with a sum of 1; returns what was wrong, null if nothing was.
const char* mendWeights(float* weights, std::size_t count)
{
    const bool negative = std::any_of(weights, weights + count, [](float weight) { return weight < 0.0f; });
    double sum = 0.0;
    for (std::size_t i = 0; i < count; ++i)
        sum += std::max(weights[i], 0.0f);
    if (!negative && std::abs(sum - 1.0) <= sumTolerance) return nullptr;
    for (std::size_t i = 0; i < count; ++i)
        weights[i] = sum > 0.0 ? float(std::max(weights[i], 0.0f) / sum) : (i == 0 ? 1.0f : 0.0f);
    return negative ? "a negative weight" : sum > 0.0 ? "weights that do not sum to 1" : "no weight at all";
}

template <typename Number, typename From>
std::vector<Number> takeSet(const std::vector<From>& numbers, std::size_t sets, std::size_t set)
{
    std::vector<Number> taken;
    taken.reserve(numbers.size() / sets);
    for (std::size_t at = set * 4; at < numbers.size(); at += sets * 4)
        for (std::size_t i = 0; i < 4; ++i)
            taken.push_back(Number(numbers[at + i]));
    return taken;
}

/// Mends what can be mended; returns which vertex was the first, and what was wrong with it.
std::optional<std::string> mendAllWeights(Influences& influences)
{
    const std::size_t stride = influences.sets * 4;
    std::optional<std::string> first;
    for (std::size_t v = 0; v < influences.vertices; ++v)
    {
        const char* const what = mendWeights(&influences.weights[v * stride], stride);
        if (what && !first) first = "vertex " + std::to_string(v) + " has " + what;
    }
    return first;
}

bool mendJoints(Influences& influences, std::size_t skinJoints)
{
    bool mended = false;
    for (std::uint32_t& joint : influences.joints)
        if (joint >= skinJoints)
        {
            joint = 0;
            mended = true;
        }
    return mended;
}

void addDemand(const Influences& influences, JointDemand& demand)
{
    demand.allPrimitives = demand.allPrimitives && influences.sets > 0;
    demand.anyPrimitive = demand.anyPrimitive || influences.sets > 0;
    for (std::size_t i = 0; i < influences.joints.size(); ++i)
    {
        const std::size_t joints = std::size_t(influences.joints[i]) + 1;
        demand.jointsInAll = std::max(demand.jointsInAll, joints);
        if (influences.weights[i] > 0.0f) demand.jointsWithWeight = std::max(demand.jointsWithWeight, joints);
    }
}

/// The first primitive of the mesh with a weighted joint that the skin has not.
Error jointsFault(const Model& model, std::size_t mesh, std::size_t skin)
{
    const std::size_t count = model.skins[skin].joints.size();
    for (std::size_t p = 0; p < model.meshes[mesh].primitives.size(); ++p)
    {
        const tinygltf::Primitive& primitive = model.meshes[mesh].primitives[p];
        if (primitive.attributes.empty()) continue;
        JointDemand demand;
        addDemand(readInfluences(model, primitive), demand);
        if (demand.jointsWithWeight > count)
            return fault(elementName("meshes", mesh, "primitives", p) + ".attributes.JOINTS_0",
                         "joints below " + std::to_string(count) + " of " + elementName("skins", skin),
                         std::to_string(demand.jointsWithWeight - 1));
    }
    return fault(elementName("meshes", mesh), "joints of " + elementName("skins", skin), "others");
}

/// Holds meshes and skins against each other, the meshes first.
class SkinningValidation
{
public:
    SkinningValidation(Model& model, DecodedBytes& budget, Report& report)
        : _model(model), _budget(budget), _report(report), _demands(model.meshes.size())
    {
    }

    std::optional<Error> run()
    {
        std::optional<Error> error = forEachPrimitive(&SkinningValidation::checkWeights);
        if (!error) error = checkNodes();
        if (!error) error = forEachPrimitive(&SkinningValidation::checkJoints);
        return error;
    }

private:
    using Step = std::optional<Error> (SkinningValidation::*)(std::size_t mesh, tinygltf::Primitive&,
                                                              const std::string& name);

    std::optional<Error> forEachPrimitive(Step step)
    {
        for (std::size_t m = 0; m < _model.meshes.size(); ++m)
            for (std::size_t p = 0; p < _model.meshes[m].primitives.size(); ++p)
            {
                tinygltf::Primitive& primitive = _model.meshes[m].primitives[p];
                if (primitive.attributes.empty()) continue;
                if (std::optional<Error> error = (this->*step)(m, primitive, elementName("meshes", m, "primitives", p)))
                    return error;
            }
        return std::nullopt;
    }

    std::optional<Error> checkWeights(std::size_t mesh, tinygltf::Primitive& primitive, const std::string& name)
    {
        Influences influences = readInfluences(_model, primitive);
        const std::optional<std::string> mended = mendAllWeights(influences);
        addDemand(influences, _demands[mesh]);
        if (!mended) return std::nullopt;
        const std::string element = name + ".attributes.WEIGHTS_0";
        _report.warn(element + ": " + *mended + "; made to sum to 1, there and where else it is so");
        if (!_budget.take(influences.weights.size() * sizeof(float)))
            return fault(element, _budget.limitText(), "more");
        for (std::size_t set = 0; set < influences.sets; ++set)
            primitive.attributes[weightsName(set)] =
                addAccessor(_model, takeSet<float>(influences.weights, influences.sets, set), TINYGLTF_TYPE_VEC4);
        return std::nullopt;
    }

    std::optional<Error> checkNodes()
    {
        for (std::size_t n = 0; n < _model.nodes.size(); ++n)
        {
            tinygltf::Node& node = _model.nodes[n];
            if (node.skin < 0) continue;
            JointDemand& demand = _demands[std::size_t(node.mesh)];
            const std::string name =
                elementName("nodes", n) + ".skin: " + elementName("meshes", std::size_t(node.mesh));
            if (!demand.anyPrimitive)
            {
                _report.warn(name + " has no JOINTS_0 and WEIGHTS_0; the skin is ignored");
                node.skin = -1;
                continue;
            }
            if (!demand.allPrimitives) _report.warn(name + " has primitives without JOINTS_0; they are not skinned");
            const std::size_t joints = _model.skins[std::size_t(node.skin)].joints.size();
            if (demand.jointsWithWeight > joints)
                return jointsFault(_model, std::size_t(node.mesh), std::size_t(node.skin));
            demand.smallestSkin = std::min(demand.smallestSkin, joints);
        }
        return std::nullopt;
    }

    std::optional<Error> checkJoints(std::size_t mesh, tinygltf::Primitive& primitive, const std::string& name)
    {
        const JointDemand& demand = _demands[mesh];
        if (demand.jointsInAll <= demand.smallestSkin) return std::nullopt;
        Influences influences = readInfluences(_model, primitive);
        if (!mendJoints(influences, demand.smallestSkin)) return std::nullopt;
        const std::string element = name + ".attributes.JOINTS_0";
        _report.warn(element + ": expected joints below " + std::to_string(demand.smallestSkin) +
                     ", found larger ones without weight; taken as 0");
        if (!_budget.take(influences.joints.size() * sizeof(std::uint16_t)))
            return fault(element, _budget.limitText(), "more");
        for (std::size_t set = 0; set < influences.sets; ++set)
            primitive.attributes[jointsName(set)] = addAccessor(
                _model, takeSet<std::uint16_t>(influences.joints, influences.sets, set), TINYGLTF_TYPE_VEC4);
        return std::nullopt;
    }

    Model& _model;
    DecodedBytes& _budget;
    Report& _report;
    std::vector<JointDemand> _demands; ///< one a mesh
};

} // namespace

std::optional<Error> validateSkinning(Model& model, DecodedBytes& budget, Report& report)
{
    return SkinningValidation(model, budget, report).run();
}

} // namespace osgGpuAnimation::gltf
