// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/data/MaterialMaps.h"
#include "gltf/file/Report.h"
#include "gltf/import/Textures.h"

#include <osgGpuAnimation/looks/PbrMaterial.h>

#include <osg/StateSet>
#include <osg/Vec4>
#include <tiny_gltf.h>

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// A material and all other inputs of a drawable's state.
struct MaterialUse
{
    int material = -1;     ///< -1: the specification's default material
    bool palette = false;  ///< drawn by the character program, else a plain osg::Geometry
    bool mirrored = false; ///< front faces are clockwise
    bool lit = true;       ///< false: points and lines without normals
    bool flat = false;     ///< drawn from the palette, without normals in the file: faces compute theirs from the pose
    unsigned int coordinates = 0; ///< see MeshPrimitive::coordinates: those that the material reads
    bool tangents = false;        ///< that the material reads
    bool colored = false;         ///< has colours of its own for each vertex
    int influences = 0;           ///< drawn from the palette: the most influences of a vertex
    bool morphed = false;         ///< drawn from the palette: has morph targets

    auto key() const
    {
        return std::tie(material, palette, mirrored, lit, flat, coordinates, tangents, colored, influences, morphed);
    }
    bool operator<(const MaterialUse& other) const { return key() < other.key(); }
};

/// OSG removes a parent by linear search. An object with this many parents is replaced by a shallow copy.
constexpr unsigned int maxParents = 4096;

/// One osg::StateSet for each material and use of it, so that OSG can sort by it; another one after maxParents.
///
/// A material becomes a PbrMaterial with its alpha mode, double sidedness and KHR_materials_unlit. With fixedLighting
/// only base colour and emission remain, drawn as by the fixed pipeline. A material's maps that are left out for want
/// of room get a warning.
class Materials
{
public:
    /// Each different set of maps, their coordinates and extensions needs programs of its own, which compile in about
    /// 0.2 s. Materials of further sets keep the base colour map alone and lose their extensions, with a warning.
    static constexpr std::size_t maxSets = 64;

    Materials(const tinygltf::Model& model, bool fixedLighting, Textures& textures, Report& report);

    osg::StateSet* stateSet(const MaterialUse& use);
    MapsOfMaterials& maps() { return _maps; } ///< with fixedLighting, of base colours alone
    /// The linear base colour factor; white for the default material.
    osg::Vec4 baseColor(int material) const;
    /// The colour array's element of a plain geometry, which the fixed pipeline uses in place of the material's colour.
    /// color: of the vertex, as displayed.
    osg::Vec4 plainColor(const osg::Vec4& color, int material) const;
    bool hasNormalMap(int material) { return _maps.of(material).hasNormalMap(); }
    /// The coordinates that the material's maps read, as bits by their numbers.
    unsigned int wantedCoordinates(int material) { return (1u << _maps.of(material).coordinates.size()) - 1u; }

private:
    osg::ref_ptr<osg::StateSet> make(const MaterialUse& use);
    PbrMaterial pbrMaterial(const tinygltf::Material& material, const MaterialUse& use);
    PbrMaterial limited(const PbrMaterial& material);
    void setAnimated(osg::StateSet& state, const MaterialUse& use);
    void warnOfMaps(int material, const MaterialMaps& maps);

    const tinygltf::Model& _model;
    const bool _fixedLighting;
    Textures& _textures;
    Report& _report;
    MapsOfMaterials _maps;
    const std::vector<bool> _areAnimated; ///< by material
    std::set<int> _warned;                ///< materials
    std::set<std::string> _sets;          ///< the shader defines of those in use
    bool _hasTooManySets = false;
    std::map<MaterialUse, osg::ref_ptr<osg::StateSet>> _stateSets;
};

} // namespace osgGpuAnimation::gltf
