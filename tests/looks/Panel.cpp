// SPDX-License-Identifier: MIT
#include "looks/Panel.h"
#include "support/TestCharacter.h"

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/looks/CharacterProgram.h>

#include <osg/Image>
#include <osg/Material>
#include <osg/Texture2D>

namespace osgGpuAnimation
{

namespace
{

constexpr unsigned int quads = 16;

osg::ref_ptr<osg::Texture2D> makeStripes()
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(2, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    image->setColor(osg::Vec4(1, 1, 0, 1), 0, 0);
    image->setColor(osg::Vec4(0, 1, 1, 1), 1, 0);
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(image);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
    texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
    texture->setWrap(osg::Texture::WRAP_S, osg::Texture::REPEAT);
    return texture;
}

void setSurface(osg::StateSet& state)
{
    osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setAmbient(osg::Material::FRONT_AND_BACK, osg::Vec4(0.8f, 0.8f, 0.8f, 1));
    material->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(0.8f, 0.8f, 0.8f, 1));
    state.setAttribute(material);
    state.setTextureAttributeAndModes(0, makeStripes());
}

/// Adds one side of the panel: its vertices and triangles.
void addSide(bool isBack, osg::Vec3Array& positions, osg::Vec3Array& normals, osg::Vec2Array& coordinates,
             osg::DrawElementsUShort& indices)
{
    const auto first = static_cast<unsigned int>(positions.size());
    for (unsigned int row = 0; row <= quads; ++row)
        for (unsigned int column = 0; column <= quads; ++column)
        {
            const osg::Vec2 place(float(column) / quads, float(row) / quads);
            coordinates.push_back(place);
            positions.push_back(osg::Vec3(2 * place.x() - 1, isBack ? 0.2f : 0.0f, 2 * place.y() - 1));
            normals.push_back(osg::Vec3(0, isBack ? 1 : -1, 0));
            if (row == quads || column == quads) continue;
            const unsigned int corner = first + row * (quads + 1) + column;
            const unsigned int right = corner + (isBack ? quads + 1 : 1);
            const unsigned int up = corner + (isBack ? 1 : quads + 1);
            for (const unsigned int index : {corner, right, corner + quads + 2, corner, corner + quads + 2, up})
                indices.push_back(static_cast<GLushort>(index));
        }
}

void setArrays(osg::Geometry& mesh)
{
    osg::ref_ptr<osg::Vec3Array> positions = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array(osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::Vec2Array> coordinates = new osg::Vec2Array;
    osg::ref_ptr<osg::DrawElementsUShort> indices = new osg::DrawElementsUShort(GL_TRIANGLES);
    for (const bool isBack : {false, true})
        addSide(isBack, *positions, *normals, *coordinates, *indices);
    mesh.setVertexArray(positions);
    mesh.setNormalArray(normals);
    mesh.setTexCoordArray(0, coordinates, osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array(osg::Array::BIND_PER_VERTEX, positions->getNumElements());
    std::fill(colors->begin(), colors->end(), osg::Vec4(1, 1, 1, 1));
    mesh.setColorArray(colors);
    mesh.addPrimitiveSet(indices);
}

osg::ref_ptr<osg::Geometry> baked(const SkinnedGeometry& mesh, const std::vector<AffineMatrix>& palette)
{
    std::vector<glm::dvec3> computed;
    mesh.computePositions(palette, computed);
    osg::ref_ptr<osg::Vec3Array> positions = new osg::Vec3Array;
    for (const glm::dvec3& position : computed)
        positions->push_back(osg::Vec3(osg::Vec3d(position.x, position.y, position.z)));
    osg::ref_ptr<osg::Geometry> result = new osg::Geometry;
    setArrays(*result);
    result->setVertexArray(positions);
    setSurface(*result->getOrCreateStateSet());
    return result;
}

} // namespace

osg::ref_ptr<AnimatedCharacter> makePanelCharacter()
{
    osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    osg::ref_ptr<SkinnedGeometry> panel = new SkinnedGeometry;
    setArrays(*panel);
    panel->setRigidEntry(static_cast<unsigned short>(testCharacterSet()->entryOfRigidJoint(1)));
    setSurface(*panel->getOrCreateStateSet());
    applyCharacterProgram(*panel->getOrCreateStateSet());
    applySkinDefines(*panel->getOrCreateStateSet(), 1, false);
    character->removeChildren(0, character->getNumChildren());
    character->addChild(panel);
    character->computeClipBounds();
    return character;
}

osg::ref_ptr<osg::Node> makeBaked(const AnimatedCharacter& character)
{
    std::vector<AffineMatrix> palette;
    Pose::evaluate(character.getAnimationSet(), character.getController().instruction(), AffineMatrix(), palette);
    osg::ref_ptr<osg::MatrixTransform> result = new osg::MatrixTransform(character.getMatrix());
    for (unsigned int i = 0; i < character.getNumChildren(); ++i)
        if (const auto* mesh = dynamic_cast<const SkinnedGeometry*>(character.getChild(i)))
            result->addChild(baked(*mesh, palette));
    return result;
}

} // namespace osgGpuAnimation
