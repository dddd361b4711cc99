// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/scene/traversal/CullScopes.h>

#include <gtest/gtest.h>

namespace osgGpuAnimation
{

TEST(CullScopesTest, theVisitorHasItsNearFarModeAndInheritanceBack)
{
    using Settings = osg::CullSettings;
    const std::pair<Settings::ComputeNearFarMode, Settings::ComputeNearFarMode> modes[] = {
        {Settings::COMPUTE_NEAR_FAR_USING_PRIMITIVES, Settings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES},
        {Settings::COMPUTE_NEAR_USING_PRIMITIVES, Settings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES},
        {Settings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES, Settings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES},
        {Settings::DO_NOT_COMPUTE_NEAR_FAR, Settings::DO_NOT_COMPUTE_NEAR_FAR}};
    for (const auto& [outside, inside] : modes)
    {
        const osg::ref_ptr<osgUtil::CullVisitor> visitor = new osgUtil::CullVisitor;
        visitor->setComputeNearFarMode(outside);
        visitor->setInheritanceMask(Settings::ALL_VARIABLES);
        for (int mesh = 0; mesh < 2; ++mesh)
        {
            const BoxNearFar boxes(*visitor);
            EXPECT_EQ(visitor->getComputeNearFarMode(), inside);
        }
        EXPECT_EQ(visitor->getComputeNearFarMode(), outside);
        // Without its bit the visitor would ignore the mode of a camera below it.
        EXPECT_EQ(visitor->getInheritanceMask(), static_cast<unsigned int>(Settings::ALL_VARIABLES));
    }
}

} // namespace osgGpuAnimation
