// SPDX-License-Identifier: MIT
#include "gltf/write/NodeWriter.h"

#include "gltf/scene/NodeTransform.h"

#include <utility>
#include <vector>

namespace osgGpuAnimation::gltf
{

NodePlace& NodeWriter::place(NodePlace* above, const osg::Matrixd& toAbove, const std::string& name)
{
    _places.push_back({above, toAbove, name, std::nullopt});
    return _places.back();
}

NodePlace& NodeWriter::placeOf(std::size_t node)
{
    _places.push_back({nullptr, {}, "", node});
    return _places.back();
}

std::size_t NodeWriter::add(const std::string& name, const JointTransform& toAbove, NodePlace* above)
{
    nlohmann::json node = nlohmann::json::object();
    if (!name.empty()) node["name"] = name;
    const glm::vec4 &t = toAbove.translation, &r = toAbove.rotation, &s = toAbove.scale;
    if (glm::vec3(t) != glm::vec3(0.0f)) node["translation"] = {t.x, t.y, t.z};
    if (r != glm::vec4(0, 0, 0, 1)) node["rotation"] = {r.x, r.y, r.z, r.w};
    if (glm::vec3(s) != glm::vec3(1.0f)) node["scale"] = {s.x, s.y, s.z};
    const std::size_t number = append(_writer.document["nodes"], std::move(node));
    if (above)
        at(nodeOf(*above))["children"].push_back(number);
    else
        _writer.document["scenes"][0]["nodes"].push_back(number);
    return number;
}

std::size_t NodeWriter::addMatrix(const std::string& name, const osg::Matrixd& toAbove, NodePlace* above)
{
    tinygltf::Node source;
    source.matrix.assign(toAbove.ptr(), toAbove.ptr() + 16); // OSG's rows are glTF's columns
    if (!toAbove.valid() || toAbove(0, 3) != 0.0 || toAbove(1, 3) != 0.0 || toAbove(2, 3) != 0.0 ||
        toAbove(3, 3) != 1.0)
    {
        _report.warn("transform " + quoted(name) + ": it is not affine; left out");
        source.matrix.clear();
    }
    const NodeTransform transform = decompose(source);
    if (!transform.outer) return add(name, transform.inner, above);
    NodePlace& outer = placeOf(add(name.empty() ? name : name + " shear", *transform.outer, above));
    return add(name, transform.inner, &outer);
}

std::size_t NodeWriter::nodeOf(NodePlace& place)
{
    std::vector<NodePlace*> missing;
    for (NodePlace* each = &place; each && !each->node; each = each->above)
        missing.push_back(each);
    for (auto each = missing.rbegin(); each != missing.rend(); ++each) // a node above exists first: no recursion
        (*each)->node = addMatrix((*each)->name, (*each)->toAbove, (*each)->above);
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
