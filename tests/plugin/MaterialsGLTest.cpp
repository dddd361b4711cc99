// SPDX-License-Identifier: MIT
#include "plugin/ImportedFile.h"
#include "support/ViewerGLTest.h"

namespace osgGpuAnimation::gltf
{

namespace
{

class MaterialsGLTest : public ViewerGLTest
{
protected:
    /// A triangle with that material, from before. isMoving: it slides, so that it is drawn from the palette.
    osg::ref_ptr<osg::Image> pictureOf(const tinygltf::Material& material, bool isMoving, bool isColored = false)
    {
        ModelBuilder file;
        const int mesh = file.triangle();
        if (isColored)
            file.primitive(mesh).attributes["COLOR_0"] = file.floats(TINYGLTF_TYPE_VEC3, {1, 1, 0, 1, 1, 0, 1, 1, 0});
        file.model.materials = {material};
        file.model.extensionsUsed = {"KHR_materials_unlit"};
        file.primitive(mesh).material = 0;
        const int node = file.node("leaf", -1, mesh);
        if (isMoving) file.animation("slide");
        if (isMoving) file.slide(node);
        ImportOptions options;
        options.noRotation = true;
        viewer().getCamera()->setViewMatrixAsLookAt({0.25, 0.25, 10}, {0.25, 0.25, 0}, {0, 1, 0});
        viewer().getCamera()->setClearColor({0, 0, 0, 1});
        return ViewerGLTest::pictureOf(imported(file, options).root, {0.0});
    }
};

} // namespace

// Section 3.9.4 of glTF 2.0: an alpha of at least the cutoff is opaque.
TEST_F(MaterialsGLTest, anAlphaThatEqualsTheCutoffIsDrawn)
{
    struct Case
    {
        double alpha, cutoff;
        bool isDrawn;
    };
    const Case cases[] = {{1.0, 1.0, true}, {0.5, 0.5, true}, {0.0, 0.0, true}, {0.4, 0.5, false}, {0.6, 0.5, true}};
    for (const bool isMoving : {false, true})
        for (const Case& masked : cases)
        {
            tinygltf::Material material;
            material.pbrMetallicRoughness.baseColorFactor = {1.0, 1.0, 1.0, masked.alpha};
            material.alphaMode = "MASK";
            material.alphaCutoff = masked.cutoff;
            pictureOf(material, isMoving);
            EXPECT_EQ(picture().pixelsDrawn() > 20, masked.isDrawn)
                << masked.alpha << " of " << masked.cutoff << (isMoving ? ", moving" : ", still");
        }
}

TEST_F(MaterialsGLTest, withoutLightTheColorIsTheFactorTimesTheVertices)
{
    tinygltf::Material material;
    material.pbrMetallicRoughness.baseColorFactor = {0.0, 1.0, 1.0, 1.0};
    material.extensions["KHR_materials_unlit"] = tinygltf::Value(tinygltf::Value::Object());
    for (const bool isMoving : {false, true})
        for (const bool isColored : {false, true}) // yellow
            EXPECT_EQ(pictureOf(material, isMoving, isColored)->getColor(32u, 32u),
                      osg::Vec4(0, 1, isColored ? 0 : 1, 1))
                << (isMoving ? "moving" : "still") << (isColored ? ", with colours" : "");
}

} // namespace osgGpuAnimation::gltf
