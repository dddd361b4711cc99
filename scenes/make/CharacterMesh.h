// SPDX-License-Identifier: MIT
#pragma once

#include "Atlas.h"
#include "GltfDocument.h"
#include "Part.h"
#include "Rig.h"

#include <vector>

namespace osgGpuAnimation::scenes
{

/// The parts of a skinned character and their common texture.
class CharacterMesh
{
public:
    explicit CharacterMesh(const Rig& rig) : _rig(rig) {}

    const Rig& rig() const { return _rig; }

    /// Takes the part in, with width x height texels of the atlas for `painter` to fill.
    void add(Part part, int width, int height, const Painter& painter, const Painter& reflection);
    /// The part on the left side, and its mirror image.
    void addPair(const Part& part, int width, int height, const Painter& painter, const Painter& reflection);

    /// Once all parts are in: the light on them, and the texture painted.
    void finish();

    /// Joint numbers are those of the rig, whose skinned joints come first.
    PrimitiveArrays arrays() const;
    const Atlas& atlas() const { return _atlas; }

private:
    void allocateRects();

    const Rig& _rig;
    Atlas _atlas;
    std::vector<Part> _parts;
};

/// Appends a part's triangles: positions, normals and, where it has a rectangle, texture coordinates.
void appendPart(PrimitiveArrays& arrays, const Part& part);
/// Appends a part's joints and weights, its joint numbers being those of the skin.
void appendBindings(PrimitiveArrays& arrays, const Part& part);

} // namespace osgGpuAnimation::scenes
