// SPDX-License-Identifier: MIT
#include "Props.h"

#include <osgGpuAnimation/looks/CharacterProgram.h>
#include <osgGpuAnimation/looks/PbrMaterial.h>

#include <osg/LightSource>
#include <osg/Math>
#include <osg/ShapeDrawable>
#include <osgShadow/ShadowedScene>
#include <osgShadow/ShadowMap>

#include <cmath>

namespace osgGpuAnimation
{

namespace
{

osg::Matrixd turned(double degrees, const osg::Vec3d& axis)
{
    return osg::Matrixd::rotate(osg::DegreesToRadians(degrees), axis);
}

} // namespace

void applyMaterial(osg::Node& node, const osg::Vec4& color, const osg::Vec3& emission)
{
    PbrMaterial material;
    material.baseColor = linearColor(color);
    material.metallic = 0.0f;
    material.roughness = 0.8f;
    material.emissive = emission;
    applyPbrMaterial(*node.getOrCreateStateSet(), material);
    applySurfaceProgram(*node.getOrCreateStateSet(), false);
}

osg::ref_ptr<osg::MatrixTransform> makePart(osg::Shape* shape, const osg::Vec4& color, const osg::Matrixd& place,
                                            const osg::Vec3& emission)
{
    const osg::ref_ptr<osg::MatrixTransform> part = new osg::MatrixTransform(place);
    part->addChild(new osg::ShapeDrawable(shape));
    applyMaterial(*part, color, emission);
    return part;
}

osg::ref_ptr<osg::Group> makeLantern()
{
    const osg::Vec4 brass(0.62f, 0.42f, 0.16f, 1.0f);
    const osg::ref_ptr<osg::Group> lantern = new osg::Group;
    lantern->addChild(makePart(new osg::Sphere({0, 0, 0}, 0.066f), {1.0f, 0.75f, 0.3f, 1.0f}, {}, {2.4f, 1.1f, 0.15f}));
    lantern->addChild(makePart(new osg::Cylinder({0, 0, -0.095f}, 0.085f, 0.03f), brass));
    lantern->addChild(makePart(new osg::Cone({0, 0, 0.1f}, 0.11f, 0.09f), brass));
    lantern->addChild(makePart(new osg::Sphere({0, 0, 0.175f}, 0.022f), brass));
    constexpr int bars = 6;
    for (int i = 0; i < bars; ++i)
    {
        const double angle = 2.0 * osg::PI * i / bars;
        const osg::Vec3d place(0.075 * std::cos(angle), 0.075 * std::sin(angle), -0.005);
        lantern->addChild(makePart(new osg::Cylinder(place, 0.007f, 0.18f), brass));
    }
    return lantern;
}

osg::ref_ptr<osg::Group> makeBird()
{
    const osg::Vec4 red(0.85f, 0.16f, 0.1f, 1.0f), dark(0.55f, 0.08f, 0.08f, 1.0f), yellow(0.95f, 0.7f, 0.1f, 1.0f);
    const osg::Matrixd lengthwise = turned(90.0, {1, 0, 0}); // from +Z to -Y
    const osg::ref_ptr<osg::Group> bird = new osg::Group;
    bird->addChild(makePart(new osg::Capsule({0, 0, 0}, 0.1f, 0.2f), red, lengthwise));
    bird->addChild(makePart(new osg::Sphere({0, -0.23f, 0.06f}, 0.085f), red));
    bird->addChild(makePart(new osg::Cone({0, -0.06f, 0.3f}, 0.035f, 0.12f), yellow, lengthwise));
    for (const double side : {-1.0, 1.0})
    {
        // Flat cones, whose points are the tips of the wings.
        bird->addChild(makePart(new osg::Cone({0, 0, 0.15f}, 0.17f, 0.6f), dark,
                                osg::Matrixd::scale(0.12, 1.0, 1.0) * turned(65.0 * side, {0, 1, 0})));
        bird->addChild(makePart(new osg::Sphere({0, 0, 0}, 0.018f), {0.02f, 0.02f, 0.02f, 1.0f},
                                osg::Matrixd::translate(0.055 * side, -0.285, 0.09)));
    }
    bird->addChild(
        makePart(new osg::Cone({0, 0, -0.33f}, 0.13f, 0.4f), dark, osg::Matrixd::scale(1.0, 0.15, 1.0) * lengthwise));
    return bird;
}

osg::ref_ptr<osg::Group> makeRamp(double angle, const osg::Vec3d& place)
{
    constexpr int stripes = 8;
    constexpr double length = 0.72, thickness = 0.3, stripe = length / stripes;
    const osg::Matrixd rising = osg::Matrixd::rotate(-angle, osg::Vec3d(0, 1, 0)) * osg::Matrixd::translate(place);
    const osg::ref_ptr<osg::Group> ramp = new osg::Group;
    for (int i = 0; i < stripes; ++i)
    {
        const osg::Vec3d middle((i + 0.5) * stripe - length / 2.0, 0.0, -thickness / 2.0);
        ramp->addChild(makePart(new osg::Box(middle, static_cast<float>(stripe), 0.7f, static_cast<float>(thickness)),
                                i % 2 == 0 ? osg::Vec4(0.3f, 0.5f, 0.55f, 1.0f) : osg::Vec4(0.75f, 0.82f, 0.8f, 1.0f),
                                rising));
    }
    return ramp;
}

osg::ref_ptr<osg::Group> makeSunlight(const osg::Vec3& towards)
{
    const osg::ref_ptr<osg::LightSource> sun = new osg::LightSource;
    sun->getLight()->setLightNum(1);
    sun->getLight()->setPosition(osg::Vec4(towards, 0.0f));
    sun->getLight()->setDiffuse(osg::Vec4(0.9f, 0.85f, 0.75f, 1.0f));
    const osg::ref_ptr<osgShadow::ShadowMap> shadow = new osgShadow::ShadowMap;
    shadow->setLight(sun);
    shadow->setTextureSize(osg::Vec2s(2048, 2048));
    shadow->setAmbientBias(osg::Vec2(0.0f, 1.0f));
    const osg::ref_ptr<osgShadow::ShadowedScene> scene = new osgShadow::ShadowedScene(shadow);
    scene->setReceivesShadowTraversalMask(receivesShadow);
    scene->setCastsShadowTraversalMask(castsShadow);
    scene->addChild(sun);
    sun->setStateSetModes(*scene->getOrCreateStateSet(), osg::StateAttribute::ON);
    return scene;
}

} // namespace osgGpuAnimation
