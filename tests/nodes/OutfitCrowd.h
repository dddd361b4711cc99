// SPDX-License-Identifier: MIT
#pragma once

#include "support/Results.h"
#include "support/TestCrowd.h"

#include <osgGpuAnimation/mesh/geometry/MaterialVariants.h>
#include <osgGpuAnimation/nodes/Outfit.h>

#include <osg/Geode>
#include <osg/ShapeDrawable>
#include <osg/Texture2D>

#include <algorithm>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// A picture of one colour.
inline osg::ref_ptr<osg::Image> makePicture(unsigned char red, unsigned char green, unsigned char blue)
{
    osg::ref_ptr<osg::Image> picture = new osg::Image;
    picture->allocateImage(1, 1, 1, GL_RGB, GL_UNSIGNED_BYTE);
    const unsigned char texel[] = {red, green, blue};
    std::copy_n(texel, 3, picture->data());
    return picture;
}

/// A repeated texture of that picture.
inline osg::ref_ptr<osg::Texture2D> makeTexture(osg::Image* picture)
{
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(picture);
    texture->setWrap(osg::Texture::WRAP_S, osg::Texture::REPEAT);
    texture->setWrap(osg::Texture::WRAP_T, osg::Texture::REPEAT);
    return texture;
}

/// The test character in parts: "front", of the material "cloth", which has the variant "winter" in yellow, and "side",
/// of the material "leather". Both are white squares.
inline osg::ref_ptr<AnimatedCharacter> makeDressedCharacter()
{
    osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    character->addChild(makeTestSquare(2));
    const char* const names[][2] = {{"front", "cloth"}, {"side", "leather"}};
    for (unsigned int i = 0; i < 2; ++i)
    {
        character->getChild(i)->setName(names[i][0]);
        character->getChild(i)->getStateSet()->setName(names[i][1]);
    }
    osg::Geometry& front = dynamic_cast<SkinnedGeometry&>(*character->getChild(0));
    const osg::ref_ptr<osg::StateSet> winter = osg::clone(front.getStateSet(), osg::CopyOp::SHALLOW_COPY);
    winter->setTextureAttributeAndModes(0, makeTexture(makePicture(255, 255, 0)));
    setVariantStates(front, front.getStateSet(), {{"winter", winter}});
    setVariantNames(*character, {"winter"});
    character->computeClipBounds();
    return character;
}

/// A cube with an edge of half a unit.
inline osg::ref_ptr<osg::Node> makeBox()
{
    osg::ref_ptr<osg::ShapeDrawable> box = new osg::ShapeDrawable(new osg::Box(osg::Vec3(), 0.5f));
    box->setName("box");
    return box;
}

/// Changes an outfit.
using Dress = void (*)(Outfit&);

inline osg::ref_ptr<Outfit> makeOutfit(Dress dress, const std::string& name = "outfit")
{
    osg::ref_ptr<Outfit> outfit = new Outfit;
    outfit->setName(name);
    dress(*outfit);
    return outfit;
}

} // namespace osgGpuAnimation
