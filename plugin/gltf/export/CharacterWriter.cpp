// SPDX-License-Identifier: MIT
#include "gltf/export/CharacterWriter.h"

#include "gltf/file/Elements.h"

#include <osgGpuAnimation/mesh/geometry/MeshNames.h>

#include <algorithm>
#include <set>
#include <utility>

namespace osgGpuAnimation::gltf
{

namespace
{

std::set<std::size_t> usedEntries(const SkinnedGeometry& mesh)
{
    std::set<std::size_t> used;
    for (std::size_t vertex = 0; vertex < mesh.getVertexCount(); ++vertex)
        mesh.forEachInfluence(vertex,
                              [&](std::size_t entry, float weight)
                              {
                                  if (weight > 0.0f) used.insert(entry);
                              });
    return used;
}

/// The joint that carries the mesh as it is; -1: none.
int carrierOf(const AnimationSet& set, const SkinnedGeometry& mesh)
{
    const int entry = mesh.getRigidEntry();
    if (entry < 0 || static_cast<std::size_t>(entry) >= set.paletteSize()) return -1;
    const PaletteEntry& palette = elementOf(set.palette(), entry);
    return palette.inverseBind.isIdentity() ? palette.joint : -1;
}

} // namespace

int CharacterWriter::skinOf(const AnimationSet& set, const SkinnedGeometry& mesh)
{
    std::set<std::size_t> used = usedEntries(mesh);
    const auto isJoint = [&](std::size_t entry)
    { return entry < set.paletteSize() && set.palette()[entry].joint >= 0; };
    const auto has = [&](const Entries& skin)
    {
        return std::all_of(used.begin(), used.end(),
                           [&](std::size_t entry) { return contains(skin, entry) || !isJoint(entry); });
    };
    const auto known = std::find_if(_skins.begin(), _skins.end(), has);
    if (known != _skins.end()) return static_cast<int>(known - _skins.begin());
    Entries own;
    std::copy_if(used.begin(), used.end(), std::back_inserter(own), isJoint);
    if (own.empty()) return -1;
    _skins.push_back(std::move(own));
    return static_cast<int>(_skins.size()) - 1;
}

/// Primitives of one mesh of the file have its name, that of its node, its skin and its morph.
void CharacterWriter::addGroups(const AnimationSet& set, const std::vector<CharacterMesh>& meshes)
{
    for (const CharacterMesh& each : meshes)
    {
        Group group{meshNameOf(*each.mesh),
                    each.mesh->getName(),
                    carrierOf(set, *each.mesh),
                    -1,
                    each.mesh->getMorphTargets().empty() ? -1 : each.mesh->getMorph(),
                    each.mesh->getMorphTargets().size(),
                    each.isHidden,
                    {}};
        if (group.joint < 0) group.skin = skinOf(set, *each.mesh);
        const auto same = std::find_if(_groups.begin(), _groups.end(),
                                       [&](const Group& other) { return other.key() == group.key(); });
        (same == _groups.end() ? _groups.emplace_back(std::move(group)) : *same).meshes.push_back(each);
    }
}

/// The joints of a skin have a node above them all (glTF 2.0, section 3.7.3.1).
bool CharacterWriter::needsNodeAbove(const AnimationSet& set) const
{
    const auto rootOf = [&](int joint)
    {
        while (set.skeleton().joint(static_cast<std::size_t>(joint)).parent >= 0)
            joint = set.skeleton().joint(static_cast<std::size_t>(joint)).parent;
        return joint;
    };
    const auto hasRoots = [&](const Entries& skin)
    {
        std::set<int> roots;
        for (const std::size_t entry : skin)
            roots.insert(rootOf(set.palette()[entry].joint));
        return roots.size() > 1;
    };
    return std::any_of(_skins.begin(), _skins.end(), hasRoots);
}

void CharacterWriter::writeSkins(const AnimationSet& set, WrittenCharacter& made)
{
    made.isInSkin.assign(set.skeleton().jointCount(), false);
    _firstSkin = _writer.document.contains("skins") ? _writer.document["skins"].size() : 0;
    for (std::size_t number = 0; number < _skins.size(); ++number)
    {
        const bool isOfSet = number < set.skins().size();
        nlohmann::json skin = nlohmann::json::object();
        if (isOfSet && !set.skins()[number].name.empty()) skin["name"] = set.skins()[number].name;
        std::vector<float> matrices;
        std::set<std::size_t> nodes;
        for (std::size_t place = 0; place < _skins[number].size(); ++place)
        {
            const PaletteEntry& entry = set.palette()[_skins[number][place]];
            AffineMatrix inverseBind = isOfSet ? set.skins()[number].inverseBinds[place] : entry.inverseBind;
            const std::string& jointName = set.skeleton().joint(static_cast<std::size_t>(entry.joint)).name;
            if (!TransformBound::of(inverseBind.toColumns()).fits())
            {
                _report.warn("inverse bind matrix of joint " + quoted(jointName) + ": it takes vertices " +
                             outOfRangeText() + "; the identity is written");
                inverseBind = AffineMatrix();
            }
            for (int column = 0; column < 4; ++column)
                for (std::size_t row = 0; row < 4; ++row)
                    matrices.push_back(row < 3 ? inverseBind.rows[row][column] : column < 3 ? 0.0f : 1.0f);
            std::size_t node = elementOf(made.nodeOfJoint, entry.joint);
            // A skin has each node once: a joint with two inverse bind matrices gets a node below it.
            if (!nodes.insert(node).second) node = _nodes.add(jointName, JointTransform(), &_nodes.placeOf(node));
            skin["joints"].push_back(node);
            for (int joint = entry.joint; joint >= 0;
                 joint = set.skeleton().joint(static_cast<std::size_t>(joint)).parent)
                elementOf(made.isInSkin, joint) = true;
        }
        skin["inverseBindMatrices"] = _writer.addFloats(matrices, "MAT4", GlbWriter::Use::Values);
        append(_writer.document["skins"], std::move(skin));
    }
}

void CharacterWriter::writeGroup(const Group& group, WrittenCharacter& made)
{
    const AnimationSet& set = *made.set;
    GeometryWriter::SkinPlaces places;
    for (std::size_t place = 0; group.skin >= 0 && place < elementOf(_skins, group.skin).size(); ++place)
        places.try_emplace(elementOf(_skins, group.skin)[place], static_cast<std::uint16_t>(place));
    nlohmann::json primitives = nlohmann::json::array();
    for (const CharacterMesh& each : group.meshes)
        for (nlohmann::json& primitive :
             _geometries.primitivesOf(*each.mesh, *each.state, group.skin < 0 ? nullptr : &places))
            primitives.push_back(std::move(primitive));
    if (primitives.empty()) return;
    const MorphWeights* const morph = group.morph >= 0 && static_cast<std::size_t>(group.morph) < set.morphs().size()
                                          ? &elementOf(set.morphs(), group.morph)
                                          : nullptr;
    // The node of a morphing mesh is a joint, of a skinned one, too.
    const int joint = group.joint >= 0 ? group.joint : morph ? set.skeleton().jointOfSourceNode(morph->sourceNode) : -1;
    NodePlace* const place = joint < 0 ? nullptr : &_nodes.placeOf(elementOf(made.nodeOfJoint, joint));
    const std::string& name = morph ? morph->name : group.nodeName;
    const std::size_t node = _nodes.nodeFor(place, "mesh", name, group.isHidden);
    nlohmann::json mesh{{"primitives", std::move(primitives)}};
    if (!group.name.empty()) mesh["name"] = group.name;
    _nodes.at(node)["mesh"] = append(_writer.document["meshes"], std::move(mesh));
    if (group.skin >= 0) _nodes.at(node)["skin"] = _firstSkin + static_cast<std::size_t>(group.skin);
    if (!morph) return;
    std::vector<float> weights = morph->defaults;
    weights.resize(group.targets);
    _nodes.at(node)["weights"] = weights;
    elementOf(made.morphNodes, group.morph).push_back(node);
}

WrittenCharacter CharacterWriter::write(const std::shared_ptr<const AnimationSet>& set,
                                        const std::vector<CharacterMesh>& meshes, const osg::Matrixd& toAbove,
                                        const std::string& name, NodePlace* above)
{
    WrittenCharacter made{set, {}, std::vector<std::vector<std::size_t>>(set->morphs().size()), {}};
    _skins.clear();
    _groups.clear();
    for (std::size_t skin = 0; skin < set->skins().size(); ++skin)
        _skins.emplace_back(set->entriesOfSkin(skin).begin(), set->entriesOfSkin(skin).end());
    addGroups(*set, meshes);
    if (!toAbove.isIdentity() || needsNodeAbove(*set)) above = &_nodes.place(above, toAbove, name);
    for (const Joint& joint : set->skeleton().joints())
    {
        NodePlace* const parent = joint.parent < 0 ? above : &_nodes.placeOf(elementOf(made.nodeOfJoint, joint.parent));
        made.nodeOfJoint.push_back(_nodes.add(joint.name, joint.rest, parent));
    }
    writeSkins(*set, made);
    for (const Group& group : _groups)
        writeGroup(group, made);
    return made;
}

} // namespace osgGpuAnimation::gltf
