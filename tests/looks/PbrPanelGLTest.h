// SPDX-License-Identifier: MIT
#pragma once

#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/looks/PbrMaterial.h>

#include <osg/Geometry>
#include <osg/Light>
#include <osg/LightModel>

#include <functional>

namespace osgGpuAnimation
{

/// A picture of texels with sharp borders. value: of a column and a row, as stored, in [0, 1].
osg::ref_ptr<osg::Texture2D> texels(int width, int height, const std::function<osg::Vec4(int, int)>& value);
/// A picture of one colour. value: as stored, in [0, 1].
osg::ref_ptr<osg::Texture2D> plainTexture(const osg::Vec4& value, bool isColor = false);

/// A linear number as displayed.
float encoded(double linear);

/// Grey, and no metal.
PbrMaterial dielectric(float base = 1.0f);

/// The first geometry at or below the node; null if there is none.
osg::Geometry* findGeometry(osg::Node& node);

/// One vector for each vertex.
osg::ref_ptr<osg::Vec4Array> attribute(const osg::Geometry& mesh, const osg::Vec4& value);

/// Sets the texture coordinates of all vertices. further: numbers 1 and 2.
void setCoordinates(osg::Geometry& mesh, const osg::Vec2& first, const osg::Vec4& further);

/// The panel of makePanelCharacter(), moved by the palette or as plain geometry, with that material. scale: of the node
/// above. tangent: w 0: none.
osg::ref_ptr<osg::Node> pbrPanel(bool isMoving, PbrMaterial material, const osg::Vec3& scale = {1, 1, 1},
                                 const osg::Vec4& tangent = {});
/// Removes the panel's back side.
void keepFront(osg::Node& panel);
/// The front side in the middle of the picture, as plain geometry.
osg::ref_ptr<osg::Node> frontOfPanel(const PbrMaterial& material, const osg::Vec3& normal = {0, -1, 0});

/// Such panels under one light and an even surrounding.
class PbrPanelGLTest : public ViewerGLTest
{
protected:
    PbrPanelGLTest();

    void setLight(float diffuse) { light->setDiffuse(osg::Vec4(diffuse, diffuse, diffuse, 1)); }
    /// towards: the world's axes.
    void setDirection(const osg::Vec3& towards) { light->setPosition(osg::Vec4(towards, 0)); }
    void setSurrounding(float ambient) { surrounding->setAmbientIntensity(osg::Vec4(ambient, ambient, ambient, 1)); }

    osg::ref_ptr<osg::Image> pictureOf(osg::Node* subject, osg::Group* group = new osg::Group);

    /// The pixel in the middle of what is drawn. Its place in eye space goes to `position`.
    osg::Vec4 colorOf(osg::Node* subject, osg::Group* group = new osg::Group);
    osg::Vec4 colorOf(const PbrMaterial& material) { return colorOf(pbrPanel(true, material)); }

    osg::ref_ptr<osg::Light> light = new osg::Light(0);
    osg::ref_ptr<osg::LightModel> surrounding = new osg::LightModel;
    osg::Vec3d position; ///< of the pixel that colorOf() found, in eye space
};

} // namespace osgGpuAnimation
