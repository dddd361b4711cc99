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
#include <utility>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

using Model = tinygltf::Model;
using Kind = AttributeSemantic::Kind;
using Attributes = std::map<std::string, int>;

// The rounding of up to sixteen floats, and less than one step of 16 bits.
const double sumRounding = 1e-6;
// Rounding weights to bytes one by one costs at most this much: mended without a warning.
const double usualSumFault = 0.02;

/// The joints that the vertices of one mesh refer to.
struct JointDemand
{
    /// By primitive with joints: its number, and one more than the largest joint that has a weight.
    std::vector<std::pair<std::size_t, std::size_t>> jointsWithWeight;
    std::size_t jointsInAll = 0;
    bool allPrimitives = true;                                     ///< have joints
    std::size_t minSkin = std::numeric_limits<std::size_t>::max(); ///< joints of the smallest skin of the mesh

    void add(std::size_t primitive, const std::vector<FileInfluences>& influences)
    {
        if (influences.empty()) allPrimitives = false;
        std::size_t withWeight = 0;
        for (const FileInfluences& set : influences)
            for (std::size_t i = 0; i < set.joints.size(); ++i)
            {
                const std::size_t joints = static_cast<std::size_t>(set.joints[i]) + 1;
                jointsInAll = std::max(jointsInAll, joints);
                if (set.weights[i] > 0.0f) withWeight = std::max(withWeight, joints);
            }
        if (!influences.empty()) jointsWithWeight.emplace_back(primitive, withWeight);
    }
};

struct MendedWeights
{
    bool any = false;
    std::optional<std::string> fault; ///< the first one that is more than rounding one by one
};

/// Makes the weights of each vertex non-negative with a sum of 1.
MendedWeights mendWeights(std::vector<FileInfluences>& sets)
{
    MendedWeights mended;
    const std::size_t vertices = sets.empty() ? 0 : sets[0].weights.size() / 4;
    for (std::size_t v = 0; v < vertices; ++v)
    {
        bool negative = false;
        double sum = 0.0;
        for (const FileInfluences& set : sets)
            for (std::size_t i = 4 * v; i < 4 * v + 4; ++i)
            {
                negative = negative || set.weights[i] < 0.0f;
                sum += std::max(set.weights[i], 0.0f);
            }
        const double sumFault = std::abs(sum - 1.0);
        if (!negative && sumFault <= sumRounding) continue;
        mended.any = true;
        for (FileInfluences& set : sets)
            for (std::size_t i = 4 * v; i < 4 * v + 4; ++i)
                set.weights[i] = sum > 0.0 ? static_cast<float>(std::max(set.weights[i], 0.0f) / sum) : 0.0f;
        if (sum == 0.0) sets[0].weights[4 * v] = 1.0f;
        if (!mended.fault && (negative || sumFault > usualSumFault))
            mended.fault = "vertex " + std::to_string(v) + " has " +
                           (negative    ? "a negative weight"
                            : sum > 0.0 ? "weights that do not sum to 1"
                                        : "no weight at all");
    }
    return mended;
}

/// Checks the primitives, then the nodes, whose skins decide which joints the primitives may have.
class MeshValidation
{
public:
    MeshValidation(Model& model, MemoryBudget& budget, Report& report)
        : _model(model), _budget(budget), _reads(budget.limit()), _report(report),
          _quantized(contains(model.extensionsUsed, "KHR_mesh_quantization")),
          _maxIndices(model.accessors.size(), unknown), _coordinates(materialCoordinates(model)),
          _demands(model.meshes.size())
    {
    }

    std::optional<Error> run()
    {
        std::optional<Error> error = forEachPrimitive(&MeshValidation::checkPrimitive);
        if (!error) error = checkNodeWeights();
        if (!error) error = forEachPrimitive(&MeshValidation::checkWeights);
        if (!error) error = checkSkins();
        if (!error) error = forEachPrimitive(&MeshValidation::checkJoints);
        return error;
    }

private:
    using Step = std::optional<Error> (MeshValidation::*)(tinygltf::Primitive& primitive, const PrimitiveName& name);

    /// Those that are drawn: checkDocumentRules() has warned of the others.
    std::optional<Error> forEachPrimitive(Step step)
    {
        for (std::size_t m = 0; m < _model.meshes.size(); ++m)
            for (std::size_t p = 0; p < _model.meshes[m].primitives.size(); ++p)
            {
                tinygltf::Primitive& primitive = _model.meshes[m].primitives[p];
                if (primitive.attributes.empty()) continue;
                if (std::optional<Error> error = (this->*step)(primitive, PrimitiveName{m, p})) return error;
            }
        return std::nullopt;
    }

    std::optional<Error> checkPrimitive(tinygltf::Primitive& primitive, const PrimitiveName& name)
    {
        const std::size_t vertices = accessorOf(primitive.attributes.at("POSITION")).count;
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
            if (!_reads.take(accessor.count * elementBytes(accessor)))
                return fault(subject(), _reads.limitText() + " for all primitives", "more");
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
        if (!_reads.take(accessor.count * elementBytes(accessor)))
            return fault(name.text() + ".indices", _reads.limitText() + " for all primitives", "more");
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

    std::optional<Error> checkNodeWeights() const
    {
        for (std::size_t n = 0; n < _model.nodes.size(); ++n)
        {
            const tinygltf::Node& node = _model.nodes[n];
            if (node.weights.empty()) continue;
            const std::size_t targets = elementOf(_model.meshes, node.mesh).primitives.front().targets.size();
            if (node.weights.size() != targets)
                return fault(elementName("nodes", n) + ".weights",
                             std::to_string(targets) + " (one a morph target of the mesh)", node.weights.size());
        }
        return std::nullopt;
    }

    std::optional<Error> checkWeights(tinygltf::Primitive& primitive, const PrimitiveName& name)
    {
        std::vector<FileInfluences> influences = readFileInfluences(_model, primitive);
        const MendedWeights mended = mendWeights(influences);
        _demands[name.mesh].add(name.primitive, influences);
        if (!mended.any) return std::nullopt;
        const std::string element = name.attributes() + ".WEIGHTS_0";
        if (mended.fault)
            _report.warn(element + ": " + *mended.fault + "; made to sum to 1, there and where else it is so");
        for (std::size_t set = 0; set < influences.size(); ++set)
        {
            const std::vector<float>& weights = influences[set].weights;
            if (!_budget.take(weights.size() * sizeof(float))) return fault(element, _budget.limitText(), "more");
            primitive.attributes["WEIGHTS_" + std::to_string(set)] = addAccessor(_model, weights, TINYGLTF_TYPE_VEC4);
        }
        return std::nullopt;
    }

    std::optional<Error> checkSkins()
    {
        for (std::size_t n = 0; n < _model.nodes.size(); ++n)
        {
            tinygltf::Node& node = _model.nodes[n];
            if (node.skin < 0) continue;
            JointDemand& demand = elementOf(_demands, node.mesh);
            const std::string name = elementName("nodes", n) + ".skin: " + elementName("meshes", node.mesh);
            if (demand.jointsWithWeight.empty())
            {
                _report.warn(name + " has no JOINTS_0 and WEIGHTS_0; the skin is ignored");
                node.skin = -1;
                continue;
            }
            if (!demand.allPrimitives) _report.warn(name + " has primitives without JOINTS_0; they are not skinned");
            const std::size_t joints = elementOf(_model.skins, node.skin).joints.size();
            for (const auto& [primitive, needed] : demand.jointsWithWeight)
                if (needed > joints)
                    return fault(elementName("meshes", node.mesh, "primitives", primitive) + ".attributes.JOINTS_0",
                                 "joints below " + std::to_string(joints) + " of " + elementName("skins", node.skin),
                                 needed - 1);
            demand.minSkin = std::min(demand.minSkin, joints);
        }
        return std::nullopt;
    }

    std::optional<Error> checkJoints(tinygltf::Primitive& primitive, const PrimitiveName& name)
    {
        const JointDemand& demand = _demands[name.mesh];
        if (demand.jointsInAll <= demand.minSkin) return std::nullopt;
        const std::vector<FileInfluences> influences = readFileInfluences(_model, primitive);
        const std::string element = name.attributes() + ".JOINTS_0";
        bool mended = false;
        for (std::size_t set = 0; set < influences.size(); ++set)
        {
            std::vector<std::uint16_t> joints;
            joints.reserve(influences[set].joints.size());
            for (const std::uint32_t joint : influences[set].joints)
                joints.push_back(joint < demand.minSkin ? static_cast<std::uint16_t>(joint) : std::uint16_t(0));
            if (std::equal(joints.begin(), joints.end(), influences[set].joints.begin())) continue;
            mended = true;
            if (!_budget.take(joints.size() * sizeof(std::uint16_t)))
                return fault(element, _budget.limitText(), "more");
            primitive.attributes["JOINTS_" + std::to_string(set)] = addAccessor(_model, joints, TINYGLTF_TYPE_VEC4);
        }
        if (mended)
            _report.warn(element + ": expected joints below " + std::to_string(demand.minSkin) +
                         ", found larger ones without weight; taken as 0");
        return std::nullopt;
    }

    Model& _model;
    MemoryBudget& _budget;
    MemoryBudget _reads; ///< of attributes and indices, which many primitives may share
    Report& _report;
    bool _quantized;
    std::vector<std::int64_t> _maxIndices;   ///< one per accessor
    std::vector<std::uint32_t> _coordinates; ///< one per material: the sets it reads, as bits
    std::vector<JointDemand> _demands;       ///< one per mesh
};

} // namespace

std::optional<Error> validateMeshes(Model& model, MemoryBudget& budget, Report& report)
{
    return MeshValidation(model, budget, report).run();
}

} // namespace osgGpuAnimation::gltf
