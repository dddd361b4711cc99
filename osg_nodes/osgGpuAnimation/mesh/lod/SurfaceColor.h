// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/looks/PbrMaterial.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <osg/StateSet>
#include <osg/Texture2D>
#include <osg/Vec2>
#include <osg/Vec4>

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <optional>

namespace osgGpuAnimation
{

/// The colours of a mesh without its textures, for coarse levels of detail that store them in their vertices.
class SurfaceColor
{
public:
    /// Empty: the mesh has no opaque material of the kit's own program (characterProgram()), or maps that vertices
    /// cannot replace: other maps than base colour, metallic-roughness, occlusion and normals; transformed texture
    /// coordinates; pictures that are compressed, not of 8 bits, animated or no longer in memory.
    static std::optional<SurfaceColor> of(const SkinnedGeometry& mesh);

    /// What a point of the surface contributes.
    struct Look
    {
        osg::Vec4 color{0, 0, 0, 0};       ///< without the material's own colour; linear() if the material is linear
        osg::Vec2 metallicRoughness{0, 0}; ///< of the map
    };
    /// corners: vertices of a triangle. shares: barycentric coordinates of the point.
    Look at(const std::array<std::uint32_t, 3>& corners, const glm::vec3& shares) const;
    /// A mean of Look::color as the colour array stores it.
    osg::Vec4 stored(const osg::Vec4& color) const { return _isLinear ? displayColor(color) : color; }

    /// The StateSet for a surface of one side and flat triangles whose vertices have these colours. influences: see
    /// applySkinDefines(). metallicRoughness: the mean of the map. Values that the mesh's material shares stay shared.
    osg::ref_ptr<osg::StateSet> state(int influences, const osg::Vec2& metallicRoughness) const;

private:
    SurfaceColor() = default;

    osg::ref_ptr<const osg::StateSet> _state;
    osg::ref_ptr<const osg::Texture2D> _baseColor, _metallicRoughness; ///< null: white
    osg::ref_ptr<const osg::Vec2Array> _coordinates;                   ///< null: none
    osg::ref_ptr<const osg::Array> _colors;                            ///< null: white
    bool _isLinear = false;
};

} // namespace osgGpuAnimation
