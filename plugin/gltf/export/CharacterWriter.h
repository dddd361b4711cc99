// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/export/GeometryWriter.h"
#include "gltf/export/NodeWriter.h"
#include "gltf/file/Report.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <osg/Matrixd>
#include <osg/ref_ptr>
#include <osg/StateSet>

#include <cstddef>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// A mesh of a character with the state of its path.
struct CharacterMesh
{
    const SkinnedGeometry* mesh = nullptr;
    osg::ref_ptr<const osg::StateSet> state;
    bool isHidden = false;
};

/// The nodes that a character became.
struct WrittenCharacter
{
    std::shared_ptr<const AnimationSet> set;          ///< never null
    std::vector<std::size_t> nodeOfJoint;             ///< one per joint
    std::vector<std::vector<std::size_t>> morphNodes; ///< by morph: the nodes whose meshes it changes
    std::vector<bool> isInSkin;                       ///< by joint: a skin has it or one below it
};

/// Writes a character: a node for each joint, its skins, and its meshes. A mesh that follows one joint as it is becomes
/// the mesh of that joint's node; all others get a skin: the set's, or one of their own entries.
class CharacterWriter
{
public:
    CharacterWriter(GlbWriter& writer, NodeWriter& nodes, GeometryWriter& geometries, Report& report)
        : _writer(writer), _nodes(nodes), _geometries(geometries), _report(report)
    {
    }

    /// toAbove: from the axes of the set's file. name: of a node above the joints where one is needed. above: null: the
    /// scene.
    WrittenCharacter write(const std::shared_ptr<const AnimationSet>& set, const std::vector<CharacterMesh>& meshes,
                           const osg::Matrixd& toAbove, const std::string& name, NodePlace* above);

private:
    /// Palette entries in the order of a skin's joints.
    using Entries = std::vector<std::size_t>;
    /// Meshes with one node.
    struct Group
    {
        std::string name; ///< of the mesh
        std::string nodeName;
        int joint = -1; ///< carries it; -1: skinned
        int skin = -1;  ///< index of _skins
        int morph = -1;
        std::size_t targets = 0;
        bool isHidden = false;
        std::vector<CharacterMesh> meshes;

        auto key() const { return std::tie(name, nodeName, joint, skin, morph, targets, isHidden); }
    };

    int skinOf(const AnimationSet& set, const SkinnedGeometry& mesh);
    void addGroups(const AnimationSet& set, const std::vector<CharacterMesh>& meshes);
    bool needsNodeAbove(const AnimationSet& set) const;
    void writeSkins(const AnimationSet& set, WrittenCharacter& made);
    void writeGroup(const Group& group, WrittenCharacter& made);

    GlbWriter& _writer;
    NodeWriter& _nodes;
    GeometryWriter& _geometries;
    Report& _report;
    std::vector<Entries> _skins; ///< of the character that is being written: those of the set, then others
    std::vector<Group> _groups;
    std::size_t _firstSkin = 0; ///< the number in the file of _skins[0]
};

} // namespace osgGpuAnimation::gltf
