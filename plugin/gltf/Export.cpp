// SPDX-License-Identifier: MIT
#include "gltf/Export.h"

#include "gltf/export/CharacterWriter.h"
#include "gltf/export/ClipWriter.h"
#include "gltf/export/GeometryWriter.h"
#include "gltf/export/GlbWriter.h"
#include "gltf/export/NodeWriter.h"
#include "gltf/file/Elements.h"
#include "gltf/import/Lights.h"

#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>
#include <osgGpuAnimation/looks/shading/PunctualLight.h>
#include <osgGpuAnimation/mesh/geometry/MaterialVariants.h>
#include <osgGpuAnimation/mesh/geometry/MeshNames.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/detail/CrowdDetail.h>
#include <osgGpuAnimation/nodes/JointAttachment.h>
#include <osgGpuAnimation/nodes/properties/AnimatedProperties.h>
#include <osgGpuAnimation/scene/traversal/SceneVisitor.h>

#include <osg/CameraView>
#include <osg/LightSource>
#include <osg/LOD>
#include <osg/Math>
#include <osg/Switch>
#include <osg/ValueObject>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace osgGpuAnimation::gltf
{

namespace
{

using nlohmann::json;

struct TraversalState
{
    NodePlace* place = nullptr; ///< null: the scene
    osg::Matrixd toPlace;       ///< not yet in a place
    osg::ref_ptr<const osg::StateSet> state = new osg::StateSet;
    const WrittenCharacter* character = nullptr; ///< above, see JointAttachment
    bool isHidden = false;
    std::size_t depth = 0; ///< nodes of the scene above
};

/// Plain geometry at a place.
struct PlacedGeometry
{
    NodePlace* place;
    osg::ref_ptr<const osg::StateSet> state;
    const osg::Geometry* geometry;
    bool isHidden;
};

struct Child
{
    const osg::Node* node;
    bool isHidden; ///< by its mask or an osg::Switch
};

/// The state of a node over that of the nodes above it. A kit's drawable has all of its own.
osg::ref_ptr<const osg::StateSet> stateBelow(const osg::ref_ptr<const osg::StateSet>& above, const osg::Node& node)
{
    const osg::StateSet* const own = node.getStateSet();
    if (!own) return above;
    if (own->getDefinePair("MATERIAL_PBR")) return own;
    osg::ref_ptr<osg::StateSet> merged = new osg::StateSet(*above);
    merged->merge(*own);
    if (!own->getName().empty()) merged->setName(own->getName());
    if (own->useRenderBinDetails()) merged->setRenderingHint(own->getRenderingHint());
    return merged;
}

/// True for the children of the finest level.
bool isFinest(const osg::LOD& levels, unsigned int child)
{
    const auto coarseness = [&](unsigned int number)
    {
        if (number >= levels.getNumRanges()) return std::numeric_limits<float>::max();
        return levels.getRangeMode() == osg::LOD::DISTANCE_FROM_EYE_POINT ? levels.getMinRange(number)
                                                                          : -levels.getMaxRange(number);
    };
    for (unsigned int other = 0; other < levels.getNumChildren(); ++other)
        if (coarseness(other) < coarseness(child)) return false;
    return true;
}

/// Of an osg::LOD, only the finest level.
std::vector<Child> childrenOf(const osg::Node& node)
{
    std::vector<Child> children;
    const osg::Group* const group = node.asGroup();
    const auto* const levels = dynamic_cast<const osg::LOD*>(&node);
    const auto* const choice = dynamic_cast<const osg::Switch*>(&node);
    for (unsigned int i = 0; group && i < group->getNumChildren(); ++i)
    {
        const osg::Node* const child = group->getChild(i);
        if (levels && !isFinest(*levels, i)) continue;
        children.push_back({child, child->getNodeMask() == 0 || (choice && !choice->getValue(i))});
    }
    return children;
}

/// Joints from a root to the farthest one.
std::size_t depthOf(const Skeleton& skeleton)
{
    std::vector<std::size_t> depths;
    for (const Joint& joint : skeleton.joints()) // parents first
        depths.push_back(1 + (joint.parent < 0 ? 0 : elementOf(depths, joint.parent)));
    return depths.empty() ? 0 : *std::max_element(depths.begin(), depths.end());
}

/// The nodes of a scene, parents first, without recursion: scenes may be deeper than the call stack.
class Walk
{
public:
    bool isAtEnd() const { return _open.empty() || guard.isBeyondMaxPaths(); }

    /// The next node, and the state at it.
    std::pair<const osg::Node*, TraversalState> next()
    {
        const auto [child, above] = std::move(_open.back());
        _open.pop_back();
        TraversalState at = *above;
        at.state = stateBelow(above->state, *child.node);
        at.isHidden = above->isHidden || child.isHidden;
        return {child.node, at};
    }

    void add(const osg::Node& node, const TraversalState& above)
    {
        _open.push_back({{&node, false}, std::make_shared<const TraversalState>(above)});
    }

    /// The children of a node come next. False: they shall not be visited, see guard.
    [[nodiscard]] bool addChildren(const osg::Node& node, const TraversalState& at)
    {
        const std::vector<Child> children = childrenOf(node);
        if (children.empty()) return true;
        if (!guard.enter(node, at.depth)) return false;
        const auto below = std::make_shared<TraversalState>(at);
        ++below->depth;
        for (auto child = children.rbegin(); child != children.rend(); ++child)
            _open.push_back({*child, below});
        return true;
    }

    SceneGuard guard{SceneGuard::Shared::EachPath, std::numeric_limits<std::size_t>::max()};

private:
    std::vector<std::pair<Child, std::shared_ptr<const TraversalState>>> _open; ///< the next one last
};

class SceneExporter
{
public:
    SceneExporter(const osg::Node& scene, Report& report)
        : _report(report), _nodes(_writer, report), _geometries(_writer, _variants, report),
          _characters(_writer, _nodes, _geometries, report), _clips(_writer, report)
    {
        json first = json::object();
        if (!scene.getName().empty()) first["name"] = scene.getName();
        _writer.document["scene"] = 0;
        _writer.document["scenes"].push_back(std::move(first));
        TraversalState top;
        top.toPlace.set(1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1); // from +Z up to +Y up, exactly
        _walk.add(scene, top);
        while (!_walk.isAtEnd())
        {
            const auto [node, at] = _walk.next();
            visit(*node, at);
        }
        if (_walk.guard.isBeyondMaxPaths()) return; // glb() refuses the scene
        writeGeometries();
        for (const WrittenCharacter& character : _written)
            _clips.write(character);
        writeVariants();
    }

    Result<std::string> glb() const
    {
        if (_walk.guard.isBeyondMaxPaths()) return Error{_walk.guard.fault()};
        if (!_writer.document.contains("nodes")) return Error{"there is nothing in the scene that glTF could store"};
        return _writer.glb(_report);
    }

private:
    void visit(const osg::Node& node, TraversalState at)
    {
        for (const std::string& name : variantNamesOf(node)) // before the meshes below
            if (!contains(_variants, name)) _variants.push_back(name);
        if (const auto* const character = dynamic_cast<const AnimatedCharacter*>(&node))
            return visitCharacter(*character, character->getController().sharedSet(),
                                  character->getFileToNode() * character->getMatrix(), at);
        if (const auto* const crowd = dynamic_cast<const AnimatedCrowd*>(&node))
        {
            _report.warn("crowd " + quoted(node.getName()) + ": glTF has no crowds of characters; one of its " +
                         std::to_string(crowd->getNumInstances()) + " instances is written");
            const osg::Matrixd placement = crowd->getNumInstances() > 0
                                               ? crowd->getPlacement(CrowdDetail::instances(*crowd).handleOf(0))
                                               : osg::Matrixd();
            return visitCharacter(*crowd, crowd->getSharedAnimationSet(), crowd->getFileToNode() * placement, at);
        }
        if (const auto* const attachment = dynamic_cast<const JointAttachment*>(&node))
            return visitAttachment(*attachment, at);
        if (const auto* const view = dynamic_cast<const osg::CameraView*>(&node))
        {
            addCamera(*view, at);
            return visitChildren(node, at);
        }
        if (const osg::Transform* const transform = node.asTransform())
        {
            if (transform->getReferenceFrame() != osg::Transform::RELATIVE_RF)
                return _report.warn("transform " + quoted(node.getName()) +
                                    ": it has a reference frame of its own; left out");
            enter(*transform, at);
        }
        if (const auto* const source = dynamic_cast<const osg::LightSource*>(&node)) addLight(*source, at);
        if (dynamic_cast<const SkinnedGeometry*>(&node))
        {
            if (at.character) return; // visitCharacter() has it
            return _report.warn("mesh " + quoted(node.getName()) + ": there is no character above it; left out");
        }
        if (const auto* const geometry = dynamic_cast<const osg::Geometry*>(&node))
            _plain.push_back({placeAt(at), at.state, geometry, at.isHidden});
        else if (node.asDrawable())
            _report.warn("drawable " + quoted(node.getName()) + " (" + node.className() +
                         "): it is no geometry; left out");
        visitChildren(node, at);
    }

    void visitChildren(const osg::Node& node, const TraversalState& at)
    {
        if (!_walk.addChildren(node, at)) _report.warn(_walk.guard.fault() + "; what is below is left out");
    }

    void enter(const osg::Transform& transform, TraversalState& at)
    {
        osg::Matrix matrix;
        transform.computeLocalToWorldMatrix(matrix, nullptr);
        at.toPlace = matrix * at.toPlace;
        if (at.toPlace.isIdentity() && transform.getName().empty()) return;
        if (at.place && at.place->depth + 2 > NodeWriter::maxDepth)
        {
            if (!std::exchange(_isTooDeep, true))
                _report.warn("transform " + quoted(transform.getName()) + ": more than " +
                             std::to_string(NodeWriter::maxDepth) +
                             " nodes are above it; it and what is deeper are merged with the nodes below");
            return; // toPlace keeps it
        }
        at.place = &_nodes.place(at.place, at.toPlace, transform.getName());
        at.toPlace.makeIdentity();
    }

    void visitAttachment(const JointAttachment& attachment, const TraversalState& above)
    {
        TraversalState at = above;
        const std::string& name = attachment.getJointName();
        const WrittenCharacter* const character = at.character;
        const int joint = !character     ? -1
                          : name.empty() ? attachment.getJoint()
                                         : character->set->skeleton().findJoint(name);
        if (joint < 0 || static_cast<std::size_t>(joint) >= character->nodeOfJoint.size())
            return _report.warn("attachment " + quoted(attachment.getName().empty() ? name : attachment.getName()) +
                                ": there is no such joint; left out");
        at.place = &_nodes.placeOf(elementOf(character->nodeOfJoint, joint));
        at.toPlace = attachment.getOffset();
        visitChildren(attachment, at);
    }

    /// toAbove: from the axes of the character's file to the node above.
    void visitCharacter(const osg::Transform& character, const std::shared_ptr<const AnimationSet>& set,
                        const osg::Matrixd& toAbove, const TraversalState& at)
    {
        const std::size_t depth = (at.place ? at.place->depth : 0) + 2 + depthOf(set->skeleton());
        if (depth > NodeWriter::maxDepth)
            return _report.warn("character " + quoted(character.getName()) + ": its joints would be deeper than " +
                                std::to_string(NodeWriter::maxDepth) + " nodes; left out");
        const osg::Matrixd toPlace = toAbove * at.toPlace;
        _written.push_back(_characters.write(set, meshesOf(character, at), toPlace, character.getName(), at.place));
        TraversalState below = at;
        below.character = &_written.back();
        enter(character, below);
        visitChildren(character, below);
    }

    /// The meshes below a character; those below transforms are others'. at: of the character.
    static std::vector<CharacterMesh> meshesOf(const osg::Node& character, const TraversalState& at)
    {
        std::vector<CharacterMesh> meshes;
        Walk walk;
        static_cast<void>(walk.addChildren(character, at)); // visitChildren() warns
        while (!walk.isAtEnd())
        {
            const auto [node, own] = walk.next();
            if (const auto* const mesh = dynamic_cast<const SkinnedGeometry*>(node))
                meshes.push_back({mesh, own.state, own.isHidden});
            else if (!node->asTransform())
                static_cast<void>(walk.addChildren(*node, own));
        }
        return meshes;
    }

    void addLight(const osg::LightSource& source, const TraversalState& at)
    {
        const auto* const light = dynamic_cast<const PunctualLight*>(source.getLight());
        if (!light) return _report.warn("light " + quoted(source.getName()) + ": it is no PunctualLight; left out");
        if (at.isHidden) return _report.warn("light " + quoted(source.getName()) + ": it is hidden; left out");
        // See PunctualLight::setIntensity(). The base class sets any numbers.
        const osg::Vec4 diffuse = light->getDiffuse();
        const float max = std::max({diffuse.x(), diffuse.y(), diffuse.z()});
        const double outer = std::min(osg::PI_2, osg::DegreesToRadians(static_cast<double>(light->getSpotCutoff())));
        const PunctualLight::Kind kind = light->getKind();
        const auto isIntensity = [](float number)
        { return number >= 0.0f && number * osg::PI <= std::numeric_limits<float>::max(); };
        if (!isIntensity(diffuse.x()) || !isIntensity(diffuse.y()) || !isIntensity(diffuse.z()) ||
            (kind == PunctualLight::Kind::Spot && !(outer > 0.0)))
            return _report.warn("light " + quoted(source.getName()) + ": its colour or cone is out of range; left out");
        json made{{"intensity", max * osg::PI}};
        if (!source.getName().empty()) made["name"] = source.getName();
        if (max > 0.0f) made["color"] = {diffuse.x() / max, diffuse.y() / max, diffuse.z() / max};
        if (light->getRange() > 0.0f) made["range"] = light->getRange();
        made["type"] = lightTypeName(kind);
        if (const double inner = osg::DegreesToRadians(light->getInnerConeAngle()); kind == PunctualLight::Kind::Spot)
            made["spot"] = {{"innerConeAngle", inner < outer ? inner : 0.0}, {"outerConeAngle", outer}};
        const char* const extension = "KHR_lights_punctual";
        _writer.useExtension(extension);
        const std::size_t number = append(_writer.document["extensions"][extension]["lights"], std::move(made));
        const std::size_t node = _nodes.nodeFor(placeAt(at), "extensions", source.getName());
        _nodes.at(node)["extensions"][extension]["light"] = number;
    }

    void addCamera(const osg::CameraView& view, const TraversalState& at)
    {
        osg::Matrix matrix;
        view.computeLocalToWorldMatrix(matrix, nullptr);
        TraversalState below = at;
        below.toPlace = matrix * below.toPlace;
        // A viewer finds the planes itself; files must have some.
        constexpr double nearest = 0.01, farthest = 10000.0;
        json made = json::object();
        double height = 0.0;
        if (view.getUserValue(orthographicHeightName, height) && height != 0.0 &&
            std::abs(height) <= std::numeric_limits<float>::max())
            made = {
                {"type", "orthographic"},
                {"orthographic", {{"xmag", height / 2.0}, {"ymag", height / 2.0}, {"znear", 0.0}, {"zfar", farthest}}}};
        else if (view.getFieldOfViewMode() == osg::CameraView::VERTICAL && view.getFieldOfView() > 0.0 &&
                 view.getFieldOfView() < 180.0)
            made = {{"type", "perspective"},
                    {"perspective", {{"yfov", osg::DegreesToRadians(view.getFieldOfView())}, {"znear", nearest}}}};
        else
            return _report.warn("camera " + quoted(view.getName()) + ": it has no vertical field of view; left out");
        if (!view.getName().empty()) made["name"] = view.getName();
        const std::size_t node = _nodes.nodeFor(placeAt(below), "camera", view.getName());
        _nodes.at(node)["camera"] = append(_writer.document["cameras"], std::move(made));
    }

    NodePlace* placeAt(const TraversalState& at)
    {
        if (at.toPlace.isIdentity()) return at.place;
        std::array<double, 16> numbers;
        std::copy_n(at.toPlace.ptr(), 16, numbers.begin());
        NodePlace*& known = _unnamed[{at.place, numbers}];
        if (!known) known = &_nodes.place(at.place, at.toPlace, "");
        return known;
    }

    /// Geometries of one name at one place are one mesh; equal meshes are written once.
    void writeGeometries()
    {
        using Parts = std::vector<std::pair<const osg::Geometry*, const osg::StateSet*>>;
        using Place = std::pair<NodePlace*, bool>; ///< and whether the mesh is hidden
        std::vector<std::pair<Place, Parts>> meshes;
        std::map<std::pair<Place, std::string>, std::size_t> known;
        for (const PlacedGeometry& each : _plain)
        {
            const auto [number, isNew] =
                known.try_emplace({{each.place, each.isHidden}, meshNameOf(*each.geometry)}, meshes.size());
            if (isNew) meshes.emplace_back(Place(each.place, each.isHidden), Parts());
            meshes[number->second].second.emplace_back(each.geometry, each.state.get());
        }
        std::map<Parts, std::optional<std::size_t>> written;
        for (const auto& [place, parts] : meshes)
        {
            const std::string name = meshNameOf(*parts.front().first);
            const auto [number, isNew] = written.try_emplace(parts);
            if (isNew)
            {
                json primitives = json::array();
                for (const auto& [geometry, state] : parts)
                    for (json& primitive : _geometries.primitivesOf(*geometry, *state, nullptr))
                        primitives.push_back(std::move(primitive));
                json mesh = json::object();
                if (!name.empty()) mesh["name"] = name;
                if (!primitives.empty())
                {
                    mesh["primitives"] = std::move(primitives);
                    number->second = append(_writer.document["meshes"], std::move(mesh));
                }
            }
            if (!number->second) continue;
            const auto& [above, isHidden] = place;
            const std::size_t node = _nodes.nodeFor(above, "mesh", name, isHidden);
            _nodes.at(node)["mesh"] = *number->second;
        }
    }

    void writeVariants()
    {
        const json& used = _writer.document["extensionsUsed"];
        const char* const extension = "KHR_materials_variants";
        if (contains(used, extension))
            for (const std::string& name : _variants)
                _writer.document["extensions"][extension]["variants"].push_back({{"name", name}});
        if (used.is_null()) _writer.document.erase("extensionsUsed");
    }

    GlbWriter _writer;
    std::vector<std::string> _variants; ///< of the scene so far
    Report& _report;
    NodeWriter _nodes;
    GeometryWriter _geometries;
    CharacterWriter _characters;
    ClipWriter _clips;
    std::deque<WrittenCharacter> _written; ///< keeps addresses
    Walk _walk;
    bool _isTooDeep = false; ///< reported
    std::vector<PlacedGeometry> _plain;
    std::map<std::pair<NodePlace*, std::array<double, 16>>, NodePlace*> _unnamed; ///< places without a transform
};

} // namespace

Result<std::string> exportModel(const osg::Node& scene, Report& report)
{
    return SceneExporter(scene, report).glb();
}

} // namespace osgGpuAnimation::gltf
