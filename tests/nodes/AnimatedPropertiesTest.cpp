// SPDX-License-Identifier: MIT
#include "nodes/Tube.h"

#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/mesh/geometry/MaterialVariants.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/properties/AnimatedProperties.h>

#include <gtest/gtest.h>
#include <osg/Light>
#include <osg/LightSource>

// A character whose set animates the red of material 0 (at rest 0.5) and the visibility of node 5 (at rest visible).

namespace osgGpuAnimation
{

namespace
{

std::shared_ptr<const AnimationSet> propertySet()
{
    const auto arm = armSet();
    AnimationParts parts{arm->skeleton(), arm->skins(), arm->rigidJoints(), {}, {}, {}};
    MorphWeights color, visible;
    color.name = "/materials/0/pbrMetallicRoughness/baseColorFactor";
    color.defaults.assign(4, 0.5f);
    visible.name = "/nodes/5/extensions/KHR_node_visibility/visible";
    visible.defaults.assign(1, 1.0f);
    parts.morphs = {color, visible};
    return AnimationSet::create(std::move(parts)).value();
}

osg::ref_ptr<osg::StateSet> makeMaterial()
{
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    state->addUniform(new osg::Uniform("baseColorFactor", osg::Vec4(1, 0, 0, 1)));
    markMaterial(*state, 0);
    return state;
}

osg::Geometry& meshOf(osg::Group& group, unsigned int child = 0)
{
    return dynamic_cast<osg::Geometry&>(*group.getChild(child));
}

float redOf(osg::Group& group, unsigned int child = 0)
{
    osg::Vec4 color;
    meshOf(group, child).getStateSet()->getUniform("baseColorFactor")->get(color);
    return color.x();
}

osg::ref_ptr<AnimatedCharacter> makePainted()
{
    osg::ref_ptr<AnimatedCharacter> character = new AnimatedCharacter(propertySet());
    character->addChild(makeTube(character->getAnimationSet()));
    meshOf(*character).setName("arm");
    meshOf(*character).setStateSet(makeMaterial());
    markVisibility(meshOf(*character), {5});
    return character;
}

osg::ref_ptr<AnimatedCharacter> cloneOf(const AnimatedCharacter& character)
{
    return osg::clone(&character, osg::CopyOp::DEEP_COPY_NODES);
}

void pose(AnimatedCharacter& character, float red, bool isVisible)
{
    AnimationLayer& layer = character.getController().layer(1);
    EXPECT_TRUE(layer.pose().setMorphWeight(0, 0, red));
    EXPECT_TRUE(layer.pose().setMorphWeight(1, 0, isVisible ? 1.0f : 0.0f));
    layer.setWeight(1.0f);
    EXPECT_TRUE(layer.showPose(0.0));
    character.update(0.0);
}

osg::Light& lightOf(AnimatedCharacter& character)
{
    return *dynamic_cast<osg::LightSource&>(*character.getChild(1)).getLight();
}

} // namespace

TEST(AnimatedPropertiesTest, hiddenLightsLightAgainInCopies)
{
    const osg::ref_ptr<AnimatedCharacter> body = makePainted();
    const osg::ref_ptr<osg::LightSource> lamp = new osg::LightSource;
    lamp->setLight(new osg::Light(3));
    lamp->getLight()->setDiffuse(osg::Vec4(1, 1, 1, 1));
    markVisibility(*lamp, {5});
    body->addChild(lamp);
    pose(*body, 0.5f, false);
    EXPECT_EQ(lightOf(*body).getDiffuse().x(), 0.0f);
    const osg::ref_ptr<AnimatedCharacter> other = cloneOf(*body),
                                          copy = osg::clone(body.get(), osg::CopyOp::DEEP_COPY_ALL);
    ASSERT_TRUE(body->getMeshes().setVariant("")); // looks for the lights again
    for (AnimatedCharacter* character : {body.get(), other.get(), copy.get()})
    {
        EXPECT_EQ(lightOf(*character).getDiffuse().x(), 0.0f);
        pose(*character, 0.5f, true);
        EXPECT_EQ(lightOf(*character).getDiffuse().x(), 1.0f);
    }
}

TEST(AnimatedPropertiesTest, meshesAreVisibleIfClipAndApplicationShowThem)
{
    const osg::ref_ptr<AnimatedCharacter> body = makePainted();
    meshOf(*body).setNodeMask(0xF0);
    for (const bool showsApplication : {false, true, false, true})
        for (const bool showsClip : {true, false, true, false})
        {
            const osg::Node::NodeMask expected = showsApplication && showsClip ? 0xF0u : 0u;
            ASSERT_TRUE(body->getMeshes().setVisible("arm", showsApplication));
            pose(*body, 0.5f, showsClip);
            EXPECT_EQ(meshOf(*body).getNodeMask(), expected);
            ASSERT_TRUE(body->getMeshes().setVisible("arm", showsApplication));
            ASSERT_TRUE(body->getMeshes().setVariant(""));
            EXPECT_EQ(meshOf(*body).getNodeMask(), expected);
            const osg::ref_ptr<AnimatedCharacter> other = cloneOf(*body);
            pose(*other, 0.5f, true);
            EXPECT_EQ(meshOf(*other).getNodeMask(), showsApplication ? 0xF0u : 0u);
            EXPECT_EQ(meshOf(*body).getNodeMask(), expected);
            ASSERT_TRUE(other->getMeshes().setVisible("arm", true));
            EXPECT_EQ(meshOf(*other).getNodeMask(), 0xF0u);
        }
}

TEST(AnimatedPropertiesTest, meshesHiddenAtRestAreImportedWithMask0)
{
    const osg::ref_ptr<AnimatedCharacter> body = makePainted();
    meshOf(*body).setNodeMask(0);
    ASSERT_TRUE(body->getMeshes().setVariant(""));
    pose(*body, 0.5f, true);
    EXPECT_EQ(meshOf(*body).getNodeMask(), ~0u);
}

TEST(AnimatedPropertiesTest, garmentsDoNotTakeTheMaterialsOfTheBody)
{
    const osg::ref_ptr<AnimatedCharacter> body = makePainted(), garment = makePainted();
    osg::Geometry& coat = meshOf(*garment);
    const osg::ref_ptr<osg::StateSet> plain = coat.getStateSet(), red = makeMaterial();
    setVariantStates(coat, plain, {{"red", red}});
    pose(*garment, 0.25f, false);
    EXPECT_EQ(meshOf(*garment).getNodeMask(), 0u);
    ASSERT_TRUE(body->wear(garment));
    pose(*garment, 0.125f, false);
    pose(*body, 0.75f, false);
    EXPECT_EQ(redOf(*body), 0.75f);
    EXPECT_EQ(redOf(*body, 1), 0.5f) << "at rest";
    EXPECT_NE(meshOf(*body, 1).getNodeMask(), 0u);
    ASSERT_TRUE(body->getMeshes().setVariant("red"));
    pose(*body, 0.75f, true);
    EXPECT_EQ(redOf(*body, 1), 0.5f);
    pose(*garment, 0.375f, true);
    EXPECT_EQ(redOf(*garment), 0.375f) << "the garment stays what it was";
}

TEST(AnimatedPropertiesTest, variantsPlayOnWhenAGarmentIsWorn)
{
    const osg::ref_ptr<AnimatedCharacter> body = makePainted(), garment = makeTubeCharacter(armSet());
    osg::Geometry& arm = meshOf(*body);
    const osg::ref_ptr<osg::StateSet> plain = arm.getStateSet();
    setVariantStates(arm, plain, {{"red", makeMaterial()}});
    ASSERT_TRUE(body->getMeshes().setVariant("red"));
    pose(*body, 0.25f, true);
    ASSERT_TRUE(body->wear(garment));
    EXPECT_EQ(redOf(*body), 0.25f);
    pose(*body, 0.75f, true);
    EXPECT_EQ(redOf(*body), 0.75f);
}

TEST(AnimatedPropertiesTest, crowdsShowMeshesAtRest)
{
    const osg::ref_ptr<AnimatedCharacter> body = makePainted();
    meshOf(*body).setNodeMask(0xF0);
    pose(*body, 0.25f, false);
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*body);
    pose(*body, 0.125f, false);
    EXPECT_EQ(redOf(*crowd), 0.5f);
    EXPECT_EQ(meshOf(*crowd).getNodeMask(), 0xF0u);
    EXPECT_EQ(meshOf(*crowd).getStateSet()->getDataVariance(), osg::Object::STATIC);
    EXPECT_EQ(redOf(*body), 0.125f);
}

} // namespace osgGpuAnimation
