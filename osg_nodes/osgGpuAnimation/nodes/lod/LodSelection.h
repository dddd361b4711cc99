// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Result.h>
#include <osgGpuAnimation/nodes/lod/LodLevels.h>

#include <osg/Camera>
#include <osg/Group>
#include <osg/Matrix>
#include <osg/Vec4>
#include <osgUtil/CullVisitor>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <string>

namespace osgGpuAnimation
{

/// The levels of detail that some meshes have triangles for, from the finest to the coarsest of all: what is drawn at
/// levels beyond is the same, so those need not be told apart.
class LodRange
{
public:
    /// Vertices of a group's meshes together that levels are made of: meshes that come later are drawn whole, unless
    /// another group shows them too.
    static constexpr std::size_t mostVertices = 10 * LodLevels::mostVertices;
    static constexpr int largestPixelError = 1'000'000;

    /// What setPixelError() of characters and crowds takes.
    static bool isPixelError(double pixels) { return pixels >= 0.0 && pixels <= largestPixelError; }
    /// In words: what it must be.
    static std::string pixelErrorsTaken();
    /// Makes the levels of the SkinnedGeometry among a group's children that are drawn with that pixel error: none
    /// where it is 0, or the set has nothing to draw. Error: it is no pixel error.
    static Result<bool> prepare(float pixels, const osg::Group& meshes, const AnimationSet& set);

    LodRange() = default;
    /// Of the SkinnedGeometry among a group's children; makes levels where there are none yet. Nothing else does:
    /// what else is drawn at a level is drawn whole.
    LodRange(const osg::Group& meshes, const AnimationSet& set);

    int held(int level) const
    {
        return level < _finest ? LodLevels::allTriangles : level > _coarsest ? _coarsest : level;
    }

private:
    int _finest = std::numeric_limits<int>::max();
    int _coarsest = LodLevels::allTriangles;
};

/// How large things are in the picture that levels of detail go by: what is being culled for; or, while that is an
/// absolute camera for depths alone (see DepthPass), the picture of the camera above it, for which it is taken to be a
/// shadow map. Which that is, and where from, is the same for all that a camera sees: it is kept until another one's
/// turn. Of one cull visitor.
class LodView
{
public:
    /// At the beginning of a cull traversal: cameras may have moved.
    void clear() { _projection = nullptr; }

    /// As osg::CullingSet::getPixelSizeVector(), for where the visitor is now. OSG divides a radius by the vector's
    /// product with the place and has a diameter in pixels.
    osg::Vec4 pixelSizeVector(osgUtil::CullVisitor& visitor);

private:
    void find(osgUtil::CullVisitor& visitor);

    osg::ref_ptr<const osg::RefMatrix> _projection; ///< what it was found for: each camera culled for has one anew
    const osg::Camera* _culled = nullptr;           ///< likewise
    const osg::Camera* _eye = nullptr;              ///< null: the picture is that of what is culled for
    const osg::Viewport* _viewport = nullptr;       ///< the eye's
    osg::Matrix _toEye;                             ///< from the space of the camera that is culled for
};

/// Which of the LodLevels a camera needs of what it sees: those whose error is at most so many pixels there, in
/// small feature culling's measure. Shadow maps (see LodView) show the levels of the camera that they are for: were
/// the surface that casts a shadow finer than the one that is lit, this would lie in it here and there. What lies
/// behind that camera's eye is not lit in its picture, and has the levels of the shadow map's own camera. Lives as long
/// as the traversal is in that space.
class LodScale
{
public:
    /// pixelError: pixels; 0: all triangles. range: of what is drawn.
    LodScale(osgUtil::CullVisitor& visitor, LodView& view, float pixelError, const LodRange& range);

    /// centre, radius: of what is drawn, in the visitor's space. scale: units of that space to one of the
    /// character's own. The nearest point decides; what reaches behind the eye has all triangles.
    int level(const glm::vec3& centre, float radius, float scale) const;

    /// Whether there is more than one.
    bool isOn() const { return _seen.errorAt != glm::vec4(0.0f); }

private:
    /// How far off what a camera sees may be drawn, by where it is in the visitor's space.
    struct Measure
    {
        glm::vec4 errorAt{0.0f}; ///< · (x, y, z, 1); below 0 behind the eye
        float slope = 0.0f;      ///< what that changes by for a step of 1, at most

        Measure() = default;
        Measure(const osg::Vec4& halfPixel, float pixelError);
        float at(const glm::vec3& place) const { return glm::dot(errorAt, glm::vec4(place, 1.0f)); }
        float nearest(const glm::vec3& centre, float radius) const { return at(centre) - slope * radius; }
        float farthest(const glm::vec3& centre, float radius) const { return at(centre) + slope * radius; }
    };

    LodRange _range;
    Measure _seen; ///< of the picture that levels go by
    Measure _own;  ///< of the camera that is culled for
};

} // namespace osgGpuAnimation
