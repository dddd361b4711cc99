// SPDX-License-Identifier: MIT
#include "nodes/Flag.h"

#include <osgGpuAnimation/animation/ClipBuilder.h>
#include <osgGpuAnimation/nodes/CharacterProgram.h>
#include <osgGpuAnimation/nodes/SkinnedGeometry.h>

#include <gtest/gtest.h>

#include <cmath>

namespace osgGpuAnimation
{

namespace
{

/// Two joints, the second swinging, and a morph whose weights move.
std::shared_ptr<const AnimationSet> flagSet(std::size_t morphTargets)
{
    JointTransform up;
    up.translation.z = 1.0f;
    AnimationParts parts{Skeleton::create({{"base", -1, {}, 0}, {"top", 0, up, 1}}).value(), {}, {0, 1}, {}, {}};
    if (morphTargets > 0) parts.morphs.push_back({"bulge", -1, std::vector<float>(morphTargets, 0.25f)});
    const double half = std::sqrt(0.5);
    ClipBuilder builder(parts.skeleton, parts.morphs);
    EXPECT_TRUE(builder.add(
        {Channel::Path::Rotation, Channel::Interpolation::Linear, 1, {0, 2}, {0, 0, 0, 1, 0, half, 0, half}}));
    if (morphTargets > 0)
    {
        std::vector<double> weights(2 * morphTargets, 0.0);
        std::fill(weights.begin() + static_cast<std::ptrdiff_t>(morphTargets), weights.end(), 0.8);
        EXPECT_TRUE(
            builder.add({Channel::Path::Weights, Channel::Interpolation::Linear, 0, {0, 2}, std::move(weights)}));
    }
    parts.clips.push_back(builder.build("swing"));
    return AnimationSet::create(std::move(parts)).value();
}

} // namespace

osg::ref_ptr<AnimatedCharacter> makeFlag(const FlagOptions& options)
{
    const std::shared_ptr<const AnimationSet> set = flagSet(options.morphTargets);
    osg::ref_ptr<SkinnedGeometry> mesh = new SkinnedGeometry;
    osg::ref_ptr<osg::Vec3Array> positions = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array(osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::Vec4usArray> entries = new osg::Vec4usArray;
    osg::ref_ptr<osg::Vec4Array> weights = new osg::Vec4Array;
    osg::ref_ptr<osg::DrawElementsUShort> triangles = new osg::DrawElementsUShort(GL_TRIANGLES);
    constexpr int side = 9;
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column)
        {
            const float x = 0.1f * static_cast<float>(column), z = 0.25f * static_cast<float>(row);
            positions->push_back({x, 0.2f * std::sin(4.0f * x), z});
            osg::Vec3 normal(0.8f * std::cos(4.0f * x), -1.0f, 0.0f);
            normal.normalize();
            normals->push_back(normal);
            const float share = std::min(z / 2.0f, 1.0f);
            entries->push_back({static_cast<GLushort>(set->entryOfRigidJoint(0)),
                                static_cast<GLushort>(set->entryOfRigidJoint(1)), 0, 0});
            weights->push_back({1.0f - share, share, 0.0f, 0.0f});
            if (row + 1 == side || column + 1 == side) continue;
            const auto corner = static_cast<GLushort>(row * side + column);
            for (const int step : {0, 1, side + 1, 0, side + 1, side})
                triangles->push_back(static_cast<GLushort>(corner + step));
        }
    mesh->setVertexArray(positions);
    if (options.hasNormals) mesh->setNormalArray(normals);
    mesh->addPrimitiveSet(triangles);
    mesh->setInfluences(0, entries, weights);
    std::vector<MorphTarget> targets(options.morphTargets);
    for (std::size_t target = 0; target < targets.size(); ++target)
    {
        targets[target].positions = new osg::Vec3Array(osg::Array::BIND_PER_VERTEX, positions->size());
        (*targets[target].positions)[10 * target + 4] = osg::Vec3(0.0f, -0.3f, 0.4f);
        if (options.hasNormals)
        {
            targets[target].normals = new osg::Vec3Array(osg::Array::BIND_PER_VERTEX, positions->size());
            (*targets[target].normals)[10 * target + 4] = osg::Vec3(0.5f, 0.0f, 0.5f);
        }
    }
    if (!targets.empty()) mesh->setMorphTargets(*set, 0, std::move(targets));
    mesh->setSkinning(options.skinning);
    applyCharacterProgram(*mesh->getOrCreateStateSet());
    applySkinDefines(*mesh->getOrCreateStateSet(), mesh->influenceCount(), options.morphTargets > 0);
    mesh->getOrCreateStateSet()->addUniform(new osg::Uniform("flatNormals", !options.hasNormals));
    osg::ref_ptr<AnimatedCharacter> character = new AnimatedCharacter(set);
    character->addChild(mesh);
    character->computeClipBounds();
    EXPECT_TRUE(character->controller().play("swing"));
    return character;
}

} // namespace osgGpuAnimation
