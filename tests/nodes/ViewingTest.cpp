// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/viewing/Standpoint.h>
#include <osgGpuAnimation/nodes/viewing/StartView.h>

#include <gtest/gtest.h>
#include <osg/Matrixd>
#include <osg/MatrixTransform>

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

// A crowd would fill a strip of the picture.
TEST(StandpointTest, whatLiesFlatIsSeenFromHigher)
{
    const struct
    {
        const char* name;
        osg::Vec3d size;
        double elevation; ///< degrees
    } cases[] = {
        {"a crowd", {20, 20, 1.7}, 34.7},
        {"a person", {1.0, 0.6, 1.7}, 14.7},
        {"a wall", {8, 0.5, 1}, 14.7},
        {"a point", {0, 0, 0}, 14.7},
    };
    for (const auto& [name, size, elevation] : cases)
    {
        std::vector<osg::Vec3d> points;
        for (unsigned int corner = 0; corner < 8; ++corner)
            points.emplace_back(corner & 1 ? size.x() : 0, corner & 2 ? size.y() : 0, corner & 4 ? size.z() : 0);
        EXPECT_NEAR(fillingDirection(points).elevation, elevation, 0.1) << name;
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

// glTF 2.0, section 3.10.2: scales above a camera have no effect on its view. A mirror does not mirror its picture, but
// it looks along the mirrored -Z.
TEST(StartViewTest, scalesAndMirrorsAboveACameraDoNotTurnItsView)
{
    const osg::Vec3d scales[] = {{1, 1, 1},   {1e-6, 1e-6, 1e-6}, {300, 300, 300}, {0.1, 7, 2},
                                 {2, 1, 0.5}, {-1, 1, 1},         {1, -2, 1},      {1, 1, -3}};
    for (const osg::Vec3d& scale : scales)
    {
        SCOPED_TRACE(testing::Message() << scale.x() << ' ' << scale.y() << ' ' << scale.z());
        const osg::Matrixd place = osg::Matrixd::rotate(3.0, 0.6, 0.0, 0.8) * osg::Matrixd::translate(1, 2, 3);
        const osg::ref_ptr<osg::MatrixTransform> node = new osg::MatrixTransform(osg::Matrixd::scale(scale) * place);
        const osg::ref_ptr<osg::CameraView> camera = new osg::CameraView;
        node->addChild(camera);
        const osg::Matrixd found = viewToWorld(*camera);
        const auto axis = [](const osg::Matrixd& matrix, int row)
        { return osg::Vec3d(matrix(row, 0), matrix(row, 1), matrix(row, 2)); };
        EXPECT_NEAR((axis(found, 0) ^ axis(found, 1)) * axis(found, 2), 1.0, 1e-12);
        EXPECT_NEAR(axis(found, 2) * axis(place, 2), scale.z() < 0.0 ? -1.0 : 1.0, 1e-12);
        EXPECT_NEAR((found.getTrans() - place.getTrans()).length(), 0.0, 1e-12);
        const bool isMirrored = scale.x() * scale.y() * scale.z() < 0.0;
        EXPECT_TRUE(isMirrored || axis(found, 0) * axis(place, 0) > 1.0 - 1e-12);
    }
}

} // namespace osgGpuAnimation
