// SPDX-License-Identifier: MIT
#include "support/TestCharacter.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>
#include <osgGpuAnimation/looks/CharacterProgram.h>

#include <cmath>

namespace osgGpuAnimation
{

namespace
{

Clip makeClip(const Skeleton& skeleton, const char* name, Channel::Path path, std::vector<double> times,
              std::vector<double> values)
{
    ClipBuilder builder(skeleton, {});
    const Result<void> added =
        builder.add({path, Channel::Interpolation::Linear, 0, std::move(times), std::move(values)});
    assert(added && "the test's own channel is valid");
    (void)added;
    return builder.build(name);
}

} // namespace

osg::ref_ptr<SkinnedGeometry> makeTestSquare(int joint)
{
    osg::ref_ptr<SkinnedGeometry> square = new SkinnedGeometry;
    osg::ref_ptr<osg::Vec3Array> positions = new osg::Vec3Array;
    for (const osg::Vec3 corner : {osg::Vec3(0, 0, 0), osg::Vec3(1, 0, 0), osg::Vec3(1, 0, 1), osg::Vec3(0, 0, 1)})
        positions->push_back(corner);
    square->setVertexArray(positions);
    osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array(osg::Array::BIND_PER_VERTEX, 4);
    std::fill(normals->begin(), normals->end(), osg::Vec3(0, -1, 0));
    square->setNormalArray(normals);
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array(osg::Array::BIND_PER_VERTEX, 4);
    std::fill(colors->begin(), colors->end(), osg::Vec4(1, 1, 1, 1));
    square->setColorArray(colors);
    square->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLE_FAN, 0, 4));
    square->setRigidEntry(static_cast<unsigned short>(testCharacterSet()->entryOfRigidJoint(joint)));
    applyCharacterProgram(*square->getOrCreateStateSet());
    square->getOrCreateStateSet()->getUniform("unlit")->set(true);
    return square;
}

std::shared_ptr<const AnimationSet> testCharacterSet()
{
    static const std::shared_ptr<const AnimationSet> set = []
    {
        JointTransform aside;
        aside.translation.x = 2.0f;
        AnimationParts parts{Skeleton::create({{"base", -1, {}, 0}, {"tip", 0, {}, 1}, {"side", 0, aside, 2}}).value(),
                             {},
                             {1, 2},
                             {},
                             {}};
        const double half = std::sqrt(0.5);
        parts.clips.push_back(
            makeClip(parts.skeleton, "shift", Channel::Path::Translation, {0, 2}, {0, 0, 0, 2, 0, 0}));
        parts.clips.push_back(
            makeClip(parts.skeleton, "turn", Channel::Path::Rotation, {0, 1}, {0, 0, 0, 1, 0, half, 0, half}));
        return AnimationSet::create(std::move(parts)).value();
    }();
    return set;
}

osg::ref_ptr<AnimatedCharacter> makeTestCharacter()
{
    osg::ref_ptr<AnimatedCharacter> character = new AnimatedCharacter(testCharacterSet());
    character->addChild(makeTestSquare(1));
    character->computeClipBounds();
    const Result<void> playing = character->getController().play("shift");
    assert(playing && "the clip is there");
    (void)playing;
    return character;
}

} // namespace osgGpuAnimation
