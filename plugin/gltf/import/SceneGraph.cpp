// SPDX-License-Identifier: MIT
#include "gltf/import/SceneGraph.h"

#include "gltf/data/Accessor.h"
#include "gltf/data/VertexAttributes.h"
#include "gltf/document/MemoryBudget.h"
#include "gltf/file/Elements.h"
#include "gltf/file/Report.h"
#include "gltf/import/Drawables.h"
#include "gltf/import/Joints.h"
#include "gltf/import/NodeTransform.h"

#include <osgGpuAnimation/animation/bounds/TransformBound.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>

#include <glm/gtc/type_ptr.hpp>
#include <osg/FrontFace>
#include <osg/LOD>
#include <osg/MatrixTransform>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

const char* const instancingName = "EXT_mesh_gpu_instancing";

/// The numbers of TRANSLATION, ROTATION and SCALE by instance; those that are absent are empty.
struct Instances
{
    std::vector<double> translation, rotation, scale;
    std::size_t count = 0;
    std::string fault; ///< empty: none

    void read(const tinygltf::Model& model, const tinygltf::Value& attributes, const char* name, std::size_t components,
              std::vector<double>& numbers)
    {
        if (!attributes.Has(name) || !fault.empty()) return;
        const int index = attributes.Get(name).GetNumberAsInt(); // the schema has checked it
        const tinygltf::Accessor& accessor = elementOf(model.accessors, index);
        if (componentCount(accessor) != components)
            fault = std::string(name) + ": " + elementName("accessors", index) + " has " +
                    std::to_string(componentCount(accessor)) + " numbers an element, not " + std::to_string(components);
        else if (count != 0 && accessor.count != count)
            fault = "its attributes differ in count";
        else
            numbers = readDoubles(model, index);
        count = accessor.count;
    }

    osg::Matrixd at(std::size_t i) const
    {
        osg::Matrixd matrix;
        if (!scale.empty()) matrix.makeScale(scale[3 * i], scale[3 * i + 1], scale[3 * i + 2]);
        if (!rotation.empty())
        {
            const double* q = rotation.data() + 4 * i;
            const osg::Quat quaternion(q[0], q[1], q[2], q[3]);
            const double length = quaternion.length();
            if (length > 0.0) matrix.postMultRotate(quaternion / length);
        }
        if (!translation.empty())
            matrix.postMultTranslate(osg::Vec3d(translation[3 * i], translation[3 * i + 1], translation[3 * i + 2]));
        return matrix;
    }
};

/// True if the node repeats its mesh (EXT_mesh_gpu_instancing).
bool isInstanced(const tinygltf::Node& node)
{
    return node.extensions.count(instancingName) > 0;
}

/// From each instance to the node. A fault of the extension leaves one instance, at the node itself, with a warning.
std::vector<osg::Matrixd> readInstances(const tinygltf::Model& model, std::size_t node, MemoryBudget& budget,
                                        Report& report)
{
    constexpr std::size_t bytesAnInstance = 1024; // a MatrixTransform as a child
    const std::string label = namedElement("nodes", node, model.nodes[node].name) + ": " + instancingName + ": ";
    const tinygltf::Value& extension = model.nodes[node].extensions.at(instancingName);
    const tinygltf::Value& attributes = extension.Get("attributes");
    Instances instances;
    instances.read(model, attributes, "TRANSLATION", 3, instances.translation);
    instances.read(model, attributes, "ROTATION", 4, instances.rotation);
    instances.read(model, attributes, "SCALE", 3, instances.scale);
    const std::size_t count = instances.count;
    std::string& fault = instances.fault;
    if (fault.empty() && count == 0) fault = "no TRANSLATION, ROTATION or SCALE";
    if (fault.empty() && !budget.take(count * bytesAnInstance)) fault = std::to_string(count) + " are too many";
    if (!fault.empty()) report.warn(label + fault + "; the mesh is drawn once");
    std::vector<osg::Matrixd> made(fault.empty() ? count : 1);
    for (std::size_t i = 0; fault.empty() && i < count; ++i)
        made[i] = instances.at(i);
    return made;
}

/// True if points at that distance from the origin can be drawn.
bool reaches(const TransformBound& reach, double radius)
{
    return reach.fits() && reach.of(radius) <= TransformBound::maxNumber;
}

void setWinding(osg::Node& node, bool mirrored)
{
    node.getOrCreateStateSet()->setAttributeAndModes(
        new osg::FrontFace(mirrored ? osg::FrontFace::CLOCKWISE : osg::FrontFace::COUNTER_CLOCKWISE));
}

class SceneGraphBuilder
{
public:
    SceneGraphBuilder(const SceneParts& parts, osg::Group& still, AnimatedCharacter* character,
                      std::vector<ImportedPrimitive>& primitives)
        : _parts(parts), _root(still), _character(character), _primitives(primitives), _still(parts.model.nodes.size()),
          _stillRadius(parts.model.nodes.size(), 0.0), _groups(parts.model.nodes.size())
    {
    }

    std::vector<osg::ref_ptr<osg::Group>> build()
    {
        for (std::size_t node = 0; node < _parts.model.nodes.size(); ++node)
        {
            if (_parts.tree.drawn[node]) addMesh(node);
        }
        buildStillNodes();
        return std::move(_groups);
    }

private:
    void addMesh(std::size_t node)
    {
        const tinygltf::Node& source = _parts.model.nodes[node];
        if (source.mesh < 0) return;
        const auto& primitives = elementOf(_parts.model.meshes, source.mesh).primitives;
        bool moves = false;
        for (const int first : _parts.drawables.firstPrimitives(source.mesh))
        {
            const DrawablePlace place = placeOf(node, first);
            osg::Geometry* geometry = _parts.drawables.drawable(place);
            if (!geometry) continue;
            const MeshPrimitive& mesh = *_parts.drawables.meshPrimitive(place);
            const bool isStill = place.skin < 0 && place.joint < 0;
            if (isStill && !reaches(TransformBound::of(_parts.tree.toWorld[node]), mesh.radius))
            {
                _parts.report.warn(namedElement("nodes", node, source.name) + ": it takes vertices of " + mesh.label +
                                   ' ' + outOfRangeText() + "; not drawn");
                continue;
            }
            ImportedPrimitive imported;
            imported.node = static_cast<int>(node);
            imported.mesh = place.mesh;
            imported.primitives = mesh.primitives;
            imported.skin = place.skin < 0 ? -1 : source.skin;
            imported.morph = place.morph;
            imported.targets = mesh.targets.size();
            imported.vertexCount = mesh.vertexCount;
            imported.influences = place.skin < 0 ? 0 : 4 * influenceSetCount(elementOf(primitives, first));
            imported.geometry = geometry;
            imported.geometryVertex = mesh.geometryVertex;
            _primitives.push_back(std::move(imported));
            if (isStill)
            {
                _primitives.back().toModel = toOsg(_parts.tree.toWorld[node]);
                _still[node].push_back(geometry);
                _stillRadius[node] = std::max(_stillRadius[node], mesh.radius);
                continue;
            }
            moves = true;
            if (!_inCharacter.insert({_parts.tree.levelOf[node], geometry}).second) continue;
            addLevel(node, *geometry, *_character, _characterLods);
        }
        if (moves && isInstanced(source))
            _parts.report.warn(namedElement("nodes", node, source.name) +
                               ": EXT_mesh_gpu_instancing of a moving mesh is not supported; drawn once");
    }

    DrawablePlace placeOf(std::size_t node, int primitive) const
    {
        const tinygltf::Node& source = _parts.model.nodes[node];
        const auto& primitives = elementOf(_parts.model.meshes, source.mesh).primitives;
        const tinygltf::Primitive& primitiveSource = elementOf(primitives, primitive);
        DrawablePlace place;
        place.mesh = source.mesh;
        place.primitive = primitive;
        if (isSkinned(source, primitiveSource))
            place.skin = _parts.drawables.firstAlike(source.skin);
        else if (isRigidOnJoint(_parts.model, _parts.joints, node, primitiveSource))
        {
            place.joint = _parts.joints.ofNode[node];
            place.mirrored = _parts.tree.isMirrored(static_cast<int>(node));
        }
        if (place.skin >= 0 || place.joint >= 0)
        {
            place.morph = _parts.morphs.ofNode[node];
            place.name = source.name;
        }
        place.visibility = _parts.tree.visibility[node];
        place.hidden = _parts.tree.hidden[node];
        return place;
    }

    void buildStillNodes()
    {
        const NodeTree& tree = _parts.tree;
        std::vector<bool> needed(tree.order.size(), false);
        for (auto node = tree.order.rbegin(); node != tree.order.rend(); ++node)
        {
            const auto index = static_cast<std::size_t>(*node);
            if (!_still[index].empty() || _parts.carries[index]) needed[index] = true;
            const int parent = tree.parents[index];
            if (needed[index] && parent >= 0) elementOf(needed, parent) = true;
        }
        for (const int node : tree.order)
        {
            if (elementOf(needed, node)) addStill(static_cast<std::size_t>(node));
        }
    }

    void addStill(std::size_t node)
    {
        const tinygltf::Node& source = _parts.model.nodes[node];
        const int parent = _parts.tree.parents[node];
        osg::Group* const above = parent < 0 ? &_root : elementOf(_groups, parent).get();
        const osg::Matrixd local = toOsg(localMatrix(source));
        osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(local);
        transform->setName(source.name);
        const int level = _parts.tree.levelOf[node];
        if (level >= 0 && elementOf(_parts.tree.levels, level).node == static_cast<int>(node))
            addLevel(node, *transform, *above, _stillLods);
        else
            above->addChild(transform);
        _groups[node] = transform;
        if (determinantOf(local) < 0.0) setWinding(*transform, _parts.tree.isMirrored(static_cast<int>(node)));
        if (_still[node].empty()) return;
        std::vector<osg::ref_ptr<osg::Group>> places{transform};
        if (isInstanced(source))
        {
            places.clear();
            const TransformBound reach = TransformBound::of(_parts.tree.toWorld[node]);
            const double radius = _stillRadius[node];
            for (const osg::Matrixd& instance : readInstances(_parts.model, node, _parts.budget, _parts.report))
            {
                if (!reaches(reach * TransformBound::of(glm::make_mat4(instance.ptr())), radius))
                {
                    _parts.report.warn(namedElement("nodes", node, source.name) +
                                       ": EXT_mesh_gpu_instancing places an instance " + outOfRangeText() +
                                       "; not drawn");
                    continue;
                }
                places.push_back(new osg::MatrixTransform(instance));
                transform->addChild(places.back());
                if (determinantOf(instance) < 0.0)
                    setWinding(*places.back(), !_parts.tree.isMirrored(static_cast<int>(node)));
            }
        }
        for (const osg::ref_ptr<osg::Group>& place : places)
        {
            for (const osg::ref_ptr<osg::Geometry>& geometry : _still[node])
                addShared(*place, *geometry);
        }
    }

    using Lods = std::map<std::size_t, osg::ref_ptr<osg::LOD>>;

    /// Adds the child to the parent, or, if the node is part of a level of detail, to the parent's LOD of that group.
    void addLevel(std::size_t node, osg::Node& child, osg::Group& parent, Lods& lods) const
    {
        const int index = _parts.tree.levelOf[node];
        if (index < 0)
        {
            parent.addChild(&child);
            return;
        }
        const NodeLevel& level = elementOf(_parts.tree.levels, index);
        osg::ref_ptr<osg::LOD>& lod = lods[level.group];
        if (!lod)
        {
            lod = new osg::LOD;
            lod->setName(elementOf(_parts.model.nodes, level.firstNode).name);
            lod->setRangeMode(osg::LOD::PIXEL_SIZE_ON_SCREEN);
            parent.addChild(lod);
        }
        lod->addChild(&child, level.minPixels, level.maxPixels);
    }

    /// After maxParents, a new Geometry over the same arrays replaces `geometry`.
    void addShared(osg::Group& place, osg::Geometry& geometry)
    {
        if (geometry.getNumParents() < maxParents)
        {
            place.addChild(&geometry);
            return;
        }
        osg::ref_ptr<osg::Geometry>& open = _open[&geometry];
        if (!open || open->getNumParents() >= maxParents) open = new osg::Geometry(geometry, osg::CopyOp::SHALLOW_COPY);
        place.addChild(open);
    }

    const SceneParts& _parts;
    osg::Group& _root; ///< of what stays still
    AnimatedCharacter* _character;
    std::vector<ImportedPrimitive>& _primitives;
    std::vector<std::vector<osg::ref_ptr<osg::Geometry>>> _still; ///< by node: its plain geometries
    std::vector<double> _stillRadius;                             ///< by node: of its farthest vertex
    std::vector<osg::ref_ptr<osg::Group>> _groups;                ///< by node: null where no transform is needed
    /// By geometry with maxParents: the current one over the same arrays, with fewer.
    std::map<const osg::Geometry*, osg::ref_ptr<osg::Geometry>> _open;
    std::set<std::pair<int, const osg::Geometry*>> _inCharacter; ///< by level of detail, -1: none
    // By group of levels of detail:
    Lods _characterLods, _stillLods;
};

} // namespace

std::vector<osg::ref_ptr<osg::Group>> buildSceneGraph(const SceneParts& parts, osg::Group& still,
                                                      AnimatedCharacter* character,
                                                      std::vector<ImportedPrimitive>& primitives)
{
    return SceneGraphBuilder(parts, still, character, primitives).build();
}

} // namespace osgGpuAnimation::gltf
