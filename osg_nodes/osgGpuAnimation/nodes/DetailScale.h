// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/DetailRange.h>
#include <osgGpuAnimation/nodes/DetailView.h>

#include <osgUtil/CullVisitor>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace osgGpuAnimation
{

/// Which of the DetailLevels a camera needs of what it sees: those whose error is at most so many pixels there, in
/// small feature culling's measure. Shadow maps (see DetailView) show the levels of the camera that they are for: were
/// the surface that casts a shadow finer than the one that is lit, this would lie in it here and there. What lies
/// behind that camera's eye is not lit in its picture, and has the levels of the shadow map's own camera. Lives as long
/// as the traversal is in that space.
class DetailScale
{
public:
    /// pixelError: pixels; 0: all triangles. range: of what is drawn.
    DetailScale(osgUtil::CullVisitor& visitor, DetailView& view, float pixelError, const DetailRange& range);

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

    DetailRange _range;
    Measure _seen; ///< of the picture that levels go by
    Measure _own;  ///< of the camera that is culled for
};

} // namespace osgGpuAnimation
