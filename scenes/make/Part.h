// SPDX-License-Identifier: MIT
#pragma once

#include "AtlasRect.h"
#include "Binding.h"
#include "LoftRing.h"
#include "Rig.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace osgGpuAnimation::scenes
{

/// A place on a part's surface, handed to its painter.
struct SurfacePoint
{
    double u = 0.0; ///< [0, 1] around the tube; 0 and 1 at the back, 0.5 at the front
    double v = 0.0; ///< [0, 1] along the tube, in proportion to the length on the surface
    glm::dvec3 position{0.0};
};

using Painter = std::function<glm::dvec3(const SurfacePoint&)>; ///< a place's colour: sRGB, [0, 1]
using Binder = std::function<Binding(const glm::dvec3& position, const LoftRing& ring)>;

/// A lofted tube: a grid of rows (one a ring) and columns (around; the first and the last coincide at the seam).
struct Part
{
    int rows = 0;
    int columns = 0;                   ///< vertices in a row: one more than there are segments
    std::vector<glm::dvec3> positions; ///< rows x columns, as all of these
    std::vector<glm::dvec3> normals;
    std::vector<Binding> bindings;
    std::vector<double> along; ///< v of each row
    std::vector<double> light; ///< how much of the surroundings a vertex sees, [0, 1]
    bool clockwise = false;    ///< the grid's triangles have to be turned over to face outwards
    std::string garment;       ///< the node that shows it (see CharacterMesh)
    std::string material;
    bool painted = true; ///< false: shares the texture of the part that it mirrors
    AtlasRect rect;
    Painter painter;
    Painter reflection; ///< gives (1, roughness, metallic), linear: the channels of glTF's metallic-roughness map

    int vertexAt(int row, int column) const { return row * columns + column; }
    glm::dvec2 textureCoordinate(int row, int column) const;
    /// Counter-clockwise triangles without the empty ones at poles and hard edges.
    std::vector<std::array<int, 3>> triangles() const;
    SurfacePoint surfaceAt(double u, double v) const;
    double lightAt(double u, double v) const;
};

Part loft(const std::vector<LoftRing>& rings, int segments, const Binder& binder);
/// The same part on the right side (see Rig), sharing the texture.
Part mirrored(const Part& part, const Rig& rig);

} // namespace osgGpuAnimation::scenes
