// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/file/Report.h"
#include "gltf/write/GlbWriter.h"

#include <osgGpuAnimation/animation/JointTransform.h>

#include <osg/Matrixd>

#include <cstddef>
#include <deque>
#include <optional>
#include <string>

namespace osgGpuAnimation::gltf
{

/// A place of the scene graph, which becomes a node of the file as soon as a mesh, light or camera needs it.
struct NodePlace
{
    NodePlace* above = nullptr;      ///< null: the scene
    osg::Matrixd toAbove;            ///< affine
    std::string name;                ///< may be empty
    std::optional<std::size_t> node; ///< once it is needed
};

/// Writes the nodes of a file (glTF 2.0, section 3.5), each as T · R · S. A matrix that shears becomes two nodes.
class NodeWriter
{
public:
    NodeWriter(GlbWriter& writer, Report& report) : _writer(writer), _report(report) {}

    /// A place that exists as long as the writer. above: null: the scene.
    NodePlace& place(NodePlace* above, const osg::Matrixd& toAbove, const std::string& name);
    /// The place of a node that exists.
    NodePlace& placeOf(std::size_t node);

    /// A node of its own. above: null: the scene.
    std::size_t add(const std::string& name, const JointTransform& toAbove, NodePlace* above);
    /// The node of a place.
    std::size_t nodeOf(NodePlace& place);
    /// The node at the place that gets the member: the place's own if it does not have it, else a new one below it,
    /// with the name. place: null: the scene.
    std::size_t nodeFor(NodePlace* place, const char* member, const std::string& name);

    /// Neither the node nor those below it are drawn (KHR_node_visibility).
    void hide(std::size_t node);

    nlohmann::json& at(std::size_t node) { return _writer.document["nodes"][node]; }

private:
    std::size_t addMatrix(const std::string& name, const osg::Matrixd& toAbove, NodePlace* above);

    GlbWriter& _writer;
    Report& _report;
    std::deque<NodePlace> _places; ///< keeps addresses
};

} // namespace osgGpuAnimation::gltf
