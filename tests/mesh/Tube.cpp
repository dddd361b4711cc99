// SPDX-License-Identifier: MIT
#include "mesh/Tube.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>
#include <osgGpuAnimation/looks/CharacterProgram.h>

#include <gtest/gtest.h>

#include <cmath>
#include <type_traits>

namespace osgGpuAnimation
{

std::shared_ptr<const AnimationSet> armSet(bool hasMorph)
{
    JointTransform elbow;
    elbow.translation.x = 4.0f;
    AnimationParts parts{Skeleton::create({{"shoulder", -1, {}, 0}, {"elbow", 0, elbow, 1}}).value(), {}, {}, {}, {}};
    AffineMatrix fromModel;
    fromModel.rows[0].w = -4.0f;
    parts.skins.push_back({"arm", {0, 1}, {AffineMatrix(), fromModel}});
    if (hasMorph) parts.morphs.push_back({"thick", -1, {0.0f}});
    ClipBuilder builder(parts.skeleton, parts.morphs);
    const double half = std::sqrt(0.5);
    EXPECT_TRUE(builder.add(
        {Channel::Path::Rotation, Channel::Interpolation::Linear, 1, {0, 1}, {0, 0, 0, 1, 0, 0, half, half}}));
    if (hasMorph)
    {
        EXPECT_TRUE(builder.add({Channel::Path::Weights, Channel::Interpolation::Linear, 0, {0, 1}, {0, 1}}));
    }
    parts.clips = {builder.build("bend")};
    return AnimationSet::create(std::move(parts)).value();
}

osg::ref_ptr<SkinnedGeometry> makeTube(const AnimationSet& set)
{
    osg::ref_ptr<SkinnedGeometry> tube = new SkinnedGeometry;
    osg::ref_ptr<osg::Vec3Array> positions = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec4usArray> entries = new osg::Vec4usArray;
    osg::ref_ptr<osg::Vec4Array> weights = new osg::Vec4Array;
    osg::ref_ptr<osg::DrawElementsUShort> triangles = new osg::DrawElementsUShort(GL_TRIANGLES);
    for (unsigned int column = 0; column <= tubeColumns; ++column)
        for (unsigned int row = 0; row < tubeRows; ++row)
        {
            const double x = 8.0 * column / tubeColumns, angle = 2.0 * osg::PI * row / tubeRows;
            positions->push_back(osg::Vec3d(x, 0.5 * std::cos(angle), 0.5 * std::sin(angle)));
            const float share = static_cast<float>(std::min(1.0, std::max(0.0, x - 3.5)));
            entries->push_back(osg::Vec4us(static_cast<GLushort>(set.entryOfSkin(0, 0)),
                                           static_cast<GLushort>(set.entryOfSkin(0, 1)), 0, 0));
            weights->push_back(osg::Vec4(1.0f - share, share, 0, 0));
            if (column == tubeColumns) continue;
            const unsigned int next = (row + 1) % tubeRows;
            for (const unsigned int vertex : {row, next, tubeRows + row, next, tubeRows + next, tubeRows + row})
                triangles->push_back(static_cast<GLushort>(column * tubeRows + vertex));
        }
    tube->setVertexArray(positions);
    tube->setInfluences(0, entries, weights);
    tube->addPrimitiveSet(triangles);
    return tube;
}

osg::ref_ptr<SkinnedGeometry> makeShownTube(const AnimationSet& set)
{
    const osg::ref_ptr<SkinnedGeometry> tube = makeTube(set);
    const auto& positions = static_cast<const osg::Vec3Array&>(*tube->getVertexArray());
    osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array(osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::Vec3Array> thicker = new osg::Vec3Array(osg::Array::BIND_PER_VERTEX);
    for (const osg::Vec3& position : positions)
    {
        const osg::Vec3 outwards(0.0f, 2.0f * position.y(), 2.0f * position.z());
        normals->push_back(outwards);
        const double bulge = position.x() < 4.0f ? std::sin(position.x() * osg::PI / 4.0) : 0.0;
        thicker->push_back(outwards * static_cast<float>(bulge));
    }
    tube->setNormalArray(normals);
    if (!set.morphs().empty()) tube->setMorphTargets(set, 0, {{thicker, nullptr, nullptr, nullptr}});
    applyCharacterProgram(*tube->getOrCreateStateSet());
    return tube;
}

std::vector<osg::ref_ptr<SkinnedGeometry>> makeTubeParts(const AnimationSet& set, unsigned int count)
{
    const osg::ref_ptr<SkinnedGeometry> tube = makeShownTube(set);
    const unsigned int columns = tubeColumns / count;
    std::vector<osg::ref_ptr<SkinnedGeometry>> parts;
    for (unsigned int part = 0; part < count; ++part)
    {
        const auto cut = [&](const auto* array)
        {
            using Array = std::remove_const_t<std::remove_pointer_t<decltype(array)>>;
            const auto first = array->begin() + part * columns * tubeRows;
            osg::ref_ptr<Array> piece = new Array(first, first + (columns + 1) * tubeRows);
            piece->setBinding(array->getBinding());
            return piece;
        };
        osg::ref_ptr<SkinnedGeometry> mesh = new SkinnedGeometry;
        mesh->setVertexArray(cut(static_cast<const osg::Vec3Array*>(tube->getVertexArray())));
        mesh->setNormalArray(cut(static_cast<const osg::Vec3Array*>(tube->getNormalArray())));
        mesh->setInfluences(0, cut(tube->getEntries(0)), cut(tube->getWeights(0)));
        const auto& triangles = static_cast<const osg::DrawElementsUShort&>(*tube->getPrimitiveSet(0));
        mesh->addPrimitiveSet(new osg::DrawElementsUShort(GL_TRIANGLES, 6 * columns * tubeRows, &triangles.front()));
        mesh->setStateSet(tube->getStateSet());
        parts.push_back(mesh);
    }
    return parts;
}

osg::ref_ptr<AnimatedCharacter> makeTubeCharacter(std::shared_ptr<const AnimationSet> set)
{
    osg::ref_ptr<AnimatedCharacter> character = new AnimatedCharacter(std::move(set));
    character->addChild(makeShownTube(character->getAnimationSet()));
    character->computeClipBounds();
    EXPECT_TRUE(character->getController().play("bend"));
    return character;
}

} // namespace osgGpuAnimation
