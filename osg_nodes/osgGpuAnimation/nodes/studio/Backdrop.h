// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Geometry>
#include <osgUtil/CullVisitor>

#include <optional>

namespace osgGpuAnimation
{

class KeyShadow;

/// The ground below a model.
struct Ground
{
    osg::Vec3d middle;   ///< below the model's middle, in the studio's space
    double unit = 1.0;   ///< the model's radius: the ground is light around it, and fades into the backdrop beyond
    double height = 1.0; ///< the model's, above 0
    double shade = 0.0;  ///< the share of the light that the shadow takes away, in [0, 1]
};

/// A rectangle behind everything: a gradient, and a ground in it, which receives the shadow of the key light. One draw
/// fills the picture, and its fragment shader finds the ground by a ray for each pixel: the ground has no edge, does
/// not move near and far planes, and hides no part of a model that reaches below it.
class Backdrop
{
public:
    Backdrop();

    /// Culls the rectangle for the visitor's camera, below every other node. ground: none: the gradient alone.
    void cull(osgUtil::CullVisitor& visitor, const std::optional<Ground>& ground, const KeyShadow& shadow) const;

    osg::Geometry& getDrawable() const { return *_rectangle; } ///< for GL objects

private:
    osg::ref_ptr<osg::Geometry> _rectangle;
};

} // namespace osgGpuAnimation
