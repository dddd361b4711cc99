// SPDX-License-Identifier: MIT
#pragma once

#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <osg/Geometry>
#include <osg/LightModel>
#include <osg/LightSource>

namespace osgGpuAnimation
{

// Of pictures beside the fixed pipeline, which lights per vertex.
constexpr int edgePixels = 40;
constexpr float tolerance = 0.03f;

/// Sets a uniform of the character's program to true.
inline void setUniform(osg::Geometry& mesh, const char* name)
{
    mesh.getOrCreateStateSet()->getOrCreateUniform(name, osg::Uniform::BOOL)->set(true);
}

inline osg::ref_ptr<osg::Vec4Array> one(const osg::Vec4& color)
{
    return new osg::Vec4Array(1, &color);
}

/// Characters under one light, as the fixed pipeline shades them.
class LitSurfaceGLTest : public ViewerGLTest
{
protected:
    int pictureSide() const override { return 128; }

    osg::ref_ptr<osg::Group> lit(osg::Node* subject)
    {
        osg::ref_ptr<osg::LightSource> root = new osg::LightSource;
        root->addChild(subject);
        osg::ref_ptr<osg::Light> light = new osg::Light(0);
        light->setPosition(osg::Vec4(-0.3f, -1.0f, 0.4f, 0.0f));
        light->setAmbient(osg::Vec4(0.05f, 0.05f, 0.05f, 1));
        light->setDiffuse(osg::Vec4(0.6f, 0.5f, 0.7f, 1));
        light->setSpecular(osg::Vec4(1, 1, 1, 1));
        osg::ref_ptr<osg::LightModel> model = new osg::LightModel;
        model->setLocalViewer(true); // as in the kit: eye-dependent highlights, added after texturing
        model->setColorControl(osg::LightModel::SEPARATE_SPECULAR_COLOR);
        root->setLight(light); // also sets the light's mode
        osg::StateSet& state = *root->getOrCreateStateSet();
        state.setMode(GL_LIGHTING, osg::StateAttribute::ON);
        state.setAttributeAndModes(model);
        viewer().setLightingMode(osg::View::NO_LIGHT);
        return root;
    }
    osg::ref_ptr<osg::Image> pictureOf(osg::Node* subject) { return ViewerGLTest::pictureOf(lit(subject), {0.0}); }

    static osg::Geometry& meshOf(AnimatedCharacter& character)
    {
        return static_cast<osg::Geometry&>(*character.getChild(0));
    }
};

} // namespace osgGpuAnimation
