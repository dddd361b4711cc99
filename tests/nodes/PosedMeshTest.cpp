// SPDX-License-Identifier: MIT
#include "nodes/TriangleBox.h"
#include "support/TestCharacter.h"

#include <osgGpuAnimation/animation/JointMask.h>
#include <osgGpuAnimation/nodes/JointAttachment.h>
#include <osgGpuAnimation/nodes/PickedJoint.h>

#include <gtest/gtest.h>
#include <osg/KdTree>
#include <osg/Texture2D>
#include <osg/TriangleFunctor>
#include <osgUtil/IntersectionVisitor>
#include <osgUtil/PlaneIntersector>
#include <osgUtil/RayIntersector>
#include <osgUtil/Statistics>

#include <algorithm>
#include <iterator>
#include <utility>

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

/// What osgkeyboardmouse does: a node above the last one of the path.
osg::ref_ptr<osg::Group> insertAbove(const osg::NodePath& path)
{
    const osg::ref_ptr<osg::Node> hit = path.back();
    const osg::ref_ptr<osg::Group> inserted = new osg::Group;
    inserted->addChild(hit);
    EXPECT_TRUE(path[path.size() - 2]->asGroup()->replaceChild(hit, inserted));
    return inserted;
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

TEST(PosedMeshTest, hitsNameTheDrawnMesh)
{
    const osg::ref_ptr<osg::MatrixTransform> scene = new osg::MatrixTransform(osg::Matrix::translate(10, 0, 0));
    const osg::ref_ptr<AnimatedCharacter> character = shiftedCharacter();
    scene->addChild(character);
    osg::Node* mesh = character->getChild(0);
    const auto line = hitAt(*scene, 12.0);
    ASSERT_EQ(line->getIntersections().size(), 1u);
    const osgUtil::LineSegmentIntersector::Intersection hit = line->getFirstIntersection();
    EXPECT_EQ(hit.drawable, mesh);
    EXPECT_EQ(hit.nodePath, osg::NodePath({scene, character, mesh}));
    insertAbove(hit.nodePath);
    const auto again = hitAt(*scene, 12.0)->getFirstIntersection();
    EXPECT_EQ(again.drawable, mesh);
    ASSERT_TRUE(jointOf(again));
    EXPECT_EQ(jointOf(again)->character, character);
}

TEST(PosedMeshTest, allIntersectorsNameTheDrawnMesh)
{
    const osg::ref_ptr<AnimatedCharacter> character = shiftedCharacter();
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*character);
    EXPECT_TRUE(crowd->add(osg::Matrix::translate(20, 0, 0), character->getController()));
    const AnimatedCrowd::Instance instance =
        crowd->add(osg::Matrix::translate(10, 0, 0), character->getController()).value();
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(character);
    scene->addChild(crowd);
    for (const bool isCrowd : {false, true})
    {
        const double x = isCrowd ? 12.0 : 2.0;
        const osg::ref_ptr<osgUtil::RayIntersector> ray =
            new osgUtil::RayIntersector(osg::Vec3d(x, -5, 0.4), osg::Vec3d(0, 1, 0));
        osg::Polytope box;
        box.setToBoundingBox(osg::BoundingBox(x - 0.1f, -1, 0.3f, x + 0.1f, 1, 0.5f));
        const osg::ref_ptr<osgUtil::PolytopeIntersector> polytope = new osgUtil::PolytopeIntersector(box);
        const osg::ref_ptr<osgUtil::PlaneIntersector> plane =
            new osgUtil::PlaneIntersector(osg::Plane(1, 0, 0, -x), box);
        const osg::ref_ptr<osgUtil::IntersectorGroup> group = new osgUtil::IntersectorGroup;
        for (osgUtil::Intersector* member : std::initializer_list<osgUtil::Intersector*>{ray, polytope, plane})
            group->addIntersector(member);
        osgUtil::IntersectionVisitor visitor(group);
        scene->accept(visitor);
        const auto expectNamed = [&](const auto& hits)
        {
            EXPECT_GE(hits.size(), 1u);
            for (const auto& hit : hits)
            {
                EXPECT_EQ(hit.drawable, character->getChild(0)) << "the crowd shares it";
                EXPECT_EQ(hit.nodePath.back(), character->getChild(0));
                EXPECT_EQ(hit.nodePath.size(), 3u);
                EXPECT_EQ(instanceOf(hit), isCrowd ? std::optional(instance) : std::nullopt);
            }
        };
        expectNamed(ray->getIntersections());
        expectNamed(polytope->getIntersections());
        expectNamed(plane->getIntersections());
        const std::optional<PickedJoint> picked = jointOf(polytope->getFirstIntersection());
        ASSERT_TRUE(picked);
        EXPECT_EQ(picked->crowd, isCrowd ? crowd.get() : nullptr);
        EXPECT_EQ(picked->set->skeleton().joint(picked->joint).name, "tip");
    }
}

TEST(PosedMeshTest, crowdsArePickedBelowInsertedGroups)
{
    const osg::ref_ptr<AnimatedCharacter> character = shiftedCharacter();
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*character);
    std::vector<AnimatedCrowd::Instance> instances;
    for (int i = 0; i < 100; ++i)
        instances.push_back(crowd->add(osg::Matrix::translate(0, 10 * i, 0), character->getController()).value());
    const osg::ref_ptr<osg::Geometry> ground = osg::createTexturedQuadGeometry({0, -3, 0}, {9, 0, 0}, {0, 0, 9});
    crowd->addChild(ground);
    for (const bool isInserted : {false, true})
    {
        const osg::ref_ptr<osgUtil::LineSegmentIntersector> line =
            new osgUtil::LineSegmentIntersector(osg::Vec3d(2, -5, 0.4), osg::Vec3d(2, 2000, 0.4));
        osgUtil::IntersectionVisitor visitor(line);
        crowd->accept(visitor);
        ASSERT_EQ(line->getIntersections().size(), 101u) << "all instances, and the ground once";
        auto hit = line->getIntersections().begin();
        EXPECT_EQ(hit->drawable, ground);
        EXPECT_FALSE(instanceOf(*hit));
        for (const AnimatedCrowd::Instance instance : instances)
        {
            ++hit;
            ASSERT_EQ(instanceOf(*hit), instance);
            EXPECT_EQ(hit->drawable, character->getChild(0));
            ASSERT_TRUE(jointOf(*hit));
            EXPECT_EQ(jointOf(*hit)->instance, instance);
        }
        if (!isInserted) insertAbove(hit->nodePath);
    }
}

TEST(PosedMeshTest, aRiderIsPickedNotTheHorse)
{
    const osg::ref_ptr<AnimatedCharacter> horse = shiftedCharacter(), rider = shiftedCharacter();
    const osg::ref_ptr<osg::MatrixTransform> seat = new osg::MatrixTransform(osg::Matrix::translate(0, 0, 10));
    seat->addChild(rider);
    horse->addChild(seat);
    const osg::ref_ptr<osgUtil::LineSegmentIntersector> line =
        new osgUtil::LineSegmentIntersector(osg::Vec3d(2, -5, 10.4), osg::Vec3d(2, 5, 10.4));
    osgUtil::IntersectionVisitor visitor(line);
    horse->accept(visitor);
    ASSERT_TRUE(line->containsIntersections());
    const std::optional<PickedJoint> picked = jointOf(line->getFirstIntersection());
    ASSERT_TRUE(picked);
    EXPECT_EQ(picked->character, rider);
}

// The corners of the triangle follow joints of their own: "tip" the one at the origin, "side" the others.
TEST(PosedMeshTest, theJointIsThatOfTheNearestCorner)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    const AnimationSet& set = character->getAnimationSet();
    auto& mesh = dynamic_cast<SkinnedGeometry&>(*character->getChild(0));
    auto& corners = dynamic_cast<osg::Vec3Array&>(*mesh.getVertexArray());
    const osg::Vec3 places[] = {{0, 0, 0}, {-1, 0, 0}, {-1, 0, 1}, {-1, 0, 1}}; // "side" is at x = 2
    std::copy(std::begin(places), std::end(places), corners.begin());
    const osg::ref_ptr<osg::Vec4usArray> entries = new osg::Vec4usArray;
    for (const int joint : {1, 2, 2, 2})
        entries->push_back(osg::Vec4us(static_cast<unsigned short>(set.entryOfRigidJoint(joint)), 0, 0, 0));
    const osg::ref_ptr<osg::Vec4Array> weights = new osg::Vec4Array(4);
    std::fill(weights->begin(), weights->end(), osg::Vec4(1, 0, 0, 0));
    mesh.setInfluences(0, entries, weights);
    for (const auto& [place, joint] : {std::pair(osg::Vec3d(0.2, 0, 0.1), "tip"), {osg::Vec3d(0.9, 0, 0.1), "side"}})
    {
        const osg::ref_ptr<osgUtil::LineSegmentIntersector> line =
            new osgUtil::LineSegmentIntersector(place - osg::Vec3d(0, 5, 0), place + osg::Vec3d(0, 5, 0));
        const osg::Vec3 margin(0.05f, 0.05f, 0.05f);
        osg::Polytope box;
        box.setToBoundingBox(osg::BoundingBox(osg::Vec3(place) - margin, osg::Vec3(place) + margin));
        const osg::ref_ptr<osgUtil::PolytopeIntersector> polytope = new osgUtil::PolytopeIntersector(box);
        const osg::ref_ptr<osgUtil::IntersectorGroup> group = new osgUtil::IntersectorGroup;
        group->addIntersector(line);
        group->addIntersector(polytope);
        osgUtil::IntersectionVisitor visitor(group);
        character->accept(visitor);
        ASSERT_TRUE(line->containsIntersections() && polytope->containsIntersections());
        for (const std::optional<PickedJoint>& picked :
             {jointOf(line->getFirstIntersection()), jointOf(polytope->getFirstIntersection())})
        {
            ASSERT_TRUE(picked);
            EXPECT_EQ(set.skeleton().joint(picked->joint).name, joint);
        }
    }
}

TEST(PosedMeshTest, aPosedMeshLooksUpTheTexture)
{
    const osg::ref_ptr<AnimatedCharacter> character = shiftedCharacter();
    auto& mesh = dynamic_cast<SkinnedGeometry&>(*character->getChild(0));
    const osg::ref_ptr<osg::Vec2Array> coordinates = new osg::Vec2Array(osg::Array::BIND_PER_VERTEX);
    for (const osg::Vec2 corner : {osg::Vec2(0, 0), osg::Vec2(1, 0), osg::Vec2(1, 1), osg::Vec2(0, 1)})
        coordinates->push_back(corner);
    mesh.setTexCoordArray(0, coordinates);
    const osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D;
    mesh.getOrCreateStateSet()->setTextureAttributeAndModes(0, texture);
    osgUtil::LineSegmentIntersector::Intersection hit = hitAt(*character, 2.0)->getFirstIntersection();
    hit.drawable = character->getPosedMesh(mesh);
    osg::Vec3 coordinate;
    EXPECT_EQ(hit.getTextureLookUp(coordinate), texture);
    EXPECT_NEAR(coordinate.x(), 0.5, 1e-5);
    EXPECT_NEAR(coordinate.y(), 0.4, 1e-5);
}

TEST(PosedMeshTest, normalsTurnWithTheirVertices)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    auto& mesh = dynamic_cast<SkinnedGeometry&>(*character->getChild(0));
    auto* bind = dynamic_cast<osg::Vec3Array*>(mesh.getNormalArray());
    std::fill(bind->begin(), bind->end(), osg::Vec3(1, 0, 0));
    EXPECT_TRUE(character->getController().play("turn"));
    character->getController().setLoopMode(LoopMode::Once);
    character->getController().seek(1.0);
    EXPECT_FALSE(character->getPosedMesh(mesh)->getNormalArray()) << "not requested";
    const osg::ref_ptr<osg::Geometry> posed = character->getPosedMesh(mesh, true);
    const auto* normals = dynamic_cast<const osg::Vec3Array*>(posed->getNormalArray());
    ASSERT_TRUE(normals);
    ASSERT_EQ(normals->size(), 4u);
    for (const osg::Vec3& normal : *normals)
        EXPECT_LE((normal - osg::Vec3(0, 0, -1)).length(), 1e-6f) << "a quarter about +Y";
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
    const osg::ref_ptr<osg::Geometry> before = character->getPosedMesh(mesh);
    mesh.setVertexArray(osg::clone(mesh.getVertexArray(), osg::CopyOp::DEEP_COPY_ALL));
    EXPECT_NE(before, character->getPosedMesh(mesh)) << "another array";
    const osg::ref_ptr<osg::Geometry> second = character->getPosedMesh(mesh);
    mesh.getVertexArray()->dirty();
    EXPECT_NE(second, character->getPosedMesh(mesh)) << "other vertices";
    const osg::ref_ptr<AnimatedCharacter> clone = osg::clone(character.get(), osg::CopyOp::DEEP_COPY_NODES);
    EXPECT_NE(clone->getPosedMesh(mesh), character->getPosedMesh(mesh));
}

TEST(PosedMeshTest, aMovedTargetIsAnotherPose)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    LookAt look{"look", {"base"}};
    look.forward = {1, 0, 0};
    ASSERT_TRUE(character->setAnimationSet(character->getAnimationSet().withConstraints({look}).value()));
    const auto& mesh = dynamic_cast<const SkinnedGeometry&>(*character->getChild(0));
    const auto lookingAt = [&](const osg::Vec3d& target)
    {
        EXPECT_TRUE(character->constraint("look").setTarget(target));
        return character->getPosedMesh(mesh)->getBoundingBox();
    };
    EXPECT_NEAR(lookingAt({5, 0, 0}).zMax(), 1.0f, 1e-5f);
    EXPECT_NEAR(lookingAt({0, 0, -5}).zMax(), 0.0f, 1e-5f);
}

TEST(PosedMeshTest, aChangedPoseOfJointsIsAnotherPose)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    const auto& mesh = dynamic_cast<const SkinnedGeometry&>(*character->getChild(0));
    AnimationController& controller = character->getController();
    const auto leftAt = [&](float x)
    {
        EXPECT_TRUE(controller.layer(1).pose().setTranslation(1, glm::vec3(x, 0, 0)));
        controller.advance(0.0);
        return character->getPosedMesh(mesh)->getBoundingBox().xMin();
    };
    const float first = leftAt(1.0f);
    EXPECT_NEAR(leftAt(4.0f) - first, 3.0f, 1e-5f);
    EXPECT_NEAR(leftAt(2.0f) - first, 1.0f, 1e-5f);
}

// Numbers of freed masks are used again: the samples are equal bit by bit.
TEST(PosedMeshTest, anotherMaskOfThatNumberIsAnotherPose)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    const auto& mesh = dynamic_cast<const SkinnedGeometry&>(*character->getChild(0));
    AnimationController& controller = character->getController();
    ASSERT_TRUE(controller.layer(1).play("turn"));
    controller.layer(1).seek(0.5);
    const auto setMask = [&](float weight)
    {
        JointMask mask(character->getAnimationSet());
        for (std::size_t joint = 0; joint < character->getAnimationSet().skeleton().jointCount(); ++joint)
            mask.setJoint(joint, weight);
        EXPECT_TRUE(controller.layer(1).setMask(mask));
    };
    setMask(1.0f);
    const std::uint32_t number = controller.layer(1).mask();
    const osg::BoundingBox turned = character->getPosedMesh(mesh)->getBoundingBox();
    setMask(0.5f);
    setMask(0.0f);
    ASSERT_EQ(controller.layer(1).mask(), number);
    const osg::BoundingBox still = character->getPosedMesh(mesh)->getBoundingBox();
    EXPECT_GT((still._max - turned._max).length() + (still._min - turned._min).length(), 0.3f);
}

TEST(PosedMeshTest, normalsBelowScaledJointsHaveLengthOne)
{
    const osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    const auto& mesh = dynamic_cast<const SkinnedGeometry&>(*character->getChild(0));
    ASSERT_TRUE(character->getController().layer(1).pose().setScale(1, glm::vec3(3, 2, 0.5f)));
    character->getController().advance(0.0);
    const osg::ref_ptr<osg::Geometry> posed = character->getPosedMesh(mesh, true);
    EXPECT_NEAR(posed->getBoundingBox().xMax() - posed->getBoundingBox().xMin(), 3.0f, 1e-5f);
    for (const osg::Vec3& normal : dynamic_cast<const osg::Vec3Array&>(*posed->getNormalArray()))
        EXPECT_LE((normal - osg::Vec3(0, -1, 0)).length(), 1e-6f);
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
    character->getChild(0)->setNodeMask(0);
    osg::TriangleFunctor<TriangleBox> hidden;
    character->acceptPosed(hidden);
    EXPECT_EQ(hidden.triangles, 0);
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
    crowd->addChild(osg::createTexturedQuadGeometry({}, {1, 0, 0}, {0, 0, 1}));
    scene->addChild(crowd);
    osgUtil::StatsVisitor statistics;
    scene->accept(statistics);
    statistics.totalUpStats();
    EXPECT_EQ(statistics._numInstancedDrawable, 2u + 7u + 1u);
    EXPECT_EQ(statistics._drawableSet.size(), 3u);
    EXPECT_EQ(statistics._instancedStats._vertexCount, 4u * 10u);
    EXPECT_EQ(statistics._uniqueStats._vertexCount, 4u * 3u);
}

} // namespace osgGpuAnimation
