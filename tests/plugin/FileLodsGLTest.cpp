// SPDX-License-Identifier: MIT
#include "gltf/ImportedFile.h"
#include "support/ViewerGLTest.h"

#include <osg/MatrixTransform>

namespace osgGpuAnimation::gltf
{

namespace
{

class FileLodsGLTest : public ViewerGLTest
{
protected:
    /// A red triangle whose other level is blue, 1 unit wide.
    static osg::ref_ptr<osg::Group> twoLevels(bool isMoving)
    {
        ModelBuilder file;
        file.model.extensionsUsed = {"KHR_materials_unlit", "MSFT_lod"};
        const std::vector<double> colors[] = {{1, 0, 0, 1}, {0, 0, 1, 1}};
        for (std::size_t level = 0; level < 2; ++level)
        {
            tinygltf::Material& material = file.model.materials.emplace_back();
            material.pbrMetallicRoughness.baseColorFactor = colors[level];
            material.extensions["KHR_materials_unlit"] = tinygltf::Value(tinygltf::Value::Object());
            const int mesh = file.triangle();
            file.primitive(mesh).material = static_cast<int>(level);
            file.node("level", -1, mesh);
        }
        file.at(0).extensions["MSFT_lod"] = tinygltf::Value(
            tinygltf::Value::Object{{"ids", tinygltf::Value(tinygltf::Value::Array{tinygltf::Value(1)})}});
        // Of a view of 1,080 lines: from 21.6 pixels on, and from 8.1.
        file.at(0).extras = tinygltf::Value(tinygltf::Value::Object{
            {"MSFT_screencoverage",
             tinygltf::Value(tinygltf::Value::Array{tinygltf::Value(0.02), tinygltf::Value(0.0075)})}});
        if (isMoving)
            for (const int node : {0, 1})
            {
                file.animation("turn");
                file.channel(node, "scale", {0, 1}, TINYGLTF_TYPE_VEC3, {1, 1, 1, 1, 1, 1});
            }
        ImportOptions options;
        options.noRotation = true;
        return imported(file, options).root;
    }

    /// The colour of most pixels that are not black; black: nothing is drawn.
    osg::Vec4 colorAt(osg::Node& scene, double halfWidth)
    {
        osg::Camera& camera = *viewer().getCamera();
        camera.setClearColor({0, 0, 0, 1});
        camera.setViewMatrixAsLookAt({0.3, 0.3, 10}, {0.3, 0.3, 0}, {0, 1, 0});
        camera.setProjectionMatrixAsOrtho(-halfWidth, halfWidth, -halfWidth, halfWidth, 1, 20);
        const osg::ref_ptr<osg::Image> image = pictureOf(&scene, {0.0, 0.1});
        return image->getColor(static_cast<unsigned int>(image->s() / 2), static_cast<unsigned int>(image->t() / 2));
    }
};

} // namespace

TEST_F(FileLodsGLTest, nearAndFarShowDifferentLevels)
{
    for (const bool isMoving : {false, true})
    {
        const osg::ref_ptr<osg::Group> model = twoLevels(isMoving);
        const osg::ref_ptr<osg::Group> copy = osg::clone(model.get(), osg::CopyOp::DEEP_COPY_ALL);
        for (osg::Group* const scene : {model.get(), copy.get()})
        {
            // The bounding sphere is 1.4 units wide, the picture 64 pixels: 45, 11 and 4 pixels.
            EXPECT_EQ(colorAt(*scene, 1.0), osg::Vec4(1, 0, 0, 1)) << isMoving;
            EXPECT_EQ(colorAt(*scene, 4.0), osg::Vec4(0, 0, 1, 1)) << isMoving;
            EXPECT_EQ(colorAt(*scene, 10.0), osg::Vec4(0, 0, 0, 1)) << isMoving;
        }
    }
    EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

} // namespace osgGpuAnimation::gltf
