// SPDX-License-Identifier: MIT
#include "gltf/file/ModelBytes.h"
#include "plugin/RoundTrip.h"
#include "plugin/SharedAssets.h"
#include "support/ViewerGLTest.h"

namespace osgGpuAnimation
{

namespace
{

class ExportGLTest : public ViewerGLTest
{
protected:
    int pictureSide() const override { return 256; }

    /// A picture that the model fills.
    osg::ref_ptr<osg::Image> pictureOfModel(osg::Group& model, double time)
    {
        const osg::BoundingSphere bound = model.getBound();
        viewer().getCamera()->setProjectionMatrixAsOrtho(-bound.radius(), bound.radius(), -bound.radius(),
                                                         bound.radius(), 0.1 * bound.radius(), 20.0 * bound.radius());
        viewer().getCamera()->setViewMatrixAsLookAt(
            bound.center() + osg::Vec3d(0.5, -1.0, 0.3) * (4.0 * bound.radius()), bound.center(), osg::Vec3d(0, 0, 1));
        return pictureOf(&model, {0.0, time});
    }
};

TEST_F(ExportGLTest, filesShowTheSamePictures)
{
    for (const char* name : {"MaterialBalls.glb", "Wanderer.glb", "Serpent.glb"})
    {
        SCOPED_TRACE(name);
        const Result<std::string> bytes = gltf::readModelFile(ownScene(name), {});
        ASSERT_TRUE(bytes) << bytes.error().message;
        const Result<gltf::ImportedModel> model = gltf::importModel(bytes.value(), "", {});
        ASSERT_TRUE(model) << model.error().message;
        const osg::ref_ptr<osg::Group> read = throughGlb(*model.value().root);
        ASSERT_TRUE(read);
        const osg::ref_ptr<osg::Image> before = pictureOfModel(*model.value().root, 0.4);
        EXPECT_GT(picture().pixelsDrawn(), 1000);
        const osg::ref_ptr<osg::Image> after = pictureOfModel(*read, 0.4);
        // Vertices differ by their rounding, and with them single pixels of edges.
        EXPECT_LE(Picture::pixelsDifferent(*before, *after), 6);
    }
    EXPECT_NO_GL_ERROR();
}

} // namespace

} // namespace osgGpuAnimation
