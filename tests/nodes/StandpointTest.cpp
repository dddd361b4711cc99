// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/viewing/Standpoint.h>

#include <gtest/gtest.h>
#include <osg/Matrixd>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

// Wide and high pictures: the points fill one direction up to the margin and leave neither.
TEST(StandpointTest, pointsFillPicturesOfEveryShape)
{
    const std::vector<osg::Vec3d> points{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 2}};
    for (const double aspect : {0.25, 0.5, 1.0, 2.0, 4.0})
    {
        const Standpoint place = raisedStandpoint(points, 30.0, aspect, 1.2);
        const osg::Matrixd toPicture = osg::Matrixd::lookAt(place.eye, place.middle, osg::Vec3d(0, 0, 1)) *
                                       osg::Matrixd::perspective(30.0, aspect, 0.1, 100.0);
        double farthest = 0.0; // from the middle; 1: the picture's edge
        for (const osg::Vec3d& point : points)
        {
            const osg::Vec3d seen = point * toPicture;
            farthest = std::max({farthest, std::abs(seen.x()), std::abs(seen.y())});
        }
        EXPECT_NEAR(farthest, 1.0 / 1.2, 0.02) << aspect;
    }
}

TEST(StandpointTest, directionsAreAroundAndAboveTheFront)
{
    const double half = std::sqrt(0.5);
    const struct
    {
        ViewDirection from;
        osg::Vec3d toEye;
        osg::Vec3d up;
    } cases[] = {
        {{0, 0}, {0, -1, 0}, {0, 0, 1}},    {{90, 0}, {1, 0, 0}, {0, 0, 1}},
        {{-90, 0}, {-1, 0, 0}, {0, 0, 1}},  {{180, 45}, {0, half, half}, {0, -half, half}},
        {{0, 90}, {0, 0, 1}, {0, 1, 0}},    {{90, 90}, {0, 0, 1}, {-1, 0, 0}},
        {{0, -90}, {0, 0, -1}, {0, -1, 0}}, {{405, 0}, {half, -half, 0}, {0, 0, 1}},
    };
    const std::vector<osg::Vec3d> points{{9, 9, 9}, {11, 9, 9}, {9, 11, 9}, {9, 9, 11}, {11, 11, 11}};
    for (const auto& [from, toEye, up] : cases)
    {
        const Standpoint place = standpointFrom(from, points, 30.0, 1.0, 1.1);
        osg::Vec3d found = place.eye - place.middle;
        found.normalize();
        EXPECT_LT((found - toEye).length(), 1e-9) << from.azimuth << ' ' << from.elevation;
        EXPECT_LT((place.up - up).length(), 1e-9) << from.azimuth << ' ' << from.elevation;
    }
}

} // namespace osgGpuAnimation
