// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/viewing/StartView.h>

#include <osg/MatrixTransform>

#include <gtest/gtest.h>

namespace osgGpuAnimation
{

// glTF 2.0, section 3.10.2: scales above a camera have no effect on its view.
TEST(StartViewTest, scalesAboveACameraDoNotTurnItsView)
{
    const osg::Vec3d scales[] = {{1, 1, 1},   {0.01, 0.01, 0.01}, {1e-6, 1e-6, 1e-6}, {300, 300, 300},
                                 {0.1, 7, 2}, {3, 3, 3},          {2, 1, 0.5},        {-1, 1, 1}};
    for (const double angle : {60.0, 170.0})
        for (const osg::Vec3d& scale : scales)
        {
            SCOPED_TRACE(std::to_string(angle) + " degrees, scale " + std::to_string(scale.x()));
            const osg::Matrixd turn = osg::Matrixd::rotate(osg::DegreesToRadians(angle), 0.6, 0.0, 0.8);
            const osg::Matrixd place = turn * osg::Matrixd::translate(1, 2, 3);
            const osg::ref_ptr<osg::MatrixTransform> node =
                new osg::MatrixTransform(osg::Matrixd::scale(scale) * place);
            const osg::ref_ptr<osg::CameraView> camera = new osg::CameraView;
            node->addChild(camera);
            const osg::Matrixd found = viewToWorld(*camera);
            for (int row = 0; row < 4; ++row)
                for (int column = 0; column < 4; ++column)
                    EXPECT_NEAR(found(row, column), place(row, column), 1e-12) << row << ' ' << column;
        }
}

TEST(StartViewTest, aMirrorAboveACameraDoesNotMirrorItsPicture)
{
    for (const osg::Vec3d& scale : {osg::Vec3d(-1, 1, 1), osg::Vec3d(1, -2, 1), osg::Vec3d(1, 1, -3)})
    {
        const osg::ref_ptr<osg::MatrixTransform> node = new osg::MatrixTransform(osg::Matrixd::scale(scale));
        const osg::ref_ptr<osg::CameraView> camera = new osg::CameraView;
        node->addChild(camera);
        const osg::Matrixd found = viewToWorld(*camera);
        const auto axis = [&](int row) { return osg::Vec3d(found(row, 0), found(row, 1), found(row, 2)); };
        EXPECT_NEAR((axis(0) ^ axis(1)) * axis(2), 1.0, 1e-12);
        EXPECT_NEAR(axis(2).z(), scale.z() < 0.0 ? -1.0 : 1.0, 1e-12); // it looks along the mirrored -Z
    }
}

} // namespace osgGpuAnimation
