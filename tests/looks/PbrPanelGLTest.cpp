// SPDX-License-Identifier: MIT
#include "looks/PbrPanelGLTest.h"

#include "looks/Panel.h"

#include <osgGpuAnimation/looks/CharacterProgram.h>

#include <layout.glsl>

#include <osg/FrontFace>
#include <osg/LightSource>
#include <osg/MatrixTransform>

#include <algorithm>

namespace osgGpuAnimation
{

osg::ref_ptr<osg::Texture2D> texels(int width, int height, const std::function<osg::Vec4(int, int)>& value)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    for (int texel = 0; texel < width * height; ++texel)
        image->setColor(value(texel % width, texel / width), texel % width, texel / width);
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(image);
    texture->setInternalFormat(GL_RGBA8);
    for (const auto filter : {osg::Texture::MIN_FILTER, osg::Texture::MAG_FILTER})
        texture->setFilter(filter, osg::Texture::NEAREST);
    for (const auto wrap : {osg::Texture::WRAP_S, osg::Texture::WRAP_T})
        texture->setWrap(wrap, osg::Texture::REPEAT);
    return texture;
}

osg::ref_ptr<osg::Texture2D> plainTexture(const osg::Vec4& value, bool isColor)
{
    osg::ref_ptr<osg::Texture2D> texture = texels(2, 2, [&](int, int) { return value; });
    if (isColor) texture->setInternalFormat(GL_SRGB8_ALPHA8);
    return texture;
}

float encoded(double linear)
{
    return displayColor(osg::Vec4(static_cast<float>(linear), 0, 0, 1)).r();
}

PbrMaterial dielectric(float base)
{
    PbrMaterial material;
    material.baseColor.set(base, base, base, 1);
    material.metallic = 0.0f;
    return material;
}

osg::Geometry* findGeometry(osg::Node& node)
{
    if (auto* const geometry = dynamic_cast<osg::Geometry*>(&node)) return geometry; // a SkinnedGeometry too
    osg::Group* const group = node.asGroup();
    for (unsigned int i = 0; group && i < group->getNumChildren(); ++i)
        if (osg::Geometry* const found = findGeometry(*group->getChild(i))) return found;
    return nullptr;
}

osg::ref_ptr<osg::Vec4Array> attribute(const osg::Geometry& mesh, const osg::Vec4& value)
{
    osg::ref_ptr<osg::Vec4Array> array = new osg::Vec4Array(osg::Array::BIND_PER_VERTEX);
    array->assign(mesh.getVertexArray()->getNumElements(), value);
    return array;
}

void setCoordinates(osg::Geometry& mesh, const osg::Vec2& first, const osg::Vec4& further)
{
    auto& places = static_cast<osg::Vec2Array&>(*mesh.getTexCoordArray(0));
    std::fill(places.begin(), places.end(), first);
    mesh.setVertexAttribArray(POSE_COORDINATES_LOCATION, attribute(mesh, further));
}

osg::ref_ptr<osg::Node> pbrPanel(bool isMoving, PbrMaterial material, const osg::Vec3& scale, const osg::Vec4& tangent)
{
    osg::ref_ptr<AnimatedCharacter> character = makePanelCharacter();
    osg::ref_ptr<osg::MatrixTransform> root = new osg::MatrixTransform(osg::Matrix::scale(scale));
    osg::ref_ptr<osg::Node> subject = isMoving ? osg::ref_ptr<osg::Node>(character) : makeBaked(*character);
    osg::Geometry& mesh = *findGeometry(*subject);
    mesh.setStateSet(new osg::StateSet);
    osg::StateSet& state = *mesh.getStateSet();
    if (tangent.w() != 0.0f) mesh.setVertexAttribArray(POSE_TANGENT_LOCATION, attribute(mesh, tangent));
    material.hasTangents = tangent.w() != 0.0f;
    applyPbrMaterial(state, material);
    if (isMoving)
        applyCharacterProgram(state);
    else
        applySurfaceProgram(state, true);
    if (scale.x() * scale.y() * scale.z() < 0.0f)
        state.setAttributeAndModes(new osg::FrontFace(osg::FrontFace::CLOCKWISE));
    root->addChild(subject);
    return root;
}

void keepFront(osg::Node& panel)
{
    auto& indices = static_cast<osg::DrawElementsUShort&>(*findGeometry(panel)->getPrimitiveSet(0));
    indices.resize(indices.size() / 2);
}

osg::ref_ptr<osg::Node> frontOfPanel(const PbrMaterial& material, const osg::Vec3& normal)
{
    const osg::ref_ptr<osg::Node> panel = pbrPanel(false, material);
    keepFront(*panel);
    auto& normals = static_cast<osg::Vec3Array&>(*findGeometry(*panel)->getNormalArray());
    std::fill(normals.begin(), normals.end(), normal);
    osg::ref_ptr<osg::MatrixTransform> place =
        new osg::MatrixTransform(osg::Matrix::translate(-panel->getBound().center()));
    place->addChild(panel);
    return place;
}

PbrPanelGLTest::PbrPanelGLTest()
{
    setDirection({0.3f, -1.0f, 0.5f});
    light->setAmbient(osg::Vec4(0, 0, 0, 1));
    setLight(0.7f);
    setSurrounding(0.2f);
}

osg::ref_ptr<osg::Image> PbrPanelGLTest::pictureOf(osg::Node* subject, osg::Group* group)
{
    const osg::ref_ptr<osg::Group> root = group;
    root->addChild(subject);
    osg::StateSet& state = *root->getOrCreateStateSet();
    state.setMode(GL_LIGHTING, osg::StateAttribute::ON);
    const osg::ref_ptr<osg::LightSource> source = new osg::LightSource; // an attribute alone moves with each mesh
    source->setLight(light);
    source->setStateSetModes(state, osg::StateAttribute::ON);
    root->addChild(source);
    state.setAttribute(surrounding);
    viewer().setLightingMode(osg::View::NO_LIGHT);
    viewer().getCamera()->setClearColor({0, 0, 1, 1});
    osg::ref_ptr<osg::Image> image = ViewerGLTest::pictureOf(root, {0.0});
    EXPECT_NO_GL_ERROR();
    return image;
}

osg::Vec4 PbrPanelGLTest::colorOf(osg::Node* subject, osg::Group* group)
{
    const osg::ref_ptr<osg::Image> image = pictureOf(subject, group);
    double sumX = 0, sumY = 0, count = 0;
    for (int y = 0; y < image->t(); ++y)
        for (int x = 0; x < image->s(); ++x)
            if (image->getColor(x, y) != osg::Vec4(0, 0, 1, 1)) sumX += x, sumY += y, count += 1;
    EXPECT_GT(count, 20);
    const int x = static_cast<int>(sumX / std::max(count, 1.0)), y = static_cast<int>(sumY / std::max(count, 1.0));
    position.set((x + 0.5) * 8 / image->s() - 4, (y + 0.5) * 8 / image->t() - 4, -10);
    return image->getColor(x, y);
}

} // namespace osgGpuAnimation
