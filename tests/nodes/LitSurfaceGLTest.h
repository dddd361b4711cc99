// SPDX-License-Identifier: MIT
#pragma once

#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <osg/Geometry>

namespace osgGpuAnimation
{

/// Sets a uniform of the character's program to true.
void setUniform(osg::Geometry& mesh, const char* name);

osg::ref_ptr<osg::Vec4Array> one(const osg::Vec4& color);

/// Characters under one light, as the fixed pipeline shades them.
class LitSurfaceGLTest : public ViewerGLTest
{
protected:
    int pictureSide() const override { return 128; }

    osg::ref_ptr<osg::Group> lit(osg::Node* subject);
    osg::ref_ptr<osg::Image> pictureOf(osg::Node* subject) { return ViewerGLTest::pictureOf(lit(subject), {0.0}); }

    static osg::Geometry& meshOf(AnimatedCharacter& character)
    {
        return static_cast<osg::Geometry&>(*character.getChild(0));
    }
};

} // namespace osgGpuAnimation
