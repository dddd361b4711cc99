// SPDX-License-Identifier: MIT
#include "gltf/export/NodeWriter.h"

#include <osgGpuAnimation/math/Rotation.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation::gltf
{

NodePlace& NodeWriter::place(NodePlace* above, const osg::Matrixd& toAbove, const std::string& name)
{
    const auto isSmall = [](double number) { return std::abs(number) <= TransformBound::maxNumber; };
    const bool isAffine = toAbove(0, 3) == 0.0 && toAbove(1, 3) == 0.0 && toAbove(2, 3) == 0.0 && toAbove(3, 3) == 1.0;
    NodeTransform transform;
    if (isAffine && std::all_of(toAbove.ptr(), toAbove.ptr() + 16, isSmall))
    {
        tinygltf::Node source;
        source.matrix.assign(toAbove.ptr(), toAbove.ptr() + 16); // OSG's rows are glTF's columns
        transform = decompose(source);
    }
    else
        _report.warn("transform " + quoted(name) + ": it is not affine or has numbers beyond 1e18; left out");
    _places.push_back({above, transform, name, std::nullopt, (above ? above->depth : 0) + (transform.outer ? 2 : 1)});
    return _places.back();
}

NodePlace& NodeWriter::placeOf(std::size_t node)
{
    _places.push_back({nullptr, {}, "", node, _ofNode[node].first});
    return _places.back();
}

std::size_t NodeWriter::add(const std::string& name, JointTransform toAbove, NodePlace* above)
{
    nlohmann::json node = nlohmann::json::object();
    if (!name.empty()) node["name"] = name;
    const auto [depth, outer] = above ? _ofNode[nodeOf(*above)] : std::pair(std::size_t(0), TransformBound());
    TransformBound reach = outer * TransformBound::of(toAbove);
    if (!reach.fits())
    {
        _report.warn("node " + quoted(name) + ": its transform and those above take it " + outOfRangeText() +
                     "; its own is left out");
        toAbove = JointTransform();
        reach = outer;
    }
    const glm::vec4 &t = toAbove.translation, &s = toAbove.scale;
    glm::vec4 r = toAbove.rotation;
    if (!(std::abs(glm::dot(r, r) - 1.0f) < 1e-3f)) r = glm::vec4(Rotation::unit(glm::dvec4(r)));
    if (glm::vec3(t) != glm::vec3(0.0f)) node["translation"] = {t.x, t.y, t.z};
    if (r != glm::vec4(0, 0, 0, 1)) node["rotation"] = {r.x, r.y, r.z, r.w};
    if (glm::vec3(s) != glm::vec3(1.0f)) node["scale"] = {s.x, s.y, s.z};
    const std::size_t number = append(_writer.document["nodes"], std::move(node));
    _ofNode.emplace_back(depth + 1, reach);
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

std::size_t NodeWriter::nodeFor(NodePlace* place, const char* member, const std::string& name, bool isHidden)
{
    if (place && !isHidden)
        if (const std::size_t node = nodeOf(*place); !at(node).contains(member)) return node;
    const std::size_t node = add(name, JointTransform(), place);
    if (!isHidden) return node;
    at(node)["extensions"]["KHR_node_visibility"]["visible"] = false;
    _writer.useExtension("KHR_node_visibility");
    return node;
}

} // namespace osgGpuAnimation::gltf
