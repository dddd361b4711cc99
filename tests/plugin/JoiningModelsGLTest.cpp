// SPDX-License-Identifier: MIT
#include "frame/GlCallTrace.h"
#include "gltf/ModelBuilder.h"
#include "plugin/PluginFolder.h"
#include "support/ScratchFolder.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/looks/Environment.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <osg/Geometry>
#include <osgDB/ReadFile>
#include <osgUtil/IncrementalCompileOperation>

// A model joins a running host, whose geometry has display lists (OSG's default) or client arrays: GL reads the arrays
// of such geometry from an address near 0, and the process ends, if a vertex buffer of ours is still bound.

namespace osgGpuAnimation::gltf
{

namespace
{

/// An arm of two joints; the second moves.
std::string armText(bool isSkinned)
{
    ModelBuilder file;
    const int mesh = isSkinned ? file.skinnedTriangle() : file.triangle();
    if (!isSkinned)
        file.primitive(mesh).targets = {{{"POSITION", file.floats(TINYGLTF_TYPE_VEC3, {0, 0, 0, 0, 0, 1, 0, 0, 0})}}};
    const int upper = file.node("upper"), lower = file.node("lower", upper);
    const int body = file.node("body", -1, mesh);
    if (isSkinned) file.at(body).skin = file.skin({upper, lower});
    file.slidingClip("move", lower);
    if (!isSkinned) file.channel(body, "weights", {0, 1}, TINYGLTF_TYPE_SCALAR, {0, 1});
    return file.text();
}

std::string stoneText()
{
    ModelBuilder file;
    file.node("stone", -1, file.triangle());
    return file.text();
}

osg::ref_ptr<osg::Node> inPanorama(const osg::ref_ptr<osg::Node>& model)
{
    const osg::ref_ptr<osg::Image> sky = new osg::Image;
    sky->allocateImage(4, 2, 1, GL_RGB, GL_UNSIGNED_BYTE);
    std::fill(sky->data(), sky->data() + sky->getTotalSizeInBytes(), static_cast<unsigned char>(128));
    const osg::ref_ptr<Environment> environment = new Environment;
    EXPECT_TRUE(environment->setPanorama(sky));
    environment->addChild(model);
    return environment;
}

osg::ref_ptr<osg::Node> inGarment(const osg::ref_ptr<osg::Node>& model)
{
    const osg::ref_ptr<osg::Node> garment = osg::clone(model.get(), osg::CopyOp::DEEP_COPY_ALL);
    EXPECT_TRUE(findCharacter(*model)->wear(garment));
    return model;
}

struct ModelKind
{
    const char* name;
    const char* file;
    osg::ref_ptr<osg::Node> (*changed)(const osg::ref_ptr<osg::Node>& model); ///< null: as the file is
};

void PrintTo(const ModelKind& kind, std::ostream* out)
{
    *out << kind.name;
}

const ModelKind modelKinds[] = {
    {"Skinned", "arm.gltf", nullptr},       {"Morphing", "morph.gltf", nullptr},
    {"Still", "stone.gltf", nullptr},       {"Crowd", "arm.gltf.3x3.crowd", nullptr},
    {"Studio", "arm.gltf.studio", nullptr}, {"Environment", "arm.gltf", inPanorama},
    {"Garment", "arm.gltf", inGarment},
};

enum class Way
{
    Added,                 ///< to the scene of a running viewer
    CompiledIncrementally, ///< by the viewer's IncrementalCompileOperation, which then adds it
    CompiledOnRealize      ///< in the scene before the viewer's first frame
};

const std::pair<const char*, Way> ways[] = {{"added", Way::Added},
                                            {"compiled incrementally", Way::CompiledIncrementally},
                                            {"compiled on realize", Way::CompiledOnRealize}};

/// Nearest to the eye, in the right quarter of the picture. bin: below 0: drawn before the model, above: after it.
osg::ref_ptr<osg::Node> makeHost(int bin, bool usesLists)
{
    const osg::ref_ptr<osg::Geometry> quad =
        osg::createTexturedQuadGeometry({2.0f, -8.5f, bin < 0 ? -4.0f : 0.0f}, {2, 0, 0}, {0, 0, 4});
    const osg::ref_ptr<osg::Vec4Array> color = new osg::Vec4Array(osg::Array::BIND_OVERALL);
    color->push_back(usesLists ? osg::Vec4(1, 0, 0, 1) : osg::Vec4(0, 1, 0, 1));
    quad->setColorArray(color);
    quad->setUseDisplayList(usesLists);
    quad->setUseVertexBufferObjects(false);
    quad->getOrCreateStateSet()->setRenderBinDetails(bin, "RenderBin");
    quad->getStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    return quad;
}

class JoiningModelsGLTest : public ViewerGLTest, public ::testing::WithParamInterface<ModelKind>
{
protected:
    JoiningModelsGLTest()
    {
        usePluginsOfTheBuild();
        _folder.write("arm.gltf", armText(true));
        _folder.write("morph.gltf", armText(false));
        _folder.write("stone.gltf", stoneText());
    }

    osg::ref_ptr<osg::Node> makeModel()
    {
        const osg::ref_ptr<osg::Node> model = osgDB::readRefNodeFile(_folder.file(GetParam().file));
        return model && GetParam().changed ? GetParam().changed(model) : model;
    }

    /// The host's picture after a model joined in that way and host geometry after it; null: a host alone.
    osg::ref_ptr<osg::Image> hostWith(const osg::ref_ptr<osg::Node>& model, Way way, bool usesLists)
    {
        ViewerGLTest::TearDown(); // a viewer of its own
        ViewerGLTest::SetUp();
        const osg::ref_ptr<osg::Group> root = new osg::Group;
        root->addChild(makeHost(-1, usesLists));
        viewer().setSceneData(root);
        if (way == Way::CompiledOnRealize && model) root->addChild(model);
        const osg::ref_ptr<osgUtil::IncrementalCompileOperation> compiler = new osgUtil::IncrementalCompileOperation;
        drawAt(0.0);
        if (way == Way::CompiledIncrementally) viewer().setIncrementalCompileOperation(compiler);
        GlCallTrace trace(state());
        trace.watchBindings(false); // the studio's shadow has a framebuffer of its own
        if (way == Way::Added && model) root->addChild(model);
        if (way == Way::CompiledIncrementally && model)
        {
            compiler->add(new osgUtil::IncrementalCompileOperation::CompileSet(root, model));
            for (int frame = 0; frame < 100 && model->getNumParents() == 0; ++frame)
                drawAt(0.01 * frame);
        }
        EXPECT_TRUE(!model || model->getNumParents() == 1) << "it joined";
        root->addChild(makeHost(1, usesLists));
        for (const double time : {1.0, 1.1, 1.2})
            drawAt(time);
        EXPECT_GT(trace.bindingChecks(), 20);
        for (const std::string& difference : trace.bindingDifferences())
            ADD_FAILURE() << difference;
        osg::ref_ptr<osg::Image> seen = picture().copy();
        return seen;
    }

private:
    ScratchFolder _folder;
};

TEST_P(JoiningModelsGLTest, leavesTheHostAsItIs)
{
    for (const auto& [wayName, way] : ways)
        for (const bool usesLists : {true, false})
        {
            SCOPED_TRACE(testing::Message() << wayName << (usesLists ? ", display lists" : ", client arrays"));
            const osg::ref_ptr<osg::Node> model = makeModel();
            ASSERT_TRUE(model);
            const osg::ref_ptr<osg::Image> alone = hostWith(nullptr, way, usesLists);
            const osg::ref_ptr<osg::Image> together = hostWith(model, way, usesLists);
            const osg::Vec4 color = usesLists ? osg::Vec4(1, 0, 0, 1) : osg::Vec4(0, 1, 0, 1);
            for (int y = 0; y < alone->t(); ++y)
                for (int x = 3 * alone->s() / 4; x < alone->s(); ++x)
                    ASSERT_EQ(together->getColor(x, y), color) << x << ' ' << y << ": before it below, after it above";
            EXPECT_GT(Picture::pixelsDifferent(*together, *alone), 20) << "it is drawn";
        }
}

INSTANTIATE_TEST_SUITE_P(OfEachKind, JoiningModelsGLTest, ::testing::ValuesIn(modelKinds),
                         [](const auto& info) { return std::string(info.param.name); });

} // namespace

} // namespace osgGpuAnimation::gltf
