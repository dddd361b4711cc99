// SPDX-License-Identifier: MIT
#include "gltf/data/Validation.h"
#include "gltf/file/Elements.h"

#include "gltf/data/Accessor.h"
#include "gltf/data/MaterialMaps.h"
#include "gltf/data/VertexAttributes.h"
#include "gltf/document/AttributeSemantic.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

using Model = tinygltf::Model;
using Kind = AttributeSemantic::Kind;
using Attributes = std::map<std::string, int>;

bool isQuantized(const Model& model)
{
    return std::find(model.extensionsUsed.begin(), model.extensionsUsed.end(), "KHR_mesh_quantization") !=
           model.extensionsUsed.end();
}

/// Checks one primitive after another and remembers its findings about shared accessors and materials.
class MeshValidation
{
public:
    MeshValidation(const Model& model, MemoryBudget& budget, Report& report)
        : _model(model), _budget(budget), _report(report), _quantized(isQuantized(model)),
          _maxIndices(model.accessors.size(), unknown), _coordinates(materialCoordinates(model))
    {
    }

    std::optional<Error> validate(const tinygltf::Primitive& primitive, const PrimitiveName& name)
    {
        const auto position = primitive.attributes.find("POSITION");
        if (position == primitive.attributes.end()) return std::nullopt; // not drawn, checkDocumentRules() has warned
        const std::size_t vertices = accessorOf(position->second).count;
        std::optional<Error> error = validateAttributes(primitive.attributes, {false, _quantized}, vertices, name, -1);
        for (std::size_t t = 0; t < primitive.targets.size() && !error; ++t)
            error = validateAttributes(primitive.targets[t], {true, _quantized}, vertices, name, static_cast<int>(t));
        if (!error) error = validateSets(primitive.attributes, name);
        if (!error) error = validateIndices(primitive, vertices, name);
        if (error) return error;
        warnOfIncomplete(primitive, vertices, name);
        warnOfCoordinates(primitive, name);
        return std::nullopt;
    }

private:
    static constexpr std::int64_t unknown = -1;

    const tinygltf::Accessor& accessorOf(int index) const { return elementOf(_model.accessors, index); }

    /// target: of the primitive; -1: its own attributes.
    std::optional<Error> validateAttributes(const Attributes& attributes, AttributePlace place, std::size_t vertices,
                                            const PrimitiveName& name, int target)
    {
        for (const auto& [attribute, index] : attributes)
        {
            const auto subject = [&, &semantic = attribute] { return name.attributes(target) + '.' + semantic; };
            const tinygltf::Accessor& accessor = accessorOf(index);
            const std::string wrong = wrongAttributeFormat(accessor, AttributeSemantic::parse(attribute)->kind, place);
            const auto in = [at = index] { return " in " + elementName("accessors", at); };
            if (!wrong.empty()) return fault(subject(), wrong, formatText(accessor) + in());
            if (accessor.count != vertices)
                return fault(subject(), std::to_string(vertices) + " elements (the count of POSITION)",
                             std::to_string(accessor.count) + in());
            if (!_budget.take(accessor.count * elementBytes(accessor)))
                return fault(subject(), _budget.limitText() + " for all primitives", "more");
        }
        return std::nullopt;
    }

    std::optional<Error> validateSets(const Attributes& attributes, const PrimitiveName& name) const
    {
        for (const auto& [attribute, index] : attributes)
        {
            const AttributeSemantic semantic = *AttributeSemantic::parse(attribute);
            const char* const partner = semantic.kind == Kind::Joints    ? "WEIGHTS_"
                                        : semantic.kind == Kind::Weights ? "JOINTS_"
                                                                         : nullptr;
            if (partner && attributes.count(partner + std::to_string(semantic.set)) == 0)
                return fault(name.attributes(), partner + std::to_string(semantic.set) + " beside " + attribute,
                             "none");
        }
        return std::nullopt;
    }

    std::int64_t maxIndex(int accessor)
    {
        std::int64_t& max = elementOf(_maxIndices, accessor);
        if (max != unknown) return max;
        const std::vector<std::uint32_t> indices = readIntegers(_model, accessor);
        max = *std::max_element(indices.begin(), indices.end());
        return max;
    }

    std::optional<Error> validateIndices(const tinygltf::Primitive& primitive, std::size_t vertices,
                                         const PrimitiveName& name)
    {
        if (primitive.indices < 0) return std::nullopt;
        const tinygltf::Accessor& accessor = accessorOf(primitive.indices);
        const auto in = [&] { return " in " + elementName("accessors", primitive.indices); };
        const bool integers = accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                              accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                              accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
        if (accessor.type != TINYGLTF_TYPE_SCALAR || !integers || accessor.normalized)
            return fault(name.text() + ".indices", "SCALAR of unsigned byte, unsigned short or unsigned int",
                         formatText(accessor) + in());
        if (!_budget.take(accessor.count * elementBytes(accessor)))
            return fault(name.text() + ".indices", _budget.limitText() + " for all primitives", "more");
        // The largest value of each type would restart the primitive (section 3.7.2.1).
        const std::size_t restart = (std::size_t(1) << 8 * componentBytes(accessor.componentType)) - 1;
        const std::int64_t max = maxIndex(primitive.indices);
        if (static_cast<std::size_t>(max) >= std::min(vertices, restart))
            return fault(name.text() + ".indices", "indices below " + std::to_string(std::min(vertices, restart)),
                         std::to_string(max) + in());
        return std::nullopt;
    }

    void warnOfIncomplete(const tinygltf::Primitive& primitive, std::size_t vertices, const PrimitiveName& name)
    {
        const std::size_t count = primitive.indices < 0 ? vertices : accessorOf(primitive.indices).count;
        if (wholeCount(primitive.mode, count) != count)
            _report.warn(name.text() + ": its " + std::to_string(count) +
                         " indices or vertices end in an incomplete line or "
                         "triangle, which is not drawn");
    }

    void warnOfCoordinates(const tinygltf::Primitive& primitive, const PrimitiveName& name)
    {
        if (primitive.material < 0) return;
        const std::uint32_t used = elementOf(_coordinates, primitive.material);
        for (int set = 0; set < AttributeSemantic::maxSets; ++set)
            if ((used >> set & 1) && primitive.attributes.count("TEXCOORD_" + std::to_string(set)) == 0)
                return _report.warn(name.attributes() + ": expected TEXCOORD_" + std::to_string(set) + ", which " +
                                    elementName("materials", primitive.material) +
                                    " reads, found none; the texture is left out");
    }

    const Model& _model;
    MemoryBudget& _budget;
    Report& _report;
    bool _quantized;
    std::vector<std::int64_t> _maxIndices;   ///< one per accessor
    std::vector<std::uint32_t> _coordinates; ///< one per material: the sets it reads, as bits
};

std::optional<Error> validateNodeWeights(const Model& model)
{
    for (std::size_t n = 0; n < model.nodes.size(); ++n)
    {
        const tinygltf::Node& node = model.nodes[n];
        if (node.weights.empty()) continue;
        const std::size_t targets = elementOf(model.meshes, node.mesh).primitives.front().targets.size();
        if (node.weights.size() != targets)
            return fault(elementName("nodes", n) + ".weights",
                         std::to_string(targets) + " (one a morph target of the mesh)",
                         std::to_string(node.weights.size()));
    }
    return std::nullopt;
}

using Model = tinygltf::Model;

// The rounding of up to sixteen floats, and less than one step of 16 bits.
const double sumRounding = 1e-6;
// Rounding weights to bytes one by one costs at most this much: mended without a warning.
const double usualSumFault = 0.02;

/// The joints and weights of a primitive: an array for each set, 4 numbers a vertex.
struct Influences
{
    std::vector<std::vector<std::uint32_t>> joints;
    std::vector<std::vector<float>> weights;
};

/// The joints that the vertices of one mesh refer to.
struct JointDemand
{
    bool allPrimitives = true; ///< have joints
    bool anyPrimitive = false;
    std::size_t jointsWithWeight = 0; ///< one more than the largest joint number
    std::size_t jointsInAll = 0;
    std::size_t minSkin = std::numeric_limits<std::size_t>::max(); ///< joints of the smallest skin of the mesh

    void add(const Influences& influences)
    {
        allPrimitives = allPrimitives && !influences.joints.empty();
        anyPrimitive = anyPrimitive || !influences.joints.empty();
        for (std::size_t set = 0; set < influences.joints.size(); ++set)
            for (std::size_t i = 0; i < influences.joints[set].size(); ++i)
            {
                const std::size_t joints = static_cast<std::size_t>(influences.joints[set][i]) + 1;
                jointsInAll = std::max(jointsInAll, joints);
                if (influences.weights[set][i] > 0.0f) jointsWithWeight = std::max(jointsWithWeight, joints);
            }
    }
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
    for (std::size_t set = 0; primitive.attributes.count(jointsName(set)) != 0; ++set)
    {
        influences.joints.push_back(readIntegers(model, primitive.attributes.at(jointsName(set))));
        influences.weights.push_back(readFloats(model, primitive.attributes.at(weightsName(set))));
    }
    return influences;
}

struct MendedWeights
{
    bool any = false;
    std::optional<std::string> fault; ///< the first one that is more than rounding one by one
};

/// Makes the weights of each vertex non-negative with a sum of 1.
MendedWeights mendWeights(std::vector<std::vector<float>>& sets)
{
    MendedWeights mended;
    const std::size_t vertices = sets.empty() ? 0 : sets[0].size() / 4;
    for (std::size_t v = 0; v < vertices; ++v)
    {
        bool negative = false;
        double sum = 0.0;
        for (const std::vector<float>& weights : sets)
            for (std::size_t i = 4 * v; i < 4 * v + 4; ++i)
            {
                negative = negative || weights[i] < 0.0f;
                sum += std::max(weights[i], 0.0f);
            }
        const double sumFault = std::abs(sum - 1.0);
        if (!negative && sumFault <= sumRounding) continue;
        mended.any = true;
        for (std::vector<float>& weights : sets)
            for (std::size_t i = 4 * v; i < 4 * v + 4; ++i)
                weights[i] = sum > 0.0 ? static_cast<float>(std::max(weights[i], 0.0f) / sum) : 0.0f;
        if (sum == 0.0) sets[0][4 * v] = 1.0f;
        if (!mended.fault && (negative || sumFault > usualSumFault))
            mended.fault = "vertex " + std::to_string(v) + " has " +
                           (negative    ? "a negative weight"
                            : sum > 0.0 ? "weights that do not sum to 1"
                                        : "no weight at all");
    }
    return mended;
}

/// The first primitive of the mesh with a weighted joint that the skin does not have.
Error jointsFault(const Model& model, std::size_t mesh, std::size_t skin)
{
    const std::size_t count = model.skins[skin].joints.size();
    for (std::size_t p = 0; p < model.meshes[mesh].primitives.size(); ++p)
    {
        JointDemand demand;
        demand.add(readInfluences(model, model.meshes[mesh].primitives[p]));
        if (demand.jointsWithWeight > count)
            return fault(elementName("meshes", mesh, "primitives", p) + ".attributes.JOINTS_0",
                         "joints below " + std::to_string(count) + " of " + elementName("skins", skin),
                         std::to_string(demand.jointsWithWeight - 1));
    }
    return fault(elementName("meshes", mesh), "joints of " + elementName("skins", skin), "others");
}

/// Compares meshes with their skins, the meshes first.
class SkinningValidation
{
public:
    SkinningValidation(Model& model, MemoryBudget& budget, Report& report)
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
                                                              const PrimitiveName& name);

    std::optional<Error> forEachPrimitive(Step step)
    {
        for (std::size_t m = 0; m < _model.meshes.size(); ++m)
            for (std::size_t p = 0; p < _model.meshes[m].primitives.size(); ++p)
            {
                tinygltf::Primitive& primitive = _model.meshes[m].primitives[p];
                if (primitive.attributes.empty()) continue;
                if (std::optional<Error> error = (this->*step)(m, primitive, PrimitiveName{m, p})) return error;
            }
        return std::nullopt;
    }

    std::optional<Error> checkWeights(std::size_t mesh, tinygltf::Primitive& primitive, const PrimitiveName& name)
    {
        Influences influences = readInfluences(_model, primitive);
        const MendedWeights mended = mendWeights(influences.weights);
        _demands[mesh].add(influences);
        if (!mended.any) return std::nullopt;
        const std::string element = name.attributes() + ".WEIGHTS_0";
        if (mended.fault)
            _report.warn(element + ": " + *mended.fault + "; made to sum to 1, there and where else it is so");
        for (std::size_t set = 0; set < influences.weights.size(); ++set)
        {
            if (!_budget.take(influences.weights[set].size() * sizeof(float)))
                return fault(element, _budget.limitText(), "more");
            primitive.attributes[weightsName(set)] = addAccessor(_model, influences.weights[set], TINYGLTF_TYPE_VEC4);
        }
        return std::nullopt;
    }

    std::optional<Error> checkNodes()
    {
        for (std::size_t n = 0; n < _model.nodes.size(); ++n)
        {
            tinygltf::Node& node = _model.nodes[n];
            if (node.skin < 0) continue;
            JointDemand& demand = elementOf(_demands, node.mesh);
            const std::string name = elementName("nodes", n) + ".skin: " + elementName("meshes", node.mesh);
            if (!demand.anyPrimitive)
            {
                _report.warn(name + " has no JOINTS_0 and WEIGHTS_0; the skin is ignored");
                node.skin = -1;
                continue;
            }
            if (!demand.allPrimitives) _report.warn(name + " has primitives without JOINTS_0; they are not skinned");
            const std::size_t joints = elementOf(_model.skins, node.skin).joints.size();
            if (demand.jointsWithWeight > joints)
                return jointsFault(_model, static_cast<std::size_t>(node.mesh), static_cast<std::size_t>(node.skin));
            demand.minSkin = std::min(demand.minSkin, joints);
        }
        return std::nullopt;
    }

    std::optional<Error> checkJoints(std::size_t mesh, tinygltf::Primitive& primitive, const PrimitiveName& name)
    {
        const JointDemand& demand = _demands[mesh];
        if (demand.jointsInAll <= demand.minSkin) return std::nullopt;
        const Influences influences = readInfluences(_model, primitive);
        const std::string element = name.attributes() + ".JOINTS_0";
        bool mended = false;
        for (std::size_t set = 0; set < influences.joints.size(); ++set)
        {
            std::vector<std::uint16_t> joints;
            joints.reserve(influences.joints[set].size());
            for (const std::uint32_t joint : influences.joints[set])
                joints.push_back(joint < demand.minSkin ? static_cast<std::uint16_t>(joint) : std::uint16_t(0));
            if (std::equal(joints.begin(), joints.end(), influences.joints[set].begin())) continue;
            mended = true;
            if (!_budget.take(joints.size() * sizeof(std::uint16_t)))
                return fault(element, _budget.limitText(), "more");
            primitive.attributes[jointsName(set)] = addAccessor(_model, joints, TINYGLTF_TYPE_VEC4);
        }
        if (mended)
            _report.warn(element + ": expected joints below " + std::to_string(demand.minSkin) +
                         ", found larger ones without weight; taken as 0");
        return std::nullopt;
    }

    Model& _model;
    MemoryBudget& _budget;
    Report& _report;
    std::vector<JointDemand> _demands; ///< one per mesh
};

} // namespace

std::optional<Error> validateMeshes(Model& model, MemoryBudget& budget, Report& report)
{
    MemoryBudget primitives(budget.limit());
    MeshValidation validation(model, primitives, report);
    for (std::size_t m = 0; m < model.meshes.size(); ++m)
        for (std::size_t p = 0; p < model.meshes[m].primitives.size(); ++p)
            if (std::optional<Error> error = validation.validate(model.meshes[m].primitives[p], PrimitiveName{m, p}))
                return error;
    if (std::optional<Error> error = validateNodeWeights(model)) return error;
    return SkinningValidation(model, budget, report).run();
}

} // namespace osgGpuAnimation::gltf
