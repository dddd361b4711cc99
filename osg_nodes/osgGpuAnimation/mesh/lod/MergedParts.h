// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/authoring/mesh/MeshConnectivity.h>
#include <osgGpuAnimation/mesh/lod/SurfaceColor.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace osgGpuAnimation
{

/// A level of detail of MergedParts.
struct CoarseMesh
{
    std::vector<std::uint32_t> sources; ///< by vertex: the vertex of the parts that it moves with
    std::vector<std::uint32_t> indices; ///< three a triangle, which is visible from one side
    std::vector<glm::vec3> positions;   ///< by vertex, in the first pose
    std::vector<osg::Vec4> colors;      ///< by vertex, without the material's own colour, as SurfaceColor::Look
};

/// Several parts of a character as one surface: the input of MergedMesh.
class MergedParts
{
public:
    struct Part
    {
        osg::ref_ptr<const SkinnedGeometry> mesh; ///< its StateSet is not read
        SurfaceColor color;
    };
    using Parts = std::vector<Part>;
    using Palettes = std::vector<std::vector<AffineMatrix>>;
    /// Vertices have the place of their triangle's part as the vertex attribute "posePart": outfits hide parts by one
    /// bit.
    static constexpr std::size_t maxParts = 32;
    static constexpr std::size_t maxVertices = 20'000;  ///< of the parts together
    static constexpr std::size_t maxTriangles = 40'000; ///< of the parts together

    /// True for a visible mesh of indexed triangles without morph targets and callbacks, whose material SurfaceColor
    /// reads.
    static bool accepts(const SkinnedGeometry& part);
    /// True if two such meshes have the same node mask and StateSets with the same attributes, modes and uniforms.
    static bool areAlike(const SkinnedGeometry& part, const SkinnedGeometry& other);

    /// parts: of meshes that are accepted and alike; at least one. palettes: of the poses in which errors are measured;
    /// at least one; they must outlive this object. keyPoseCount: of the first of them, see PosedSurface. stop: see
    /// PosedSurface. keepsParts: their vertices stay apart, so that outfits may hide each part.
    MergedParts(Parts parts, const Palettes& palettes, std::size_t keyPoseCount, const std::atomic<bool>* stop,
                bool keepsParts = false);

    /// False: too many vertices or triangles, no extent, or positions that are not finite.
    bool isValid() const { return _isValid; }
    double size() const { return _surface.size(); } ///< the diagonal of the box in the first pose
    const PosedSurface& surface() const { return _surface; }
    const std::vector<std::uint32_t>& indices() const { return _indices; } ///< three a triangle

    /// triangle: three vertices of one part.
    SurfaceColor::Look lookAt(const std::uint32_t* triangle, const glm::vec3& shares) const;
    osg::Vec4 colorOf(std::uint32_t vertex) const; ///< see SurfaceColor::Look
    /// By vertex, of length 1; of length 0: its triangles are flat.
    std::vector<glm::vec3> normalsIn(std::size_t pose) const;
    /// A mean of colours as the colour array stores it.
    osg::Vec4 stored(const osg::Vec4& color) const { return _parts.front().color.stored(color); }

    /// The mesh's vertices in the first poses.
    PosedSurface::Poses posesOf(const CoarseMesh& mesh,
                                std::size_t poseCount = std::numeric_limits<std::size_t>::max()) const;
    /// Turns directions at a vertex of the parts in a pose to the first pose; 0 where there is no such turn.
    glm::mat3 toFirstPose(std::uint32_t vertex, std::size_t pose) const;
    /// Without a StateSet, see SurfaceColor::flatState().
    osg::ref_ptr<SkinnedGeometry> geometryOf(const CoarseMesh& mesh) const;

private:
    /// A vertex of a part.
    struct Source
    {
        std::size_t part;
        std::uint32_t vertex;
    };

    Source sourceOf(std::uint32_t vertex) const;
    void addSurface(bool keepsParts);
    glm::dmat4 matrixOf(std::uint32_t vertex, const std::vector<AffineMatrix>& palette) const;
    std::vector<glm::dvec3> bindPositionsOf(const CoarseMesh& mesh) const;
    void setInfluences(const CoarseMesh& mesh, SkinnedGeometry& geometry) const;
    CoarseMesh splitByParts(const CoarseMesh& mesh, osg::FloatArray& outParts) const;

    const Parts _parts;
    const Palettes& _palettes;
    std::vector<std::uint32_t> _firstOf; ///< by part: its first vertex
    PosedSurface _surface;               ///< with colours for the order of collapses
    std::vector<std::uint32_t> _indices;
    bool _isValid = false;
};

/// Twice the triangle's area along its normal.
inline glm::vec3 areaNormal(const std::vector<glm::vec3>& positions, const std::uint32_t* triangle)
{
    return glm::cross(positions[triangle[1]] - positions[triangle[0]], positions[triangle[2]] - positions[triangle[0]]);
}

/// `otherwise` for a vector without a direction.
glm::vec3 unit(const glm::vec3& vector, const glm::vec3& otherwise);

} // namespace osgGpuAnimation
