// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/frame/crowd/InstanceVisits.h>
#include <osgGpuAnimation/frame/crowd/OutfitLists.h>
#include <osgGpuAnimation/mesh/lod/CharacterLevels.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>
#include <osgGpuAnimation/nodes/Outfit.h>

#include <osg/Group>
#include <osg/Uniform>

#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

/// The outfits of a crowd, and the meshes to draw for them: for each mesh of the crowd a copy for each StateSet in
/// which some outfit shows it, and the meshes of props. Cull threads read them.
class OutfitMeshes
{
public:
    using Number = std::uint16_t; ///< of an outfit, in [1, OutfitLists::maxOutfits]; 0: none

    OutfitMeshes() = default;
    /// The same outfits. update() makes the meshes, which are the same for the same crowd's meshes.
    OutfitMeshes(const OutfitMeshes& other)
        : _outfits(other._outfits), _props(other._props), _before(other._shown), _colors(other._colors),
          _statesBefore(other._states)
    {
    }
    OutfitMeshes& operator=(const OutfitMeshes&) = delete;

    /// Errors: see CrowdOutfits::add().
    Result<void> add(const osg::Group& crowd, const AnimationSet& set, Outfit* outfit);
    /// number: not 0. Errors: those of add().
    Result<void> replace(const osg::Group& crowd, const AnimationSet& set, Number number, Outfit* by);
    void remove(const osg::Group& crowd, Number number); ///< number: not 0
    /// Makes the meshes unless the crowd still has those of the last call. True: it made some.
    bool update(const osg::Group& crowd);
    /// Lets merged meshes show the parts of each outfit. levels: of meshes(); null: none.
    void showLevels(const CharacterLevels* levels);

    Number numberOf(const Outfit* outfit) const; ///< 0: there is no such outfit
    Outfit* outfit(Number number) const;         ///< null: 0
    std::vector<osg::ref_ptr<Outfit>> all() const;
    bool hasProps() const { return !_props.empty(); }

    /// The meshes to draw in place of the crowd's. Its node is in no scene.
    const osg::Group& meshes() const { return *_meshes; }
    const OutfitLists& lists() const { return _lists; }
    /// For intersectors and writers: the crowd's own meshes where outfits show them as they are.
    NodesOfOutfits nodesOfOutfits() const;

private:
    struct Source
    {
        osg::ref_ptr<SkinnedGeometry> mesh;
        osg::ref_ptr<osg::StateSet> state;
        osg::Node::NodeMask mask;

        bool isOf(const SkinnedGeometry& now) const
        {
            return mesh == &now && state == now.getStateSet() && mask == now.getNodeMask();
        }
    };
    struct Shown
    {
        osg::ref_ptr<SkinnedGeometry> mesh; ///< of the crowd or a prop
        osg::ref_ptr<SkinnedGeometry> copy; ///< of meshes(), in the state of these outfits
        bool isAsInCrowd;                   ///< the crowd has the mesh in this state, visible
        OutfitLists::Outfits outfits;
    };
    /// A StateSet with another picture (null: its own) and with the uniform of its material (null: none).
    using Derivation = std::tuple<osg::ref_ptr<osg::StateSet>, osg::ref_ptr<osg::Image>, osg::ref_ptr<osg::Uniform>>;
    using DerivedStates = std::map<Derivation, osg::ref_ptr<osg::StateSet>>;
    struct PropMesh
    {
        Outfit::Prop prop;
        std::vector<osg::ref_ptr<SkinnedGeometry>> meshes;
    };

    /// The StateSets of a mesh, and the outfits that show it so.
    using States = std::vector<std::pair<osg::StateSet*, OutfitLists::Outfits>>;

    Result<void> check(const osg::Group& crowd, const AnimationSet& set, const Outfit* outfit);
    Result<const PropMesh*> propMesh(const Outfit::Prop& prop, const AnimationSet& set);
    void make(const osg::Group& crowd);
    void makeUniforms();
    void showOwn(SkinnedGeometry& mesh, const std::vector<std::map<const SkinnedGeometry*, bool>>& visibility);
    void showProps();
    void show(SkinnedGeometry& mesh, bool isOwn, const States& states);
    osg::ref_ptr<SkinnedGeometry> copyOf(SkinnedGeometry& mesh, osg::StateSet* state) const;
    OutfitLists::Mesh mergedMesh(const std::vector<std::size_t>& parts) const;
    osg::StateSet* stateFor(osg::StateSet* state, const Outfit* outfit);
    template <typename Function>
    void forEachOutfit(Function function) const;

    std::vector<osg::ref_ptr<Outfit>> _outfits; ///< by number, from 1 on; null: a free number
    std::vector<PropMesh> _props;
    std::vector<Source> _sources; ///< the crowd's meshes of the last make()
    osg::ref_ptr<osg::Group> _meshes = new osg::Group;
    std::vector<Shown> _shown, _before; ///< of the last make(), and of the one before
    OutfitLists _lists;
    std::map<std::string, osg::ref_ptr<osg::Uniform>> _colors; ///< by material: its colours in all outfits
    DerivedStates _states, _statesBefore;
};

} // namespace osgGpuAnimation
