// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <gtest/gtest.h>

#include <cmath>

namespace osgGpuAnimation
{

namespace
{

using Matrices = std::vector<osg::Matrixd>;

const osg::Vec3d yUp(0, 1, 0), zUp(0, 0, 1);

osg::Matrixd placed(double scale, double angle, const osg::Vec3d& axis, const osg::Vec3d& place)
{
    return osg::Matrixd::scale(scale, scale, scale) * osg::Matrixd::rotate(angle, axis) *
           osg::Matrixd::translate(place);
}

double distanceOf(const osg::Matrixd& a, const osg::Matrixd& b)
{
    double largest = 0.0;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            largest = std::max(largest, std::abs(a(row, column) - b(row, column)));
    return largest;
}

/// A chain of three joints in a file with +Y up, in centimetres.
class NodePosesTest : public ::testing::Test
{
protected:
    NodePosesTest()
    {
        std::vector<Joint> joints(3);
        for (int joint = 0; joint < 3; ++joint)
        {
            joints[static_cast<std::size_t>(joint)].name = std::string(1, static_cast<char>('a' + joint));
            joints[static_cast<std::size_t>(joint)].parent = joint - 1;
        }
        character =
            new AnimatedCharacter(AnimationSet::create({Skeleton::create(joints).value(), {}, {}, {}, {}, {}}).value());
        EXPECT_TRUE(character->setFileToNode(osg::Matrixd::rotate(yUp, zUp) * osg::Matrixd::scale(0.01, 0.01, 0.01)));
        character->setMatrix(osg::Matrixd::translate(100, 0, 0));
    }

    Matrices shown() const
    {
        Matrices matrices;
        for (std::size_t joint = 0; joint < 3; ++joint)
            matrices.push_back(character->jointToModel(joint).value());
        return matrices;
    }

    osg::ref_ptr<AnimatedCharacter> character;
    /// Rotated and scaled parents, in metres.
    const Matrices wanted{placed(2.0, 0.7, {1, 0, 0}, {0, 1, 2}), placed(0.5, -1.1, {0, 1, 1}, {0.5, 1, 2.5}),
                          placed(1.5, 2.9, {0, 0, 1}, {1, 1, 3})};
};

} // namespace

TEST_F(NodePosesTest, jointsTakeMatricesOfTheCharactersOwnSpace)
{
    ASSERT_TRUE(character->setModelTransforms(0, wanted));
    for (std::size_t joint = 0; joint < 3; ++joint)
        EXPECT_LE(distanceOf(shown()[joint], wanted[joint]), 1e-5) << joint;
}

TEST_F(NodePosesTest, jointsOfInstancesTakeMatricesOfTheCrowdsSpace)
{
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*character);
    const osg::Vec3d far(1e6, 2e6, 0);
    const AnimatedCrowd::Instance instance =
        crowd->add(placed(3.0, 0.4, {0, 0, 1}, far), AnimationController(crowd->getSharedAnimationSet())).value();
    Matrices placedThere;
    for (const osg::Matrixd& matrix : wanted)
        placedThere.push_back(matrix * osg::Matrixd::translate(far));
    ASSERT_TRUE(crowd->setModelTransforms(instance, 1, placedThere));
    for (std::size_t joint = 0; joint < 3; ++joint)
        EXPECT_LE(distanceOf(crowd->jointToCrowd(instance, joint).value(), placedThere[joint]), 2e-5) << joint;
    crowd->remove(instance);
    EXPECT_FALSE(crowd->setModelTransforms(instance, 1, placedThere));
}

TEST_F(NodePosesTest, badMatricesAreErrorsAndKeepThePreviousPose)
{
    ASSERT_TRUE(character->setModelTransforms(0, wanted));
    const Matrices before = shown();
    const auto changed = [&](int row, int column, double value)
    {
        Matrices matrices = wanted;
        matrices[1](row, column) = value;
        return matrices;
    };
    struct Fault
    {
        Matrices matrices;
        const char* message;
    };
    const Fault faults[] = {{changed(0, 0, std::nan("")), "not finite"},
                            {changed(3, 2, HUGE_VAL), "not finite"},
                            {changed(1, 3, 0.5), "not affine"},
                            {changed(3, 3, std::nan("")), "not affine"},
                            {{wanted[0], osg::Matrixd::scale(1, 0, 1), wanted[2]}, "no inverse"},
                            {{wanted[0], wanted[1]}, "2"}};
    for (const Fault& fault : faults)
    {
        const Result<void> posed = character->setModelTransforms(0, fault.matrices);
        ASSERT_FALSE(posed) << fault.message;
        EXPECT_NE(posed.error().message.find(fault.message), std::string::npos) << posed.error().message;
        for (std::size_t joint = 0; joint < 3; ++joint)
            EXPECT_EQ(distanceOf(shown()[joint], before[joint]), 0.0);
    }
}

TEST_F(NodePosesTest, jointsBelowAShearKeepTheirPlaces)
{
    // The parent's scale differs by axis, so the rotated child is sheared, which a joint cannot be.
    Matrices sheared = wanted;
    sheared[0] = osg::Matrixd::scale(1, 3, 0.5) * osg::Matrixd::translate(0, 0, 1);
    sheared[1] = osg::Matrixd::rotate(0.6, osg::Vec3d(1, 1, 0)) * osg::Matrixd::translate(1, 0, 0) * sheared[0];
    sheared[1].preMult(osg::Matrixd(1, 0.4, 0, 0, 0, 1, 0, 0, 0, 0.3, 1, 0, 0, 0, 0, 1));
    ASSERT_TRUE(character->setModelTransforms(0, sheared));
    for (std::size_t joint = 0; joint < 3; ++joint)
        EXPECT_LE((shown()[joint].getTrans() - sheared[joint].getTrans()).length(), 1e-5) << joint;
}

} // namespace osgGpuAnimation
