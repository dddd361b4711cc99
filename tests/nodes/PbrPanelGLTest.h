// SPDX-License-Identifier: MIT
#pragma once

#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/looks/PbrMaterial.h>

#include <osg/Geometry>
#include <osg/Light>
#include <osg/LightModel>

namespace osgGpuAnimation
{

/// A picture of one colour. value: as stored, in [0, 1].
osg::ref_ptr<osg::Texture2D> plainTexture(const osg::Vec4& value, bool isColor = false);

/// A linear number as displayed.
float encoded(double linear);

/// The first geometry at or below the node; null if there is none.
osg::Geometry* findGeometry(osg::Node& node);

/// One vector for each vertex.
osg::ref_ptr<osg::Vec4Array> attribute(const osg::Geometry& mesh, const osg::Vec4& value);

/// The panel of makePanelCharacter(), moved by the palette or as plain geometry, with that material. scale: of the node
/// above. tangent: w 0: none.
osg::ref_ptr<osg::Node> pbrPanel(bool isMoving, PbrMaterial material, const osg::Vec3& scale = {1, 1, 1},
                                 const osg::Vec4& tangent = {});

/// Such panels under one light and an even surrounding.
class PbrPanelGLTest : public ViewerGLTest
{
protected:
    PbrPanelGLTest();

    osg::ref_ptr<osg::Image> pictureOf(osg::Node* subject, osg::Group* group = new osg::Group);

    /// The pixel in the middle of what is drawn; the background is blue. Its place in eye space goes to `position`.
    osg::Vec4 middle(const osg::Image& image);

    osg::ref_ptr<osg::Light> light = new osg::Light(0);
    osg::ref_ptr<osg::LightModel> surrounding = new osg::LightModel;
    osg::Vec3d position; ///< of the pixel that middle() found, in eye space
};

} // namespace osgGpuAnimation
