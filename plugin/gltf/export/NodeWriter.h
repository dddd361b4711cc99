// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/export/GlbWriter.h"
#include "gltf/file/Report.h"
#include "gltf/import/NodeTransform.h"

#include <osgGpuAnimation/animation/bounds/TransformBound.h>
#include <osgGpuAnimation/math/JointTransform.h>
#include <osgGpuAnimation/scene/traversal/SceneVisitor.h>

#include <osg/Matrixd>

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// A place of the scene graph, which becomes a node of the file as soon as a mesh, light or camera needs it.
struct NodePlace
{
    NodePlace* above = nullptr; ///< null: the scene
    NodeTransform toAbove;
    std::string name;                ///< may be empty
    std::optional<std::size_t> node; ///< once it is needed
    std::size_t depth = 0;           ///< nodes from a root to the place's own
};

/// Writes the nodes of a file (glTF 2.0, section 3.5), each as T · R · S. A matrix that shears becomes two nodes; one
/// that is not affine, or takes its node farther out than the import reads, is left out, with a warning.
class NodeWriter
{
public:
    /// The largest depth of a place with places below it: the import's limit without one place that shears and a node
    /// of its own for a mesh or light.
    static constexpr std::size_t maxDepth = maxNodeDepth - 4;

    NodeWriter(GlbWriter& writer, Report& report) : _writer(writer), _report(report) {}

    /// A place that exists as long as the writer. above: null: the scene.
    NodePlace& place(NodePlace* above, const osg::Matrixd& toAbove, const std::string& name);
    /// The place of a node that exists.
    NodePlace& placeOf(std::size_t node);

    /// A node of its own. above: null: the scene.
    std::size_t add(const std::string& name, JointTransform toAbove, NodePlace* above);
    /// The node of a place.
    std::size_t nodeOf(NodePlace& place);
    /// The node at the place that gets the member: the place's own if it does not have it, else a new one below it,
    /// with the name. place: null: the scene. isHidden: a new one in any case, which is not drawn, as those below it
    /// (KHR_node_visibility).
    std::size_t nodeFor(NodePlace* place, const char* member, const std::string& name, bool isHidden = false);

    nlohmann::json& at(std::size_t node) { return _writer.document["nodes"][node]; }

private:
    GlbWriter& _writer;
    Report& _report;
    std::deque<NodePlace> _places; ///< keeps addresses
    /// By node: the nodes from a root to it, and the bound from it to the scene.
    std::vector<std::pair<std::size_t, TransformBound>> _ofNode;
};

} // namespace osgGpuAnimation::gltf
