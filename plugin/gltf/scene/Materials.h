// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/scene/Textures.h"

#include <osg/StateSet>
#include <osg/Vec4>
#include <tiny_gltf.h>

#include <map>
#include <tuple>

namespace osgGpuAnimation::gltf
{

/// A material and all other inputs of a drawable's state.
struct MaterialUse
{
    int material = -1;     ///< -1: the specification's default material
    bool palette = false;  ///< drawn by the character program, else by the fixed pipeline
    bool mirrored = false; ///< front faces are clockwise
    bool lit = true;       ///< false: points and lines without normals
    bool flat = false;     ///< drawn from the palette, without normals in the file: faces compute theirs from the pose
    bool textured = false; ///< has coordinates for the base colour texture
    bool colored = false;  ///< has colours of its own for each vertex
    int influences = 0;    ///< drawn from the palette: the most influences of a vertex
    bool morphed = false;  ///< drawn from the palette: has morph targets

    auto key() const
    {
        return std::tie(material, palette, mirrored, lit, flat, textured, colored, influences, morphed);
    }
    bool operator<(const MaterialUse& other) const { return key() < other.key(); }
};

/// OSG removes a parent by linear search. An object with this many parents is replaced by a shallow copy.
constexpr unsigned int mostParents = 4096;

/// One osg::StateSet for each material and use of it, so that OSG can sort by it; another one after mostParents.
///
/// From glTF's material (2.0, section 3.9) come the base colour (factor and texture), emission, alpha mode, double
/// sidedness, KHR_materials_unlit and KHR_materials_emissive_strength; metalness, roughness, normal, occlusion and
/// emissive textures have no counterpart in the fixed pipeline and are left out. Colours: see displayColor().
class Materials
{
public:
    Materials(const tinygltf::Model& model, Textures& textures);

    osg::StateSet* stateSet(const MaterialUse& use);
    /// The base colour factor for display; white for the default material.
    osg::Vec4 baseColor(int material) const;
    /// True if the material has a base colour texture.
    bool wantsTexture(int material) const;

private:
    osg::ref_ptr<osg::StateSet> make(const MaterialUse& use);

    const tinygltf::Model& _model;
    Textures& _textures;
    std::map<MaterialUse, osg::ref_ptr<osg::StateSet>> _stateSets;
};

} // namespace osgGpuAnimation::gltf
