// SPDX-License-Identifier: MIT
#include "nodes/TriangleBox.h"
#include "support/TestCharacter.h"

#include <osgGpuAnimation/nodes/PickedJoint.h>

#include <gtest/gtest.h>
#include <osg/KdTree>
#include <osg/TriangleFunctor>
#include <osgUtil/IntersectionVisitor>
#include <osgUtil/Statistics>

// OSG's visitors see characters and crowds in their current pose, with the number of primitives that are drawn.

namespace osgGpuAnimation
{

namespace
{

osg::ref_ptr<osgUtil::LineSegmentIntersector> hitAt(osg::Node& node, double x)
{
    const osg::ref_ptr<osgUtil::LineSegmentIntersector> line =
        new osgUtil::LineSegmentIntersector(osg::Vec3d(x, -5, 0.4), osg::Vec3d(x, 5, 0.4));
    osgUtil::IntersectionVisitor visitor(line);
    node.accept(visitor);
    return line;
}

osg::ref_ptr<AnimatedCharacter> shiftedCharacter()
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    character->getController().seek(1.5);
    return character;
}

} // namespace

TEST(PosedMeshTest, aCharacterIsPickedAsItIsPosed)
{
    const osg::ref_ptr<AnimatedCharacter> character = shiftedCharacter();
    EXPECT_FALSE(hitAt(*character, 0.5)->containsIntersections()) << "there it is in the bind pose alone";
    const auto line = hitAt(*character, 2.0);
    ASSERT_EQ(line->getIntersections().size(), 1u);
    const std::optional<PickedJoint> picked = jointOf(line->getFirstIntersection());
    ASSERT_TRUE(picked);
    EXPECT_EQ(picked->character, character);
    EXPECT_EQ(picked->crowd, nullptr);
    EXPECT_EQ(picked->mesh, character->getChild(0));
    EXPECT_EQ(picked->set->skeleton().joint(picked->joint).name, "tip");
}

TEST(PosedMeshTest, meshesBelowGroupsAreToo)
{
    const osg::ref_ptr<AnimatedCharacter> character = shiftedCharacter();
    const osg::ref_ptr<osg::Group> group = new osg::Group;
    group->addChild(character->getChild(0));
    character->replaceChild(character->getChild(0), group);
    EXPECT_FALSE(hitAt(*character, 0.5)->containsIntersections());
    EXPECT_TRUE(jointOf(hitAt(*character, 2.0)->getFirstIntersection()));
}

TEST(PosedMeshTest, aPoseIsComputedOnce)
{
    const osg::ref_ptr<AnimatedCharacter> character = shiftedCharacter();
    auto& mesh = dynamic_cast<SkinnedGeometry&>(*character->getChild(0));
    const osg::ref_ptr<osg::Geometry> first = character->getPosedMesh(mesh);
    EXPECT_EQ(first, character->getPosedMesh(mesh));
    character->getController().seek(0.5);
    EXPECT_NE(first, character->getPosedMesh(mesh)) << "another pose";
    const osg::ref_ptr<osg::Geometry> second = character->getPosedMesh(mesh);
    mesh.getVertexArray()->dirty();
    EXPECT_NE(second, character->getPosedMesh(mesh)) << "other vertices";
    const osg::ref_ptr<AnimatedCharacter> clone = osg::clone(character.get(), osg::CopyOp::DEEP_COPY_NODES);
    EXPECT_NE(clone->getPosedMesh(mesh), character->getPosedMesh(mesh));
}

TEST(PosedMeshTest, kdTreesAreNotMadeOfBindPoses)
{
    const osg::ref_ptr<AnimatedCharacter> character = shiftedCharacter();
    const osg::ref_ptr<osg::KdTreeBuilder> builder = new osg::KdTreeBuilder;
    builder->_buildOptions._targetNumTrianglesPerLeaf = 1;
    character->accept(*builder);
    EXPECT_EQ(character->getChild(0)->asDrawable()->getShape(), nullptr);
    EXPECT_FALSE(hitAt(*character, 0.5)->containsIntersections());
    EXPECT_TRUE(hitAt(*character, 2.0)->containsIntersections());
}

TEST(PosedMeshTest, functorsGetThePose)
{
    const osg::ref_ptr<AnimatedCharacter> character = shiftedCharacter();
    osg::TriangleFunctor<TriangleBox> seen;
    character->acceptPosed(seen);
    EXPECT_EQ(seen.triangles, 2);
    EXPECT_EQ(seen.box._min, osg::Vec3(1.5f, 0, 0));
    EXPECT_EQ(seen.box._max, osg::Vec3(2.5f, 0, 1));
}

TEST(PosedMeshTest, statisticsCountWhatIsDrawn)
{
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(makeTestCharacter());
    scene->addChild(scene->getChild(0));
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    const AnimationController controller(testCharacterSet());
    for (int i = 0; i < 7; ++i)
        ASSERT_TRUE(crowd->add(osg::Matrix::translate(i, 0, 0), controller));
    scene->addChild(crowd);
    osgUtil::StatsVisitor statistics;
    scene->accept(statistics);
    statistics.totalUpStats();
    EXPECT_EQ(statistics._numInstancedDrawable, 2u + 7u);
    EXPECT_EQ(statistics._drawableSet.size(), 2u);
    EXPECT_EQ(statistics._instancedStats._vertexCount, 4u * 9u);
    EXPECT_EQ(statistics._uniqueStats._vertexCount, 4u * 2u);
}

} // namespace osgGpuAnimation
