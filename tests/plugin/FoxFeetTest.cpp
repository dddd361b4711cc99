// SPDX-License-Identifier: MIT
#include "plugin/PluginFolder.h"

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/GroundFeet.h>

#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osgDB/ReadFile>
#include <osgUtil/UpdateVisitor>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <vector>

namespace osgGpuAnimation
{

namespace
{

constexpr const char* foxFile = OSGGPUANIMATION_SHARED_ASSETS "/assets/Fox/Fox.glb";
constexpr double scale = 0.011; ///< of the fox's units in metres

struct FoxLeg
{
    const char *start, *mid, *end, *toe; ///< toe: "" for none
};

const FoxLeg foxLegs[] = {{"b_LeftUpperArm_09", "b_LeftForeArm_010", "b_LeftHand_011", ""},
                          {"b_RightUpperArm_06", "b_RightForeArm_07", "b_RightHand_08", ""},
                          {"b_LeftLeg01_015", "b_LeftLeg02_016", "b_LeftFoot01_017", "b_LeftFoot02_018"},
                          {"b_RightLeg01_019", "b_RightLeg02_020", "b_RightFoot01_021", "b_RightFoot02_022"}};

/// The least height of each paw's joint above the ground, in metres, in two seconds of walking along -Y. slope:
/// radians, above 0 uphill.
std::vector<double> leastHeights(double slope)
{
    const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(foxFile);
    AnimatedCharacter* fox = findCharacter(*node);
    std::vector<Constraint> constraints;
    std::vector<GroundLeg> legs;
    for (const FoxLeg& leg : foxLegs)
    {
        constraints.push_back(TwoBoneIk{leg.end, leg.start, leg.mid, leg.end});
        legs.push_back({leg.end, leg.toe});
    }
    EXPECT_TRUE(fox->setAnimationSet(fox->getAnimationSet().withConstraints(constraints).value()));
    EXPECT_TRUE(fox->getController().play("Walk"));
    const AnimationSet& set = fox->getAnimationSet();
    const double step = measureGroundSpeed(set, set.clipNamed("Walk").value()) / 60.0;

    const double rise = std::tan(slope);
    const osg::ref_ptr<osg::Geometry> ground = osg::createTexturedQuadGeometry(
        {-9, -9, static_cast<float>(9 * rise)}, osg::Vec3(18, 0, 0), osg::Vec3(0, 18, static_cast<float>(-18 * rise)));
    const osg::ref_ptr<osg::MatrixTransform> scaled = new osg::MatrixTransform(osg::Matrix::scale(scale, scale, scale));
    scaled->addChild(node);
    const osg::ref_ptr<GroundFeet> feet = new GroundFeet(*ground);
    EXPECT_TRUE(feet->setLegs(set, legs));
    fox->addUpdateCallback(feet);

    const osg::ref_ptr<osgUtil::UpdateVisitor> visitor = new osgUtil::UpdateVisitor;
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    visitor->setFrameStamp(stamp);
    std::vector<double> least(std::size(foxLegs), HUGE_VAL);
    for (unsigned int frame = 0; frame < 120; ++frame)
    {
        stamp->setFrameNumber(frame);
        stamp->setSimulationTime(frame / 60.0);
        fox->setMatrix(osg::Matrix::translate(0, -step, 0) * fox->getMatrix());
        scaled->accept(*visitor);
        for (std::size_t i = 0; i < least.size(); ++i)
        {
            const FoxLeg& leg = foxLegs[i];
            const osg::Matrixd paw = fox->jointToModel(*leg.toe ? leg.toe : leg.end).value();
            const osg::Vec3d place = paw.getTrans() * fox->getMatrix() * scaled->getMatrix();
            least[i] = std::min(least[i], place.z() + rise * place.y());
        }
    }
    return least;
}

} // namespace

// The front paws are half a metre before the hind paws, whose ground decides the height of the fox.
TEST(FoxFeetTest, aQuadrupedReachesTheGroundOfASlope)
{
    if (!std::filesystem::exists(foxFile)) GTEST_SKIP() << "there is no " << foxFile;
    usePluginsOfTheBuild();
    for (const double slope : {-0.3, 0.0, 0.3, 0.4})
        for (const double height : leastHeights(slope))
        {
            EXPECT_GE(height, -1e-3) << slope;
            EXPECT_LE(height, 0.15) << slope << ": the paw never touches the ground";
        }
}

} // namespace osgGpuAnimation
