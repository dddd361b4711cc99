// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Matrixd>
#include <osg/MatrixTransform>
#include <osg/Shape>

namespace osgGpuAnimation
{

/// Masks of nodes below makeSunlight(); other nodes do both.
constexpr osg::Node::NodeMask receivesShadow = 1, castsShadow = 2;

/// Draws the node with a dull, even material. color: sRGB, in [0, 1]. emission: linear radiance.
void applyMaterial(osg::Node& node, const osg::Vec4& color, const osg::Vec3& emission = {});
/// A shape of OSG in that material. place: from the shape's space to the parent's.
osg::ref_ptr<osg::MatrixTransform> makePart(osg::Shape* shape, const osg::Vec4& color,
                                            const osg::Matrixd& place = osg::Matrixd(), const osg::Vec3& emission = {});

/// A lantern of 0.3 m around its glass, in which a light glows.
osg::ref_ptr<osg::Group> makeLantern();
/// A bird around its middle with a span of 1.3 m, which flies towards -Y.
osg::ref_ptr<osg::Group> makeBird();
/// A ramp of 0.72 x 0.7 m around its middle, in stripes, which rises towards +X. angle: radians.
osg::ref_ptr<osg::Group> makeRamp(double angle, const osg::Vec3d& middle);

/// Lights its children by a sun, with the shadows of those whose mask contains castsShadow. towards: the direction to
/// the sun.
osg::ref_ptr<osg::Group> makeSunlight(const osg::Vec3& towards);

} // namespace osgGpuAnimation
