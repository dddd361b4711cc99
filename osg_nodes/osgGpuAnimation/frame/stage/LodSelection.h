// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/Result.h>
#include <osgGpuAnimation/mesh/lod/CharacterLevels.h>
#include <osgGpuAnimation/mesh/lod/LevelsTask.h>
#include <osgGpuAnimation/mesh/lod/LodLevels.h>

#include <osg/Camera>
#include <osg/Group>
#include <osg/Matrix>
#include <osg/Vec4>
#include <osgUtil/CullVisitor>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation
{

/// The range from the finest to the coarsest level of detail of several meshes. All levels beyond it look alike.
class LodRange
{
public:
    /// The largest sum of vertices in a group. Meshes beyond it get no levels, unless another group contains them.
    static constexpr std::size_t maxVertices = LevelsTask::maxVertices;
    static constexpr int maxPixelError = 1'000'000; ///< pixels

    /// True if setPixelError() of characters and crowds accepts the value.
    static bool isPixelError(double pixels) { return pixels >= 0.0 && pixels <= maxPixelError; }
    /// The accepted range, for messages.
    static std::string describePixelErrors();

    LodRange() = default;
    /// The range of the SkinnedGeometry among a group's children. Meshes without levels are drawn with all triangles.
    /// merged: replaces meshes if it isOf() the group; null: nothing.
    LodRange(const osg::Group& meshes, const AnimationSet& set,
             std::shared_ptr<const CharacterLevels> merged = nullptr);

    /// The level clamped to the range; allTriangles if it is finer.
    int clamped(int level) const
    {
        return level < _finest ? LodLevels::allTriangles : level > _coarsest ? _coarsest : level;
    }
    /// The largest error of the surface at a level, in the set's units; at most LodLevels::errorOf(level).
    double foundError(int level) const;
    /// function(const SkinnedGeometry&), for the meshes to draw at a level in place of the group's.
    template <typename Function>
    void forEachMeshAt(int level, const osg::Group& meshes, Function function) const
    {
        if (_merged)
            _merged->forEachMeshAt(level, meshes, function);
        else
            forEachMesh(meshes, function);
    }

private:
    int _finest = std::numeric_limits<int>::max();
    int _coarsest = LodLevels::allTriangles;
    std::vector<std::pair<const SkinnedGeometry*, std::shared_ptr<const LodLevels>>> _ofMeshes;
    std::shared_ptr<const CharacterLevels> _merged; ///< null: each mesh has its own levels
};

/// The view that selects levels of detail: the camera that culls or, for an absolute depth-only camera (see DepthPass),
/// which is taken for a shadow map, the camera above it. The result is cached until another camera culls. One object
/// per cull visitor.
class LodView
{
public:
    /// Called at the start of a cull traversal, since cameras may have moved.
    void clear() { _projection = nullptr; }

    /// As osg::CullingSet::getPixelSizeVector(), at the visitor's present place. OSG divides a radius by the dot
    /// product of this vector and the position, which gives a diameter in pixels.
    osg::Vec4 pixelSizeVector(osgUtil::CullVisitor& visitor);

private:
    void find(osgUtil::CullVisitor& visitor);

    osg::ref_ptr<const osg::RefMatrix> _projection; ///< the key of the cache: each cull of a camera has a new one
    const osg::Camera* _culled = nullptr;           ///< the key of the cache
    const osg::Camera* _eye = nullptr;              ///< null: the culling camera itself
    const osg::Viewport* _viewport = nullptr;       ///< the eye's
    osg::Matrix _toEye;                             ///< from the space of the culling camera
};

/// Selects the LodLevels for a camera: the coarsest with an error of at most pixelError pixels, in the measure of small
/// feature culling. Shadow passes (see LodView) use the main camera's level, so that no surface shadows itself; for
/// objects behind the main camera they use their own camera's level. A temporary object of a traversal in one space.
class LodScale
{
public:
    /// pixelError: pixels; 0: all triangles. range: of the drawn meshes.
    LodScale(osgUtil::CullVisitor& visitor, LodView& view, float pixelError, const LodRange& range);

    /// The level for a sphere. centre, radius: in the visitor's space. rootMatrix: from the set's space to that space.
    /// The nearest point decides; a sphere that reaches behind the eye gets all triangles.
    int level(const glm::vec3& centre, float radius, const AffineMatrix& rootMatrix) const
    {
        return levelWithin(allowedError(centre, radius, maxScale(rootMatrix)));
    }
    /// The error that the pixel error allows for a sphere, in the units of the set; at most 0: none. scale: the largest
    /// of the placement.
    float allowedError(const glm::vec3& centre, float radius, float scale) const
    {
        const float seen = _seen.at(centre), reach = _seen.slope * radius;
        return (seen + reach < 0.0f ? _own.at(centre) - _own.slope * radius : seen - reach) / scale;
    }
    /// The coarsest level within an error in the units of the set.
    int levelWithin(float error) const { return _range.clamped(LodLevels::levelOf(error)); }
    double foundError(int level) const { return _range.foundError(level); } ///< See LodRange.

    /// False: all triangles everywhere.
    bool isOn() const { return _seen.errorAt != glm::vec4(0.0f); }

private:
    /// The allowed error as a linear function of the position in the visitor's space.
    struct Measure
    {
        glm::vec4 errorAt{0.0f}; ///< · (x, y, z, 1); below 0 behind the eye
        float slope = 0.0f;      ///< the largest change per unit of distance

        float at(const glm::vec3& place) const { return glm::dot(errorAt, glm::vec4(place, 1.0f)); }
    };

    LodRange _range;
    Measure _seen; ///< of the LodView
    Measure _own;  ///< of the culling camera
};

} // namespace osgGpuAnimation
