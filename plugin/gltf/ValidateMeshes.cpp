// SPDX-License-Identifier: MIT
#include "gltf/ValidateMeshes.h"

#include "gltf/data/Accessor.h"
#include "gltf/data/AttributeSemantic.h"
#include "gltf/data/TextureCoordinates.h"
#include "gltf/ElementName.h"

#include <algorithm>
#include <cstdint>
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

/// Checks primitives one after another and remembers what it learned of shared accessors and materials.
class MeshValidation
{
public:
    MeshValidation(const Model& model, DecodedBytes& budget, Report& report)
        : _model(model), _budget(budget), _report(report), _quantized(isQuantized(model)),
          _largestIndices(model.accessors.size(), unknown), _coordinates(materialCoordinates(model))
    {
    }

    std::optional<Error> validate(const tinygltf::Primitive& primitive, const std::string& name)
    {
        const auto position = primitive.attributes.find("POSITION");
        if (position == primitive.attributes.end()) return std::nullopt; // not drawn: PrimitiveRules has said so
        const std::size_t vertices = accessorOf(position->second).count;
        std::optional<Error> error =
            validateAttributes(primitive.attributes, {false, _quantized}, vertices, name + ".attributes");
        for (std::size_t t = 0; t < primitive.targets.size() && !error; ++t)
            error = validateAttributes(primitive.targets[t], {true, _quantized}, vertices,
                                       name + '.' + elementName("targets", t));
        if (!error) error = validateSets(primitive.attributes, name + ".attributes");
        if (!error) error = validateIndices(primitive, vertices, name);
        if (error) return error;
        warnOfIncomplete(primitive, vertices, name);
        warnOfCoordinates(primitive, name);
        return std::nullopt;
    }

private:
    static constexpr std::int64_t unknown = -1;

    const tinygltf::Accessor& accessorOf(int index) const { return _model.accessors[std::size_t(index)]; }

    std::optional<Error> validateAttributes(const Attributes& attributes, AttributePlace place, std::size_t vertices,
                                            const std::string& name)
    {
        for (const auto& [attribute, index] : attributes)
        {
            const tinygltf::Accessor& accessor = accessorOf(index);
            const std::string wrong = wrongAttributeFormat(accessor, AttributeSemantic::parse(attribute)->kind, place);
            const std::string in = " in " + elementName("accessors", std::size_t(index));
            if (!wrong.empty()) return fault(name + '.' + attribute, wrong, formatText(accessor) + in);
            if (accessor.count != vertices)
                return fault(name + '.' + attribute, std::to_string(vertices) + " elements (the count of POSITION)",
                             std::to_string(accessor.count) + in);
            if (!_budget.take(accessor.count * elementBytes(accessor)))
                return fault(name + '.' + attribute, _budget.limitText() + " for all primitives", "more");
        }
        return std::nullopt;
    }

    std::optional<Error> validateSets(const Attributes& attributes, const std::string& name) const
    {
        for (const auto& [attribute, index] : attributes)
        {
            const AttributeSemantic semantic = *AttributeSemantic::parse(attribute);
            const char* const partner = semantic.kind == Kind::Joints    ? "WEIGHTS_"
                                        : semantic.kind == Kind::Weights ? "JOINTS_"
                                                                         : nullptr;
            if (partner && attributes.count(partner + std::to_string(semantic.set)) == 0)
                return fault(name, partner + std::to_string(semantic.set) + " beside " + attribute, "none");
        }
        return std::nullopt;
    }

    std::int64_t largestIndex(int accessor)
    {
        std::int64_t& largest = _largestIndices[std::size_t(accessor)];
        if (largest != unknown) return largest;
        const std::vector<std::uint32_t> indices = readIntegers(_model, accessor);
        largest = *std::max_element(indices.begin(), indices.end());
        return largest;
    }

    std::optional<Error> validateIndices(const tinygltf::Primitive& primitive, std::size_t vertices,
                                         const std::string& name)
    {
        if (primitive.indices < 0) return std::nullopt;
        const tinygltf::Accessor& accessor = accessorOf(primitive.indices);
        const std::string in = " in " + elementName("accessors", std::size_t(primitive.indices));
        const bool integers = accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                              accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                              accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
        if (accessor.type != TINYGLTF_TYPE_SCALAR || !integers || accessor.normalized)
            return fault(name + ".indices", "SCALAR of unsigned byte, unsigned short or unsigned int",
                         formatText(accessor) + in);
        if (!_budget.take(accessor.count * elementBytes(accessor)))
            return fault(name + ".indices", _budget.limitText() + " for all primitives", "more");
        // The largest value of each type would restart the primitive (section 3.7.2.1).
        const std::size_t restart = (std::size_t(1) << 8 * componentBytes(accessor.componentType)) - 1;
        const std::int64_t largest = largestIndex(primitive.indices);
        if (std::size_t(largest) >= std::min(vertices, restart))
            return fault(name + ".indices", "indices below " + std::to_string(std::min(vertices, restart)),
                         std::to_string(largest) + in);
        return std::nullopt;
    }

    void warnOfIncomplete(const tinygltf::Primitive& primitive, std::size_t vertices, const std::string& name)
    {
        const std::size_t count = primitive.indices < 0 ? vertices : accessorOf(primitive.indices).count;
        const std::size_t least[] = {1, 2, 2, 2, 3, 3, 3};
        const std::size_t step[] = {1, 2, 1, 1, 3, 1, 1};
        const std::size_t mode = std::size_t(primitive.mode);
        if (count < least[mode] || count % step[mode] != 0)
            _report.warn(name + ": its " + std::to_string(count) +
                         " indices or vertices end in an incomplete line or "
                         "triangle, which is not drawn");
    }

    void warnOfCoordinates(const tinygltf::Primitive& primitive, const std::string& name)
    {
        if (primitive.material < 0) return;
        const std::uint32_t used = _coordinates[std::size_t(primitive.material)];
        for (int set = 0; set < AttributeSemantic::mostSets; ++set)
            if ((used >> set & 1) && primitive.attributes.count("TEXCOORD_" + std::to_string(set)) == 0)
                return _report.warn(name + ".attributes: expected TEXCOORD_" + std::to_string(set) + ", which " +
                                    elementName("materials", std::size_t(primitive.material)) +
                                    " reads, found none; the texture is left out");
    }

    const Model& _model;
    DecodedBytes& _budget;
    Report& _report;
    bool _quantized;
    std::vector<std::int64_t> _largestIndices; ///< one an accessor
    std::vector<std::uint32_t> _coordinates;   ///< one a material: the sets it reads, as bits
};

std::optional<Error> validateNodeWeights(const Model& model)
{
    for (std::size_t n = 0; n < model.nodes.size(); ++n)
    {
        const tinygltf::Node& node = model.nodes[n];
        if (node.weights.empty()) continue;
        const std::size_t targets = model.meshes[std::size_t(node.mesh)].primitives.front().targets.size();
        if (node.weights.size() != targets)
            return fault(elementName("nodes", n) + ".weights",
                         std::to_string(targets) + " (one a morph target of the mesh)",
                         std::to_string(node.weights.size()));
    }
    return std::nullopt;
}

} // namespace

std::optional<Error> validateMeshes(const Model& model, DecodedBytes budget, Report& report)
{
    MeshValidation validation(model, budget, report);
    for (std::size_t m = 0; m < model.meshes.size(); ++m)
        for (std::size_t p = 0; p < model.meshes[m].primitives.size(); ++p)
            if (std::optional<Error> error =
                    validation.validate(model.meshes[m].primitives[p], elementName("meshes", m, "primitives", p)))
                return error;
    return validateNodeWeights(model);
}

} // namespace osgGpuAnimation::gltf
