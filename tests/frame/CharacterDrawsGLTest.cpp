// SPDX-License-Identifier: MIT
#include "frame/GlCallTrace.h"
#include "support/TestCharacter.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/gpu/PosePipeline.h>

#include <osg/Group>
#include <osg/Material>

#include <functional>

namespace osgGpuAnimation
{

namespace
{

constexpr int everybody = 24;

/// Rotated, scaled and partly mirrored, so that wrong placements and normals are visible.
osg::Matrixd placeOf(int index)
{
    const double size = 0.5 + 0.05 * (index % 5);
    return osg::Matrixd::scale(index % 4 == 3 ? -size : size, size, 1.5 * size) *
           osg::Matrixd::rotate(0.4 * (index % 7) - 1.2, osg::Vec3d(0.3, 0.2, 1)) *
           osg::Matrixd::translate(-3.5 + 1.1 * (index % 6), 0.1 * index, -3.5 + 1.6 * (index / 6));
}

/// Lit characters of one mesh, each in its own pose.
osg::ref_ptr<osg::Group> makeCharacters(int count)
{
    osg::ref_ptr<AnimatedCharacter> first = makeTestCharacter();
    osg::StateSet* state = first->getChild(0)->getStateSet();
    state->getUniform("unlit")->set(false);
    state->setAttributeAndModes(new osg::Material);
    first->addChild(makeTestSquare(2));
    first->computeClipBounds();
    osg::ref_ptr<osg::Group> group = new osg::Group;
    for (int index = 0; index < count; ++index)
    {
        osg::ref_ptr<AnimatedCharacter> character = osg::clone(first.get(), osg::CopyOp::DEEP_COPY_NODES);
        EXPECT_TRUE(character->getController().play(index % 3 ? "shift" : "turn"));
        character->getController().seek(0.07 * index);
        character->setMatrix(placeOf(index));
        group->addChild(character);
    }
    return group;
}

AnimatedCharacter& characterOf(osg::Group& group, int index)
{
    return static_cast<AnimatedCharacter&>(*group.getChild(static_cast<unsigned int>(index)));
}

class CharacterDrawsGLTest : public ViewerGLTest
{
protected:
    osg::ref_ptr<osg::Image> pictureOf(osg::Group& scene, bool isTogether)
    {
        for (int index = 0; index < everybody; ++index)
            characterOf(scene, index).setDrawnTogether(isTogether);
        viewer().setSceneData(&scene);
        drawAt(0.0);
        drawAt(0.0);
        return picture().copy();
    }

    /// The number of draw calls in a frame; the poses are already computed.
    int drawsOf(osg::Group& scene)
    {
        viewer().setSceneData(&scene);
        drawAt(0.0);
        drawAt(0.0);
        const GlCallTrace trace(state());
        drawAt(0.0);
        return trace.count("glDrawArrays") + trace.count("glDrawArraysInstanced");
    }
};

struct Change
{
    const char* name;
    std::function<void(osg::Group&)> make;
    int draws; ///< for 24 characters with two meshes
};

osg::StateSet* meshState(osg::Group& group, unsigned int mesh)
{
    return characterOf(group, 0).getChild(mesh)->getOrCreateStateSet();
}

osg::ref_ptr<osg::Program> programWithoutSkinning()
{
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(osg::Shader::VERTEX, R"(#version 140
        #extension GL_ARB_compatibility : enable
        uniform mat4 osg_ModelViewProjectionMatrix;
        void main() { gl_Position = gl_ModelViewProjectionMatrix * gl_Vertex; })"));
    program->addShader(new osg::Shader(osg::Shader::FRAGMENT, R"(#version 140
        out vec4 color;
        void main() { color = vec4(1.0, 0.5, 0.0, 1.0); })"));
    return program;
}

const Change changes[] = {
    {"alike: the first, and the others together", [](osg::Group&) {}, 2 + 2},
    {"a state of their own",
     [](osg::Group& group)
     {
         for (int index = 0; index < everybody; index += 2)
             characterOf(group, index).getOrCreateStateSet()->setMode(GL_CULL_FACE, osg::StateAttribute::ON);
     },
     2 * everybody / 2 + 2 + 2},
    {"a mesh sorted by depth",
     [](osg::Group& group) { meshState(group, 1)->setRenderingHint(osg::StateSet::TRANSPARENT_BIN); },
     everybody + 1 + 1},
    {"everything sorted by depth",
     [](osg::Group& group) { group.getOrCreateStateSet()->setRenderingHint(osg::StateSet::TRANSPARENT_BIN); },
     2 * everybody},
    {"a mesh with a callback",
     [](osg::Group& group) { characterOf(group, 0).getChild(0)->setCullCallback(new osg::NodeCallback); },
     everybody + 1 + 1},
    {"a mesh that is masked out", [](osg::Group& group) { characterOf(group, 0).getChild(0)->setNodeMask(0); }, 1 + 1},
    {"half of them with another set",
     [](osg::Group& group)
     {
         const AnimationSet& set = characterOf(group, 0).getAnimationSet();
         const auto other = set.withClips(set.clips()).value();
         for (int index = 0; index < everybody; index += 2)
             EXPECT_TRUE(characterOf(group, index).setAnimationSet(other));
     },
     2 * (2 + 2)},
    {"one has lost a mesh", [](osg::Group& group) { characterOf(group, 5).removeChild(1); }, 2 + 2},
    {"each shows some of the meshes",
     [](osg::Group& group)
     {
         for (unsigned int mesh = 0; mesh < 2; ++mesh)
             characterOf(group, 0).getChild(mesh)->setName(mesh == 0 ? "one" : "two"); // clones share it
         for (int index = 0; index < everybody; ++index)
         {
             CharacterMeshes& meshes = characterOf(group, index).getMeshes();
             if (index % 3 == 2) continue;
             EXPECT_TRUE(meshes.setVisible(index % 3 == 0 ? "one" : "two", false));
         }
     },
     2 + 2},
    {"some with callbacks of their own",
     [](osg::Group& group)
     {
         for (int index = 1; index < everybody; index += 3)
             characterOf(group, index).setCullCallback(new osg::NodeCallback);
     },
     2 + 2},
    {"other things below them",
     [](osg::Group& group)
     {
         osg::ref_ptr<osg::Group> below = new osg::Group;
         below->addChild(makeTestSquare(2));
         for (int index = 0; index < everybody; ++index)
             characterOf(group, index).addChild(below);
     },
     everybody + 2 + 2},
    {"a program that knows nothing of it",
     [](osg::Group& group)
     {
         for (unsigned int mesh = 0; mesh < 2; ++mesh)
             meshState(group, mesh)->setAttributeAndModes(programWithoutSkinning());
     },
     2 * everybody},
    {"one nowhere",
     [](osg::Group& group) { characterOf(group, 7).setMatrix(osg::Matrixd::translate(std::nan(""), 0.0, 0.0)); },
     2 + 2},
    {"some out of sight",
     [](osg::Group& group)
     {
         for (int index = 0; index < everybody; index += 5)
             characterOf(group, index).setMatrix(osg::Matrixd::translate(100.0, 0.0, 0.0));
     },
     2 + 2},
};

TEST_F(CharacterDrawsGLTest, drawnTogetherTheyLookAsOneByOne)
{
    for (const Change& change : changes)
    {
        SCOPED_TRACE(change.name);
        const osg::ref_ptr<osg::Group> scene = makeCharacters(everybody);
        change.make(*scene);
        const osg::ref_ptr<osg::Image> apart = pictureOf(*scene, false);
        EXPECT_GT(picture().pixelsDrawn(), 300);
        const osg::ref_ptr<osg::Image> together = pictureOf(*scene, true);
        // Placements are floats in shared draws and doubles in single ones: edge pixels may differ.
        EXPECT_LE(Picture::pixelsDifferent(*apart, *together), 8);
        EXPECT_EQ(drawsOf(*scene), change.draws);
    }
}

TEST_F(CharacterDrawsGLTest, nearAndFarAreFittedToAll)
{
    const osg::ref_ptr<osg::Group> scene = makeCharacters(everybody);
    viewer().getCamera()->setComputeNearFarMode(osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES);
    viewer().getCamera()->setProjectionMatrixAsPerspective(45.0, 1.0, 1.0, 2.0);
    const osg::ref_ptr<osg::Image> apart = pictureOf(*scene, false);
    EXPECT_LE(Picture::pixelsDifferent(*apart, *pictureOf(*scene, true)), 8);
    viewer().getCamera()->setComputeNearFarMode(osg::CullSettings::COMPUTE_NEAR_FAR_USING_PRIMITIVES);
    EXPECT_EQ(drawsOf(*scene), 2 * everybody);
}

TEST_F(CharacterDrawsGLTest, chunksOfPalettesAreDrawnOneAfterAnother)
{
    const osg::ref_ptr<osg::Group> scene = makeCharacters(everybody);
    const osg::ref_ptr<osg::Image> whole = pictureOf(*scene, true);
    const std::size_t texels = PosePipeline::of(state())->options().maxTexels;
    PosePipeline::of(state())->options().maxTexels = 6 * 3 * testCharacterSet()->paletteSize(); // six per chunk
    drawAt(0.0);
    EXPECT_LE(Picture::pixelsDifferent(*whole, picture().image()), 0);
    EXPECT_EQ(drawsOf(*scene), 2 + 2 * 4);
    PosePipeline::of(state())->options().maxTexels = texels;
}

} // namespace

} // namespace osgGpuAnimation
