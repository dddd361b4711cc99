// SPDX-License-Identifier: MIT
#include "gltf/export/NodeWriter.h"

#include <osgGpuAnimation/math/Rotation.h>

#include <glm/geometric.hpp>

#include <limits>
#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

struct CheckedTransform
{
    NodeTransform transform; ///< the identity if there is a fault
    std::string fault;       ///< empty: none
    TransformBound reach;
};

/// above: the bound of the place above.
CheckedTransform checked(const osg::Matrixd& matrix, const TransformBound& above)
{
    const CheckedTransform faulty{{}, "its numbers are beyond floats", above};
    const auto isFloat = [](double number) { return std::abs(number) <= std::numeric_limits<float>::max(); };
    if (!std::all_of(matrix.ptr(), matrix.ptr() + 16, isFloat)) return faulty;
    if (matrix(0, 3) != 0.0 || matrix(1, 3) != 0.0 || matrix(2, 3) != 0.0 || matrix(3, 3) != 1.0)
        return {{}, "it is not affine", above};
    tinygltf::Node source;
    source.matrix.assign(matrix.ptr(), matrix.ptr() + 16); // OSG's rows are glTF's columns
    CheckedTransform made{decompose(source), "", above};
    // Scales are lengths of columns, which may be beyond floats where the columns' numbers are not.
    if (!made.transform.inner.isFinite()) return faulty;
    if (made.transform.outer && !made.transform.outer->isFinite()) return faulty;
    if (made.transform.outer) made.reach = made.reach * TransformBound::of(*made.transform.outer);
    made.reach = made.reach * TransformBound::of(made.transform.inner);
    return isNear(made.reach, 0.0) ? made : CheckedTransform{{}, "it takes what is below " + outOfRangeText(), above};
}

} // namespace

NodePlace& NodeWriter::place(NodePlace* above, const osg::Matrixd& toAbove, const std::string& name)
{
    const CheckedTransform own = checked(toAbove, above ? above->reach : TransformBound());
    if (!own.fault.empty()) _report.warn("transform " + quoted(name) + ": " + own.fault + "; left out");
    const std::size_t depth = (above ? above->depth : 0) + (own.transform.outer ? 2 : 1);
    _places.push_back({above, own.transform, name, std::nullopt, depth, own.reach});
    return _places.back();
}

NodePlace& NodeWriter::placeOf(std::size_t node)
{
    _places.push_back({nullptr, {}, "", node, _ofNode[node].first, _ofNode[node].second});
    return _places.back();
}

std::size_t NodeWriter::add(const std::string& name, const JointTransform& toAbove, NodePlace* above)
{
    nlohmann::json node = nlohmann::json::object();
    if (!name.empty()) node["name"] = name;
    const glm::vec4 &t = toAbove.translation, &s = toAbove.scale;
    glm::vec4 r = toAbove.rotation;
    if (!(std::abs(glm::dot(r, r) - 1.0f) < 1e-3f)) r = glm::vec4(Rotation::unit(glm::dvec4(r)));
    if (glm::vec3(t) != glm::vec3(0.0f)) node["translation"] = {t.x, t.y, t.z};
    if (r != glm::vec4(0, 0, 0, 1)) node["rotation"] = {r.x, r.y, r.z, r.w};
    if (glm::vec3(s) != glm::vec3(1.0f)) node["scale"] = {s.x, s.y, s.z};
    const auto [depth, reach] = above ? _ofNode[nodeOf(*above)] : std::pair(std::size_t(0), TransformBound());
    const std::size_t number = append(_writer.document["nodes"], std::move(node));
    _ofNode.emplace_back(depth + 1, reach * TransformBound::of(toAbove));
    if (above)
        at(*above->node)["children"].push_back(number);
    else
        _writer.document["scenes"][0]["nodes"].push_back(number);
    return number;
}

std::size_t NodeWriter::nodeOf(NodePlace& place)
{
    std::vector<NodePlace*> missing;
    for (NodePlace* each = &place; each && !each->node; each = each->above)
        missing.push_back(each);
    for (auto each = missing.rbegin(); each != missing.rend(); ++each) // a node above exists first: no recursion
    {
        const std::string& name = (*each)->name;
        NodePlace* above = (*each)->above;
        if (const std::optional<JointTransform>& outer = (*each)->toAbove.outer)
            above = &placeOf(add(name.empty() ? name : name + " shear", *outer, above));
        (*each)->node = add(name, (*each)->toAbove.inner, above);
    }
    return *place.node;
}

void NodeWriter::hide(std::size_t node)
{
    const char* const extension = "KHR_node_visibility";
    at(node)["extensions"][extension]["visible"] = false;
    _writer.useExtension(extension);
}

std::size_t NodeWriter::nodeFor(NodePlace* place, const char* member, const std::string& name)
{
    if (place)
        if (const std::size_t node = nodeOf(*place); !at(node).contains(member)) return node;
    return add(name, JointTransform(), place);
}

} // namespace osgGpuAnimation::gltf
