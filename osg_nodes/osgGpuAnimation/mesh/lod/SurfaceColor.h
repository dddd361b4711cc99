// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/looks/PbrMaterial.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <osg/StateSet>
#include <osg/Vec2>
#include <osg/Vec4>

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <optional>

namespace osgGpuAnimation
{

/// The colours of a mesh without its textures, for coarse levels of detail that store them in their vertices. It keeps
/// the mesh's arrays and pictures, not its StateSet, so that another thread may read it while the StateSet changes.
class SurfaceColor
{
public:
    /// Empty: the mesh has no opaque material of the kit's own program (characterProgram()), or maps that vertices
    /// cannot replace: other maps than base colour, metallic-roughness, occlusion and normals; transformed texture
    /// coordinates; pictures that are compressed, not of 8 bits, animated or no longer in memory.
    static std::optional<SurfaceColor> of(const SkinnedGeometry& mesh) { return of(mesh, mesh.getStateSet()); }
    /// The same for another StateSet than the mesh's; null: none.
    static std::optional<SurfaceColor> of(const SkinnedGeometry& mesh, const osg::StateSet* state);

    /// What a point of the surface contributes.
    struct Look
    {
        osg::Vec4 color{0, 0, 0, 0};       ///< without the material's own colour; linear() if the material is linear
        osg::Vec2 metallicRoughness{0, 0}; ///< of the map
    };
    /// corners: vertices of a triangle. shares: barycentric coordinates of the point.
    Look at(const std::array<std::uint32_t, 3>& corners, const glm::vec3& shares) const;
    bool isTwoSided() const { return _isTwoSided; }
    /// A mean of Look::color as the colour array stores it.
    osg::Vec4 stored(const osg::Vec4& color) const { return _isLinear ? displayColor(color) : color; }

    /// The StateSet for a surface of one side and flat triangles whose vertices have the colours of a mesh with that
    /// StateSet. influences: see applySkinDefines(). metallicRoughness: the mean of the map. Values that the mesh's
    /// material shares stay shared.
    static osg::ref_ptr<osg::StateSet> flatState(const osg::StateSet& ofMesh, int influences,
                                                 const osg::Vec2& metallicRoughness);

private:
    struct Map
    {
        osg::ref_ptr<const osg::Image> image; ///< null: white
        bool repeatsS = false, repeatsT = false;
    };

    SurfaceColor() = default;
    static osg::Vec4 texelAt(const Map& map, const osg::Vec2& place);

    Map _baseColor, _metallicRoughness;
    osg::ref_ptr<const osg::Vec2Array> _coordinates; ///< null: none
    osg::ref_ptr<const osg::Array> _colors;          ///< null: white
    bool _isLinear = false;
    bool _isTwoSided = false;
};

} // namespace osgGpuAnimation
