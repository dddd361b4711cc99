// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/nodes/viewing/StartView.h>

#include <osg/MatrixTransform>

#include <gtest/gtest.h>

namespace osgGpuAnimation
{

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
