// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/file/Elements.h"
#include "gltf/import/Materials.h"
#include "gltf/import/Meshes.h"
#include "gltf/import/NodeTree.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/bounds/TransformBound.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <osg/Geometry>

#include <map>
#include <memory>
#include <string_view>
#include <tuple>

namespace osgGpuAnimation::gltf
{

/// One use of a primitive, and of those drawn together with it. At most one of skin and joint is set; with neither it
/// is a plain osg::Geometry, else a SkinnedGeometry.
struct DrawablePlace
{
    int mesh = -1;
    int primitive = -1;
    int skin = -1;         ///< moves each vertex: the file's first skin with the same palette entries
    int joint = -1;        ///< of the skeleton: carries the whole primitive
    int morph = -1;        ///< index into the set's morphs
    int visibility = -1;   ///< see NodeTree::visibility
    bool hidden = false;   ///< see NodeTree::hidden
    bool mirrored = false; ///< with a joint: see MaterialUse
    std::string_view name; ///< of the node if a skin or a joint moves it; empty: that of the mesh serves

    auto key() const { return std::tie(mesh, primitive, skin, joint, morph, visibility, hidden, name); }
    bool operator<(const DrawablePlace& other) const { return key() < other.key(); }
};

/// Makes the drawables of a file. Equal uses of a primitive share the object, different uses share the arrays.
class Drawables
{
public:
    /// set: null where nothing moves. variant: the one that drawables show at first, an index of variantNames(); -1:
    /// none.
    Drawables(const tinygltf::Model& model, const NodeTree& tree, std::shared_ptr<const AnimationSet> set,
              Meshes& meshes, Materials& materials, int variant, MemoryBudget& budget, Report& report);

    /// The first skin of the file with the same palette entries as this one.
    int firstAlike(int skin) const { return elementOf(_firstAlike, skin); }
    /// The primitives to ask drawable() for, see Meshes.
    const std::vector<int>& firstPrimitives(int mesh) { return _meshes.firstPrimitives(mesh); }
    /// Null if the primitive cannot be drawn.
    osg::Geometry* drawable(const DrawablePlace& place);
    /// The arrays of the primitive; null if it cannot be drawn.
    const MeshPrimitive* meshPrimitive(const DrawablePlace& place)
    {
        return _meshes.primitive(place.mesh, place.primitive, place.skin >= 0);
    }

private:
    osg::ref_ptr<osg::Geometry> make(const DrawablePlace& place);
    double maxDistanceOf(const DrawablePlace& place, const MeshPrimitive& mesh) const;
    void setInfluences(SkinnedGeometry& geometry, const MeshPrimitive& mesh, const DrawablePlace& place);
    osg::StateSet* stateSet(const MeshPrimitive& mesh, MaterialUse use, int material);
    void setVariants(SkinnedGeometry& geometry, const MeshPrimitive& mesh, const PrimitiveMaterials& materials,
                     const MaterialUse& use);
    void setColors(osg::Geometry& geometry, const MeshPrimitive& mesh, int material, bool palette);

    const tinygltf::Model& _model;
    const NodeTree& _tree;
    std::shared_ptr<const AnimationSet> _set;
    Meshes& _meshes;
    Materials& _materials;
    const std::vector<std::string> _variants; ///< names
    const int _variant;
    MemoryBudget& _budget;
    Report& _report;
    std::vector<int> _firstAlike;         ///< by skin
    std::vector<TransformBound> _entries; ///< by palette entry
    std::map<DrawablePlace, osg::ref_ptr<osg::Geometry>> _drawables;
    std::map<osg::Vec4, osg::ref_ptr<osg::Vec4Array>> _overall; ///< colour arrays of primitives without vertex colours
};

} // namespace osgGpuAnimation::gltf
