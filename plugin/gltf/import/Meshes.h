// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/data/MaterialVariants.h"
#include "gltf/document/MemoryBudget.h"
#include "gltf/file/Report.h"

#include <osg/Array>
#include <osg/PrimitiveSet>
#include <osgGpuAnimation/mesh/MorphTarget.h>
#include <tiny_gltf.h>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// The arrays of a primitive, or of several drawn together, as OSG draws them, in the mesh's own space.
struct MeshPrimitive
{
    /// For messages: `meshes[3] "Cape".primitives[0]` or `meshes[3] "Cape".primitives[0] and 2 more`.
    std::string label;
    /// The file's numbers within the mesh, ascending; see Meshes.
    std::shared_ptr<const std::vector<int>> primitives;
    std::size_t vertexCount = 0; ///< of the file's POSITION accessor
    osg::ref_ptr<osg::Vec3Array> positions;
    osg::ref_ptr<osg::Vec3Array> normals;         ///< null: points or lines without normals, which are drawn unlit
    osg::ref_ptr<osg::Vec2Array> texCoords;       ///< number 0 of PrimitiveMaterials, or null
    osg::ref_ptr<osg::Vec4Array> moreCoordinates; ///< numbers 1 (xy) and 2 (zw), or null
    osg::ref_ptr<osg::Vec4Array> tangents;        ///< only for normal maps; or null
    osg::ref_ptr<osg::Vec4Array> colors;          ///< for display, see displayColor(); or null
    unsigned int coordinates = 0;                 ///< bit n is set if the vertices have coordinates number n
    osg::ref_ptr<osg::PrimitiveSet> primitiveSet;
    std::vector<MorphTarget> targets;
    double radius = 0.0;             ///< of the farthest vertex from the mesh's origin
    std::vector<double> targetRadii; ///< by target: the longest displacement of a vertex
    /// By vertex: the file's vertex. Empty if they are the same, because vertices were neither split for flat normals
    /// nor welded. Vertices that no triangle uses come last and are not drawn.
    std::vector<std::uint32_t> sourceVertex;
    /// The inverse, see ImportedPrimitive::geometryVertex.
    std::shared_ptr<const std::vector<std::uint32_t>> geometryVertex;
    /// The file has no normals. Those here are the normals of the faces; in a skinned mesh, whose program computes the
    /// normals of the faces, faces share a vertex and its normal is smooth.
    bool isFlat = false;
};

/// Reads the primitives of a file's meshes, each once: all modes, with or without indices, flat normals where a
/// triangle mesh has none (glTF 2.0, section 3.7.2.1). Primitives that cannot be drawn are left out; the validation has
/// warned of them.
///
/// Points, lines and triangles of one mesh are drawn together, in the order of the file, if they have the same
/// attributes, targets and materials in all variants: one drawable has their indices. Transparent ones stay apart,
/// since OSG sorts them by distance.
class Meshes
{
public:
    /// Reads the texture coordinates that the maps need, and tangents for normal maps.
    Meshes(const tinygltf::Model& model, MapsOfMaterials& maps, MemoryBudget& budget, Report& report)
        : _model(model), _maps(maps), _budget(budget), _report(report)
    {
    }

    /// The primitives of a mesh, ascending, without those that are drawn together with an earlier one.
    const std::vector<int>& firstPrimitives(int mesh) { return groupsOf(mesh).firsts; }
    /// One of firstPrimitives(), and those drawn together with it. skinned: by a skin, which makes vertices expensive:
    /// they are welded instead of split. Null if there is nothing to draw.
    const MeshPrimitive* primitive(int mesh, int primitive, bool skinned = false);

private:
    /// The primitives of a mesh that are drawn together.
    struct Groups
    {
        std::vector<int> firsts; ///< see firstPrimitives()
        std::vector<int> next;   ///< by primitive: the next that is drawn together with it; -1: none
    };

    const Groups& groupsOf(int mesh);
    std::optional<MeshPrimitive> read(int mesh, int first, bool welded);
    std::vector<std::uint32_t> readGroup(int mesh, int first, std::vector<int>& outPrimitives);
    void readSurface(const tinygltf::Primitive& primitive, const PrimitiveMaterials& materials, MeshPrimitive& mesh);

    const tinygltf::Model& _model;
    MapsOfMaterials& _maps;
    MemoryBudget& _budget;
    Report& _report;
    std::map<int, Groups> _groups; ///< by mesh
    std::map<std::tuple<int, int, bool>, std::optional<MeshPrimitive>> _primitives;
};

} // namespace osgGpuAnimation::gltf
