// SPDX-License-Identifier: MIT
#pragma once

#include "Atlas.h"
#include "GltfDocument.h"
#include "Part.h"
#include "Rig.h"

#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation::scenes
{

/// The parts of a skinned character and their common texture.
///
/// Parts belong to garments, each with a node of its own, and to materials. The first garment is the body: its parts
/// shade those of all garments, which do not shade one another because they are alternatives.
class CharacterMesh
{
public:
    /// scale: of the widths and heights in texels.
    explicit CharacterMesh(const Rig& rig, double scale = 1.0) : _rig(rig), _scale(scale) {}

    const Rig& rig() const { return _rig; }

    /// Where the parts added from now on belong; both names may be empty.
    void wear(const std::string& garment, const std::string& material);
    /// Takes the part in, with width x height texels of the atlas for `painter` to fill.
    void add(Part part, int width, int height, const Painter& painter, const Painter& reflection);
    /// The part on the left side, and its mirror image.
    void addPair(const Part& part, int width, int height, const Painter& painter, const Painter& reflection);

    /// Once all parts are in: the light on them, and the texture painted.
    void finish();

    /// All pairs of a garment and a material, in the order of their first parts.
    std::vector<std::pair<std::string, std::string>> primitives() const;
    /// The parts of a garment that have a material. Joint numbers are those of the rig, whose skinned joints come
    /// first.
    PrimitiveArrays arrays(const std::string& garment = "", const std::string& material = "") const;
    const Atlas& atlas() const { return _atlas; }

private:
    void light();
    void allocateRects();

    const Rig& _rig;
    double _scale;
    std::string _garment;
    std::string _material;
    Atlas _atlas;
    std::vector<Part> _parts;
};

/// Appends a part's triangles: positions, normals and, where it has a rectangle, texture coordinates.
void appendPart(PrimitiveArrays& arrays, const Part& part);
/// Appends a part's joints and weights, its joint numbers being those of the skin.
void appendBindings(PrimitiveArrays& arrays, const Part& part);

} // namespace osgGpuAnimation::scenes
