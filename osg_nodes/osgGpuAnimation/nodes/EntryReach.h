// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Bounds.h>

#include <osg/Array>

#include <map>

namespace osgGpuAnimation
{

class SkinnedGeometry;

/// What each palette entry moves, of all meshes that are added: for each entry the box of its vertices in bind pose,
/// wherever the clips' weights morph them. What bounds are worked out from.
///
///     EntryReach reach(set);
///     for (const osg::ref_ptr<SkinnedGeometry>& mesh : meshes)
///         reach.add(*mesh);
///     const std::vector<Box> bounds = boundsOfClips(set, reach.boxes());
///
/// Made and gone while bounds are worked out: the set and the meshes added must outlive it.
class EntryReach
{
public:
    /// additiveLayers: so many change the morph weights, besides the clip that is played.
    explicit EntryReach(const AnimationSet& set, std::size_t additiveLayers = 0);
    /// Begins with what another has, and has what is added from then on morphed by so many additive layers.
    EntryReach(const EntryReach& other, std::size_t additiveLayers);

    /// Entries that the set has not are passed over.
    void add(const SkinnedGeometry& mesh);

    const EntryBoxes& boxes() const { return _boxes; } ///< the set's paletteSize()

private:
    void addRigid(const osg::Vec3Array& vertices, std::size_t entry);

    const AnimationSet* _set;
    std::size_t _additiveLayers;
    EntryBoxes _boxes;
    std::map<const osg::Array*, Box> _bindBoxes; ///< of arrays of rigid meshes: what many share is looked through once
};

} // namespace osgGpuAnimation
