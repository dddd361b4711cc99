// SPDX-License-Identifier: MIT
#include "frame/GlCallTrace.h"
#include "looks/StudioPanorama.h"
#include "support/NotifyLog.h"
#include "support/TestCharacter.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/looks/Environment.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <layout.glsl>

#include <osg/Geometry>
#include <osg/TextureBuffer>
#include <osgUtil/GLObjectsVisitor>

// What the kit binds past osg::State is bound no longer, or recorded, when its callbacks return: a host's next
// geometry may read client arrays, which GL takes for offsets while a buffer is bound.

namespace osgGpuAnimation
{

namespace
{

osg::ref_ptr<osg::Node> makeTwins()
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    for (int i = 0; i < 9; ++i)
        group->addChild(makeTestCharacter());
    return group;
}

osg::ref_ptr<osg::Node> makeMorphing()
{
    osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    osg::ref_ptr<SkinnedGeometry> square = makeTestSquare(1);
    const osg::ref_ptr<osg::Vec3Array> deltas = new osg::Vec3Array(square->getVertexArray()->getNumElements());
    square->setMorphTargets(0, 0, {MorphTarget{deltas, {}, {}, {}, {}}});
    character->addChild(square);
    return character;
}

osg::ref_ptr<osg::Node> makeConstrained()
{
    osg::ref_ptr<AnimatedCharacter> character = makeTestCharacter();
    const auto set = character->getAnimationSet().withConstraints({LookAt{"look", {"base"}}});
    EXPECT_TRUE(set && character->setAnimationSet(set.value()));
    EXPECT_TRUE(character->constraint("look").setWorldTarget(osg::Vec3d(1, -9, 2)));
    return character;
}

/// isShared: the instances play one clip in a loop, so they share poses.
osg::ref_ptr<osg::Node> makeCrowd(bool isShared)
{
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*makeTestCharacter());
    AnimationController controller(crowd->getSharedAnimationSet());
    EXPECT_TRUE(controller.play("turn"));
    EXPECT_TRUE(isShared || controller.crossfade("shift", 100.0));
    for (int i = 0; i < 9; ++i)
        EXPECT_TRUE(crowd->add(osg::Matrix::translate(0.2 * i, 0, 1), controller, {1, 0, 0, 1}));
    return crowd;
}

osg::ref_ptr<osg::Node> makeSurrounded()
{
    const osg::ref_ptr<Environment> surroundings = new Environment;
    EXPECT_TRUE(surroundings->setPanorama(makePanorama(16, studioRadiance)));
    surroundings->addChild(makeTestCharacter());
    return surroundings;
}

struct Scene
{
    const char* name;
    osg::ref_ptr<osg::Node> (*make)();
};

const Scene scenes[] = {
    {"characters drawn together", makeTwins},
    {"morph targets", makeMorphing},
    {"a constraint", makeConstrained},
    {"a crowd of shared poses", [] { return makeCrowd(true); }},
    {"a crowd of own poses", [] { return makeCrowd(false); }},
    {"surroundings from a picture", makeSurrounded},
};

/// A host's scene: a drawable in a bin before and one in a bin after the kit's, and for all that is below, buffer
/// textures, also at the kit's units.
osg::ref_ptr<osg::Group> makeHost()
{
    osg::ref_ptr<osg::Group> host = new osg::Group;
    for (const int bin : {-1, 1})
    {
        const osg::ref_ptr<osg::Geometry> geometry =
            osg::createTexturedQuadGeometry({2, -5, 2}, {0.5f, 0, 0}, {0, 0, 0.5f});
        geometry->getOrCreateStateSet()->setRenderBinDetails(bin, "RenderBin");
        host->addChild(geometry);
    }
    const osg::ref_ptr<osg::Image> texels = new osg::Image;
    texels->allocateImage(4, 1, 1, GL_RGBA, GL_FLOAT);
    texels->setInternalTextureFormat(GL_RGBA32F_ARB);
    const osg::ref_ptr<osg::TextureBuffer> texture = new osg::TextureBuffer(texels);
    texture->setInternalFormat(GL_RGBA32F_ARB);
    for (const unsigned int unit : {0, 1, POSE_PALETTE_UNIT, POSE_TINT_UNIT, POSE_DRAWN_UNIT})
        host->getOrCreateStateSet()->setTextureAttribute(unit, texture);
    return host;
}

struct PipelineCase
{
    const char* name;
    bool isCore;
    bool isCompiled; ///< before it joins
    PosePipeline::Form form;
    std::size_t chunkSize;
};

const PipelineCase pipelines[] = {
    {"fused", false, false, PosePipeline::Form::Fused, PosePipeline::usualChunkSize},
    {"fused, core profile", true, false, PosePipeline::Form::Fused, PosePipeline::usualChunkSize},
    {"fused, core profile, compiled", true, true, PosePipeline::Form::Fused, PosePipeline::usualChunkSize},
    {"fused, chunks of four", false, true, PosePipeline::Form::Fused, 4},
    {"separate, chunks of four", false, false, PosePipeline::Form::Separate, 4},
};

class BindingsGLTest : public ViewerGLTest
{
protected:
    osg::ref_ptr<osg::GraphicsContext::Traits> traits() const override
    {
        osg::ref_ptr<osg::GraphicsContext::Traits> wanted = ViewerGLTest::traits();
        wanted->glContextProfileMask = _isCore ? 1 : 0;
        wanted->glContextVersion = _isCore ? "3.3" : "1.0";
        return wanted;
    }

    void changeTo(bool isCore)
    {
        ViewerGLTest::TearDown();
        _isCore = isCore;
        ViewerGLTest::SetUp();
        if (!_isCore) return;
        // With the fixed pipeline OSG sets a Material here, which is an error in the core profile.
        viewer().getCamera()->getOrCreateStateSet()->clear();
        viewer().setLightingMode(osg::View::NO_LIGHT);
    }

    /// Draws frames of the host alone, then from the scene's first on.
    void expectRecorded(const Scene& scene, const PipelineCase& pipeline)
    {
        const osg::ref_ptr<NotifyLog> log = new NotifyLog(osg::WARN);
        osg::setNotifyHandler(log);
        const osg::ref_ptr<osg::Group> root = makeHost();
        viewer().getCamera()->setFinalDrawCallback(nullptr);
        viewer().setSceneData(root);
        drawAt(0.0);
        PosePipeline::of(state())->options().form = pipeline.form;
        PosePipeline::of(state())->options().chunkSize = pipeline.chunkSize;
        GlCallTrace trace(state());
        trace.watchBindings(true);
        drawAt(0.1);
        // In the core profile, OSG keeps a record of a buffer that it has unbound since it compiled the host's
        // geometry.
        const std::set<std::string> ofHost = trace.bindingDifferences();
        const osg::ref_ptr<osg::Node> joining = scene.make();
        osgUtil::GLObjectsVisitor compiler;
        compiler.setState(&state());
        if (pipeline.isCompiled) joining->accept(compiler);
        root->addChild(joining);
        for (const double time : {0.2, 0.3, 0.4})
            drawAt(time);
        joining->releaseGLObjects(&state());
        osg::flushAllDeletedGLObjects(state().getContextID());
        for (const double time : {0.5, 0.6})
            drawAt(time);
        osg::setNotifyHandler(new osg::StandardNotifyHandler);
        if (_isCore) takeGLErrors(); // of the host, which has no program
        EXPECT_TRUE(_isCore || log->text.empty()) << log->text;
        EXPECT_GT(trace.bindingChecks(), 40);
        for (const std::string& difference : trace.bindingDifferences())
            EXPECT_EQ(ofHost.count(difference), 1u) << difference;
    }

private:
    bool _isCore = false;
};

TEST_F(BindingsGLTest, areWhatOsgRecordedAfterEveryCallback)
{
    for (const PipelineCase& pipeline : pipelines)
        for (const Scene& scene : scenes)
        {
            SCOPED_TRACE(testing::Message() << scene.name << ", " << pipeline.name);
            changeTo(pipeline.isCore);
            if (HasFatalFailure() || IsSkipped()) return;
            expectRecorded(scene, pipeline);
        }
}

} // namespace

} // namespace osgGpuAnimation
