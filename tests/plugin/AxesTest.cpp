// SPDX-License-Identifier: MIT
#include "gltf/ModelBuilder.h"
#include "serializers/StoredScene.h"

#include <osgGpuAnimation/frame/crowd/CrowdInstances.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/detail/CrowdDetail.h>

#include <osg/ComputeBoundsVisitor>
#include <osgUtil/IntersectionVisitor>
#include <osgUtil/LineSegmentIntersector>

#include <gtest/gtest.h>

#include <cmath>

// One space: whatever a user says to a node or hears from it is in the node's space, +Z up.

namespace osgGpuAnimation
{

namespace
{

/// A pole of 2 units along the file's +Y, with a joint "top" at its end, on a joint "hips" that walks 3 units along the
/// file's +Z in one second. Beside it stands a stone, 1 unit high, which never moves.
std::string poleModel()
{
    gltf::ModelBuilder file;
    const int hips = file.node("hips");
    file.node("pole", hips,
              file.mesh({{"POSITION", file.floats(TINYGLTF_TYPE_VEC3, {0, 0, 0, 0.25f, 0, 0, 0, 2, 0})}}));
    const int top = file.node("top", hips);
    file.at(top).translation = {0, 2, 0};
    const int stone = file.node("stone", -1, file.triangle());
    file.at(stone).translation = {5, 0, 0};
    file.animation("walk");
    file.channel(hips, "translation", {0, 1}, TINYGLTF_TYPE_VEC3, {0, 0, 0, 0, 0, 3});
    file.channel(top, "translation", {0, 1}, TINYGLTF_TYPE_VEC3, {0, 2, 0, 0, 2, 0});
    return file.text();
}

class AxesTest : public ::testing::Test
{
protected:
    void SetUp() override
    {
        model = load("");
        character = findCharacter(*model);
        ASSERT_NE(character, nullptr);
    }

    osg::ref_ptr<osg::Node> load(const std::string& options) const
    {
        return osgDB::readRefNodeFile(files.folder.write("pole.gltf", poleModel()), new osgDB::Options(options));
    }

    StoredScene files;
    osg::ref_ptr<osg::Node> model;
    AnimatedCharacter* character = nullptr;
};

void expectNear(const osg::Vec3d& actual, const osg::Vec3d& expected, double tolerance = 1e-6)
{
    EXPECT_LE((actual - expected).length(), tolerance) << actual.x() << ' ' << actual.y() << ' ' << actual.z();
}

} // namespace

TEST_F(AxesTest, withNoRotationBothHaveTheFilesAxes)
{
    const osg::ref_ptr<osg::Node> lying = load("noRotation");
    const AnimatedCharacter& unturned = *findCharacter(*lying);
    EXPECT_TRUE(unturned.getFileToNode().isIdentity());
    expectNear(unturned.jointToModel("top").value().getTrans(), {0.0, 2.0, 0.0});
    expectNear(unturned.getClipBounds(0)._max, {0.25, 2.0, 3.0}, 1e-3);
}

TEST_F(AxesTest, boundsAreInTheNodesSpace)
{
    expectNear(character->getClipBounds(0)._min, {0.0, -3.0, 0.0}, 1e-3);
    expectNear(character->getClipBounds(0)._max, {0.25, 0.0, 2.0}, 1e-3);
    EXPECT_EQ(character->getCurrentBounds()._min, character->getClipBounds(0)._min);
    EXPECT_TRUE(character->getBound().contains(osg::Vec3(0.0f, -3.0f, 2.0f)));
    const auto& mesh = dynamic_cast<const SkinnedGeometry&>(*character->getChild(0));
    EXPECT_EQ(mesh.getBoundingBox()._max, character->getClipBounds(0)._max) << "not of the bind pose";
    osg::ComputeBoundsVisitor stone;
    model->asGroup()->getChild(1)->accept(stone);
    expectNear(stone.getBoundingBox()._min, {5.0, 0.0, 0.0});
    expectNear(stone.getBoundingBox()._max, {6.0, 0.0, 1.0});
}

TEST_F(AxesTest, jointsPosedMeshesAndHitsAreInTheNodesSpace)
{
    character->getController().pause();
    character->getController().seek(0.5);
    expectNear(character->jointToModel("top").value().getTrans(), {0.0, -1.5, 2.0});
    const auto& mesh = dynamic_cast<const SkinnedGeometry&>(*character->getChild(0));
    expectNear(character->getPosedMesh(mesh)->getBoundingBox()._max, {0.25, -1.5, 2.0});
    const osg::ref_ptr<osgUtil::LineSegmentIntersector> ray =
        new osgUtil::LineSegmentIntersector(osg::Vec3d(0.05, -9.0, 1.0), osg::Vec3d(0.05, 9.0, 1.0));
    osgUtil::IntersectionVisitor picking(ray);
    model->accept(picking);
    ASSERT_TRUE(ray->containsIntersections());
    expectNear(ray->getFirstIntersection().getWorldIntersectPoint(), {0.05, -1.5, 1.0});
}

TEST_F(AxesTest, clonesAndStoredScenesKeepTheAxes)
{
    const osg::ref_ptr<osg::Node> clone = osg::clone(model.get(), osg::CopyOp::DEEP_COPY_NODES);
    EXPECT_EQ(findCharacter(*clone)->getFileToNode(), character->getFileToNode());
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*character);
    // Neither a quarter turn nor a rotation.
    const osg::Matrixd odd = osg::Matrixd::scale(0.7, 1.1, 2.0) * osg::Matrixd::rotate(0.3, osg::Vec3d(1, 2, 3)) *
                             osg::Matrixd::translate(1, 2, 3);
    AnimationController controller(crowd->getSharedAnimationSet());
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(model);
    scene->addChild(crowd);
    for (const osg::Matrixd& axes : {character->getFileToNode(), odd})
    {
        ASSERT_TRUE(character->setFileToNode(axes));
        ASSERT_TRUE(crowd->setFileToNode(axes));
        ASSERT_TRUE(
            crowd->add(osg::Matrixd::rotate(0.4, osg::Vec3d(0, 0, 1)) * osg::Matrixd::translate(9, 8, 7), controller));
        for (const char* format : {"osgb", "osgt", "osgx"})
        {
            SCOPED_TRACE(format);
            const osg::ref_ptr<osg::Node> read = files.throughFile(*scene, format);
            ASSERT_TRUE(read && findCharacter(*read));
            EXPECT_EQ(findCharacter(*read)->getFileToNode(), character->getFileToNode());
            EXPECT_EQ(findCharacter(*read)->getClipBounds(0)._max, character->getClipBounds(0)._max);
            const auto& again = dynamic_cast<const AnimatedCrowd&>(*read->asGroup()->getChild(1));
            EXPECT_EQ(again.getFileToNode(), crowd->getFileToNode());
            ASSERT_EQ(again.getNumInstances(), crowd->getNumInstances());
            for (std::size_t i = 0; i < crowd->getNumInstances(); ++i)
                EXPECT_EQ(CrowdDetail::instances(again).rootMatrix(i).rows,
                          CrowdDetail::instances(*crowd).rootMatrix(i).rows);
        }
    }
}

TEST_F(AxesTest, transformsThatDrawNothingRightAreErrors)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*character);
    const osg::Matrixd before = character->getFileToNode();
    osg::Matrixd projection;
    projection(2, 3) = 0.5;
    for (const osg::Matrixd& wrong : {osg::Matrixd::scale(-1, 1, 1), osg::Matrixd::scale(1, 0, 1),
                                      osg::Matrixd::translate(std::nan(""), 0, 0), projection})
    {
        EXPECT_FALSE(character->setFileToNode(wrong));
        EXPECT_FALSE(crowd->setFileToNode(wrong));
        EXPECT_EQ(character->getFileToNode(), before);
        EXPECT_EQ(crowd->getFileToNode(), before);
    }
}

TEST_F(AxesTest, instancesKeepTheirPlacementsInOtherAxes)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*character);
    AnimationController controller(crowd->getSharedAnimationSet());
    const osg::Matrixd placement = osg::Matrixd::scale(2, 2, 2) * osg::Matrixd::translate(100, 20, 0);
    const AnimatedCrowd::Instance pole = crowd->add(placement, controller).value();
    EXPECT_EQ(crowd->getPlacement(pole), placement);
    ASSERT_TRUE(crowd->setFileToNode({}));
    EXPECT_EQ(crowd->getPlacement(pole), placement);
    expectNear(crowd->getBound().center(), {106.0, 22.0, 0.0}, 1e-5); // with the mesh that does not move
    ASSERT_TRUE(crowd->setFileToNode(character->getFileToNode()));
    expectNear(crowd->getBound().center(), {106.0, 20.0, 2.0}, 1e-5);
}

} // namespace osgGpuAnimation
