// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/DetailRange.h>

#include <osgUtil/CullVisitor>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace osgGpuAnimation
{

/// Which of the DetailLevels a camera needs of what it sees: those whose error is at most so many pixels there, in
/// small feature culling's measure. Shadow maps (see DepthPass) show the levels of the camera that they are for: were
/// the surface that casts a shadow finer than the one that is lit, this would lie in it here and there. Lives as long
/// as the traversal is in that space.
class DetailScale
{
public:
    /// pixelError: pixels; 0: all triangles. range: of what is drawn.
    DetailScale(osgUtil::CullVisitor& visitor, float pixelError, const DetailRange& range);

    /// centre, radius: of what is drawn, in the visitor's space. scale: units of that space to one of the
    /// character's own. The nearest point decides; what reaches behind the eye has all triangles.
    int level(const glm::vec3& centre, float radius, float scale) const;

    /// Whether there is more than one.
    bool isOn() const { return _errorAt != glm::vec4(0.0f); }

private:
    DetailRange _range;
    glm::vec4 _errorAt{0.0f}; ///< · (x, y, z, 1): how far off a point there may be drawn, in the visitor's space
    float _slope = 0.0f;      ///< what that changes by for a step of 1, at most
};

} // namespace osgGpuAnimation
