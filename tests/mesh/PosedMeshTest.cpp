// SPDX-License-Identifier: MIT
#include "support/TestCrowd.h"
#include <osgGpuAnimation/animation/detail/ControllerDetail.h>

#include <osgGpuAnimation/animation/JointMask.h>
#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>
#include <osgGpuAnimation/mesh/geometry/PaletteEntryBounds.h>
#include <osgGpuAnimation/nodes/detail/CrowdDetail.h>
#include <osgGpuAnimation/nodes/JointAttachment.h>
#include <osgGpuAnimation/nodes/PickedJoint.h>

#include <gtest/gtest.h>
#include <osg/BoundingBox>
#include <osg/KdTree>
#include <osg/Texture2D>
#include <osg/TriangleFunctor>
#include <osgUtil/IntersectionVisitor>
#include <osgUtil/PlaneIntersector>
#include <osgUtil/RayIntersector>
#include <osgUtil/Statistics>

#include <algorithm>
#include <initializer_list>
#include <iterator>
#include <utility>

// OSG's visitors see characters and crowds in their current pose, with the number of primitives that are drawn.

namespace osgGpuAnimation
{

namespace
{

/// For osg::TriangleFunctor: the number of triangles and the bounding box of their corners.
struct TriangleBox
{
    void operator()(const osg::Vec3& a, const osg::Vec3& b, const osg::Vec3& c, bool = false)
    {
        ++triangles;
        for (const osg::Vec3& corner : {a, b, c})
            box.expandBy(corner);
    }
    int triangles = 0;
    osg::BoundingBox box;
};

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
    const osg::ref_ptr<AnimatedCharacter> character = shiftedCharacter(), rider = shiftedCharacter();
    const osg::ref_ptr<osg::KdTreeBuilder> builder = new osg::KdTreeBuilder;
    builder->_buildOptions._targetNumTrianglesPerLeaf = 1;
    character->accept(*builder);
    EXPECT_EQ(character->getChild(0)->asDrawable()->getShape(), nullptr) << "no KdTree of the bind pose";
    const osg::ref_ptr<osg::MatrixTransform> seat = new osg::MatrixTransform(osg::Matrix::translate(10, 0, 0));
    seat->addChild(rider);
    character->addChild(seat);
    EXPECT_FALSE(hitAt(*character, 0.5)->containsIntersections()) << "there it is in the bind pose alone";
    for (const bool isRider : {false, true})
    {
        const auto line = hitAt(*character, isRider ? 12.0 : 2.0);
        ASSERT_EQ(line->getIntersections().size(), 1u);
        const std::optional<PickedJoint> picked = jointOf(line->getFirstIntersection());
        ASSERT_TRUE(picked);
        EXPECT_EQ(picked->character, isRider ? rider : character);
        EXPECT_EQ(picked->crowd, nullptr);
        EXPECT_EQ(picked->mesh, picked->character->getChild(0));
        EXPECT_EQ(picked->set->skeleton().joint(picked->joint).name, "tip");
    }
    insertAbove(hitAt(*character, 2.0)->getFirstIntersection().nodePath);
    EXPECT_FALSE(hitAt(*character, 0.5)->containsIntersections());
    EXPECT_EQ(jointOf(hitAt(*character, 2.0)->getFirstIntersection())->character, character);
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
        box.setToBoundingBox(osg::BoundingBox(osg::Vec3d(x - 0.1, -1, 0.3), osg::Vec3d(x + 0.1, 1, 0.5)));
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
    const osg::ref_ptr<AnimatedCrowd> other = new AnimatedCrowd(*character);
    const auto two =
        addInstances(*other, {osg::Matrixd(), osg::Matrixd::translate(20, 0, 0)}, character->getController());
    const auto isHitAt = [&](double x) { return hitAt(*other, x)->containsIntersections(); };
    EXPECT_TRUE(isHitAt(2.0));
    ASSERT_TRUE(other->setPlacement(two[0], osg::Matrix::translate(70, 0, 0)));
    EXPECT_FALSE(isHitAt(2.0)) << "moved after it was posed";
    EXPECT_TRUE(isHitAt(72.0));
    EXPECT_FALSE(isHitAt(70.5)) << "there it is in the bind pose alone";
    ASSERT_TRUE(other->remove(two[0]));
    EXPECT_FALSE(isHitAt(72.0));
    EXPECT_FALSE(instanceOf(osgUtil::LineSegmentIntersector::Intersection()));
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
        osgUtil::IntersectionVisitor visitor(line);
        character->accept(visitor);
        const std::optional<PickedJoint> picked = jointOf(line->getFirstIntersection());
        ASSERT_TRUE(picked);
        EXPECT_EQ(set.skeleton().joint(picked->joint).name, joint);
    }
}

TEST(PosedMeshTest, hasTheTextureAndNormalsThatTurnAndKeepTheirLength)
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
    EXPECT_FALSE(hit.drawable->asGeometry()->getNormalArray()) << "not requested";
    osg::Vec3 coordinate;
    EXPECT_EQ(hit.getTextureLookUp(coordinate), texture);
    EXPECT_LE((coordinate - osg::Vec3(0.5f, 0.4f, 0)).length(), 1e-5f);
    auto* bind = dynamic_cast<osg::Vec3Array*>(mesh.getNormalArray());
    std::fill(bind->begin(), bind->end(), osg::Vec3(1, 0, 0));
    AnimationController& controller = character->getController();
    ASSERT_TRUE(controller.play("turn"));
    controller.setLoopMode(LoopMode::Once);
    controller.seek(1.0);
    ASSERT_TRUE(controller.layer(1).pose().setScale(1, glm::vec3(3, 2, 0.5f)));
    controller.advance(0.0);
    const osg::ref_ptr<osg::Geometry> posed = character->getPosedMesh(mesh, true);
    EXPECT_NEAR(posed->getBoundingBox().zMin(), -3.0f, 1e-5f);
    const auto& normals = dynamic_cast<const osg::Vec3Array&>(*posed->getNormalArray());
    ASSERT_EQ(normals.size(), 4u);
    for (const osg::Vec3& normal : normals)
        EXPECT_LE((normal - osg::Vec3(0, 0, -1)).length(), 1e-6f) << "a quarter about +Y";
}

TEST(PosedMeshTest, aPoseIsComputedOnceAndAnewWhenItOrTheMeshChanges)
{
    const osg::ref_ptr<AnimatedCharacter> character = shiftedCharacter();
    LookAt look{"look", {"base"}};
    look.forward = {1, 0, 0};
    ASSERT_TRUE(character->setAnimationSet(character->getAnimationSet().withConstraints({look}).value()));
    auto& mesh = dynamic_cast<SkinnedGeometry&>(*character->getChild(0));
    AnimationController& controller = character->getController();
    const auto posed = [&] { return character->getPosedMesh(mesh); };
    const osg::ref_ptr<osg::Geometry> first = posed();
    EXPECT_EQ(first, posed());
    mesh.setVertexArray(osg::clone(mesh.getVertexArray(), osg::CopyOp::DEEP_COPY_ALL));
    const osg::ref_ptr<osg::Geometry> second = posed();
    EXPECT_NE(first, second) << "another array";
    mesh.getVertexArray()->dirty();
    EXPECT_NE(second, posed()) << "other vertices";
    const osg::ref_ptr<AnimatedCharacter> clone = osg::clone(character.get(), osg::CopyOp::DEEP_COPY_NODES);
    EXPECT_NE(clone->getPosedMesh(mesh), posed());
    for (const float x : {1.0f, 4.0f, 2.0f})
    {
        EXPECT_TRUE(controller.layer(1).pose().setTranslation(1, glm::vec3(x, 0, 0)));
        controller.advance(0.0);
        EXPECT_NEAR(posed()->getBoundingBox().xMin(), 1.5f + x, 1e-5f);
    }
    controller.layer(1).pose().reset();
    controller.seek(0.0);
    for (const auto& [target, top] : {std::pair(osg::Vec3d(5, 0, 0), 1.0f), {osg::Vec3d(0, 0, -5), 0.0f}})
    {
        EXPECT_TRUE(character->constraint("look").setTarget(target));
        EXPECT_NEAR(posed()->getBoundingBox().zMax(), top, 1e-5f);
    }
    ASSERT_TRUE(character->constraint("look").clear());
    // Numbers of freed masks are used again: the samples are equal bit by bit.
    ASSERT_TRUE(controller.layer(1).play("turn"));
    controller.layer(1).seek(0.5);
    const auto setMask = [&](float weight)
    { EXPECT_TRUE(controller.layer(1).setMask(JointMask(character->getAnimationSet(), weight))); };
    setMask(1.0f);
    const std::uint32_t number = ControllerDetail::maskNumber(controller.layer(1));
    EXPECT_LT(posed()->getBoundingBox().zMin(), -0.5f);
    setMask(0.5f);
    setMask(0.0f);
    ASSERT_EQ(ControllerDetail::maskNumber(controller.layer(1)), number);
    EXPECT_NEAR(posed()->getBoundingBox().zMin(), 0.0f, 1e-5f);
}

TEST(PosedMeshTest, functorsGetThePoseOfWhatIsShown)
{
    const osg::ref_ptr<AnimatedCharacter> character = shiftedCharacter();
    const osg::ref_ptr<AnimatedCrowd> crowd =
        makeCrowd(*character, {osg::Matrixd(), osg::Matrixd::translate(10, 0, 0), osg::Matrixd::translate(20, 0, 0)});
    for (const int shown : {1, 0})
    {
        osg::TriangleFunctor<TriangleBox> seen, ofCrowd;
        character->acceptPosed(seen);
        for (std::size_t i = 0; i < crowd->getNumInstances(); ++i)
            forEachMesh(*crowd,
                        [&](const SkinnedGeometry& mesh)
                        {
                            if (mesh.getNodeMask() != 0)
                                crowd->getPosedMesh(CrowdDetail::instances(*crowd).handleOf(i), mesh)->accept(ofCrowd);
                        });
        EXPECT_EQ(seen.triangles, 2 * shown);
        EXPECT_EQ(ofCrowd.triangles, 6 * shown);
        EXPECT_EQ(seen.box, shown ? osg::BoundingBox(1.5f, 0, 0, 2.5f, 0, 1) : osg::BoundingBox());
        EXPECT_EQ(ofCrowd.box, shown ? osg::BoundingBox(1.5f, 0, 0, 22.5f, 0, 1) : osg::BoundingBox());
        character->getChild(0)->setNodeMask(0); // the crowd shares it
    }
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
