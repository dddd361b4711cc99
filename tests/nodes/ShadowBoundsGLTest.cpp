// SPDX-License-Identifier: MIT
#include "support/TestCharacter.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/LightSource>
#include <osgShadow/ShadowedScene>
#include <osgShadow/ShadowMap>

namespace osgGpuAnimation
{

namespace
{

/// osgShadow's technique, which fits the camera of its map to the bounds of the scene.
class FittedShadowMap : public osgShadow::ShadowMap
{
public:
    /// Half the height of what the map shows, at the distance of its middle, in units of the scene.
    double reach() const
    {
        double left, right, bottom, top, zNear, zFar;
        if (_camera->getProjectionMatrixAsOrtho(left, right, bottom, top, zNear, zFar) && right > 0.0) return top;
        if (!_camera->getProjectionMatrixAsFrustum(left, right, bottom, top, zNear, zFar)) return 0.0;
        return top / zNear * 0.5 * (zNear + zFar);
    }
};

class ShadowBoundsGLTest : public ViewerGLTest
{
protected:
    double reachOf(osg::Node* subject)
    {
        osg::ref_ptr<FittedShadowMap> technique = new FittedShadowMap;
        osg::ref_ptr<osg::LightSource> light = new osg::LightSource;
        light->getLight()->setPosition(osg::Vec4(-0.5f, -1.0f, 0.7f, 0.0f));
        osg::ref_ptr<osgShadow::ShadowedScene> scene = new osgShadow::ShadowedScene(technique);
        scene->addChild(subject);
        scene->addChild(light);
        pictureOf(scene, {0.0, 0.1});
        return technique->reach();
    }
};

TEST_F(ShadowBoundsGLTest, aShadowMapIsFittedToWhatPlays)
{
    const osg::ref_ptr<AnimatedCharacter> shifting = makeTestCharacter();
    const osg::ref_ptr<AnimatedCharacter> turning = osg::clone(shifting.get(), osg::CopyOp::DEEP_COPY_NODES);
    ASSERT_TRUE(turning->getController().play("turn"));
    for (const osg::ref_ptr<AnimatedCharacter>& character : {shifting, turning})
    {
        const double radius = static_cast<double>(character->getCurrentBounds().radius());
        EXPECT_NEAR(reachOf(character), radius, 0.05 * radius);
        const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*character);
        ASSERT_TRUE(crowd->add(osg::Matrixd::translate(1, 2, 3), character->getController()));
        EXPECT_NEAR(reachOf(crowd), radius, 0.05 * radius);
    }
}

} // namespace

} // namespace osgGpuAnimation
