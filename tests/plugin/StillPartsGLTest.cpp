// SPDX-License-Identifier: MIT
#include "gltf/ImportedFile.h"
#include "plugin/PluginFolder.h"
#include "support/ScratchFolder.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/ComputeBoundsVisitor>
#include <osg/FrontFace>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>
#include <osgUtil/Optimizer>

// Crowds show the meshes of their character's file that do not move, as if the file had been read with wholeModel.

namespace osgGpuAnimation::gltf
{

namespace
{

/// A vehicle whose rotor slides. Its bodies do not move: a blue one, and a mirrored one with colours of each vertex.
struct Vehicle
{
    const char* name;
    bool isBelow;                  ///< rotor and bodies are below a common root
    std::vector<double> rootScale; ///< of that root
    std::vector<double> bodyScale; ///< of the blue body
    const char* options = "";
};

const Vehicle vehicles[] = {
    {"below the root", true, {1, 1, 1}, {2, 1, 1}},
    {"beside what moves", false, {1, 1, 1}, {2, 1, 1}},
    {"below a root that scales", true, {0.5, 2, 1}, {2, 1, 1}},
    {"mirrored", true, {1, 1, 1}, {-2, 1, 1}},
    {"below a root that mirrors", true, {-1, 1, 1}, {2, 1, 1}},
    {"as by the fixed pipeline", true, {1, 1, 1}, {2, 1, 1}, "lighting=fixed"},
};

ModelBuilder fileOf(const Vehicle& vehicle)
{
    ModelBuilder file;
    tinygltf::Material& material = file.model.materials.emplace_back();
    material.name = "paint";
    material.pbrMetallicRoughness.baseColorFactor = {0.2, 0.4, 0.9, 1};
    material.pbrMetallicRoughness.metallicFactor = 0.2;
    const int plain = file.triangle(), colored = file.triangle(), rotor = file.triangle();
    for (const int mesh : {plain, colored})
        file.primitive(mesh).material = 0;
    file.primitive(colored).attributes["COLOR_0"] =
        file.floats(TINYGLTF_TYPE_VEC3, {1, 0.5f, 0.2f, 1, 0.5f, 0.2f, 1, 0.9f, 0.2f});
    const int root = file.node("vehicle");
    file.at(root).scale = vehicle.rootScale;
    file.at(root).translation = {-0.5, 0, 0};
    const int above = vehicle.isBelow ? root : -1;
    const int body = file.node("body", above, plain), tail = file.node("tail", above, colored);
    file.at(body).translation = {0.25, 0.5, 0};
    file.at(body).scale = vehicle.bodyScale;
    file.at(tail).translation = {0, -2, 0};
    file.at(tail).scale = {-1.5, 1.5, 1};
    const int mast = file.node("mast", above);
    file.at(mast).translation = {-1.5, 1.5, 0};
    file.slidingClip("spin", file.node("rotor", mast, rotor));
    return file;
}

osg::ref_ptr<AnimatedCrowd> crowdOf(const AnimatedCharacter& character)
{
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(character);
    EXPECT_TRUE(crowd->add({}, character.getController()));
    return crowd;
}

ImportedModel read(const Vehicle& vehicle, const std::string& further = "")
{
    return imported(fileOf(vehicle), parseOptions(vehicle.options + further).value());
}

class StillPartsGLTest : public ViewerGLTest
{
protected:
    int pictureSide() const override { return 160; }
};

} // namespace

TEST_F(StillPartsGLTest, aCrowdLooksAsItsModel)
{
    for (const Vehicle& vehicle : vehicles)
    {
        SCOPED_TRACE(vehicle.name);
        const ImportedModel model = read(vehicle);
        const osg::ref_ptr<osg::Image> still = pictureOf(model.root, {0.0, 0.1});
        EXPECT_GT(Picture::pixelsDrawn(*still), 200);
        for (const osg::ref_ptr<AnimatedCrowd>& crowd :
             {crowdOf(*read(vehicle).character), crowdOf(*read(vehicle, " wholeModel").character)})
        {
            const osg::ref_ptr<osg::Image> picture = pictureOf(crowd, {0.0, 0.1});
            EXPECT_LE(Picture::pixelsDifferent(*picture, *still), 2); // edges are rounded differently
        }
    }
}

TEST_F(StillPartsGLTest, copiesStoredAndOptimizedModelsHaveThem)
{
    usePluginsOfTheBuild();
    const ScratchFolder folder;
    const auto expectAll = [](const AnimatedCharacter& character, const osg::BoundingSphere& bound)
    {
        const osg::ref_ptr<AnimatedCrowd> crowd = crowdOf(character);
        ASSERT_EQ(crowd->getNumChildren(), 3u);
        for (const char* part : {"rotor", "body", "tail"})
            EXPECT_TRUE(crowd->getMeshes().find(part)) << part;
        EXPECT_EQ(crowd->getMeshes().find("tail")->getStateSet()->getName(), "paint");
        EXPECT_NEAR((crowd->getBound().center() - bound.center()).length(), 0.0, 1e-5);
    };
    const ImportedModel model = read(vehicles[0]);
    const osg::BoundingSphere bound = crowdOf(*read(vehicles[0], " wholeModel").character)->getBound();
    EXPECT_EQ(model.character->getNumChildren(), 1u) << "the character itself draws the rotor alone";
    EXPECT_EQ(model.set->paletteSize(), read(vehicles[0], " wholeModel").set->paletteSize() - 2);
    expectAll(*model.character, bound);
    expectAll(*osg::clone(model.character.get(), osg::CopyOp::SHALLOW_COPY), bound);
    for (const char* extension : {"osgt", "osgb", "osgx"})
    {
        SCOPED_TRACE(extension);
        const std::string name = folder.file(std::string("vehicle.") + extension);
        ASSERT_TRUE(osgDB::writeNodeFile(*model.root, name));
        const osg::ref_ptr<osg::Node> stored = osgDB::readRefNodeFile(name);
        ASSERT_TRUE(stored);
        expectAll(*findCharacter(*stored), bound);
    }
    osgUtil::Optimizer().optimize(model.root, osgUtil::Optimizer::ALL_OPTIMIZATIONS);
    expectAll(*model.character, bound);
}

} // namespace osgGpuAnimation::gltf
