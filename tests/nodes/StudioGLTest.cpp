// SPDX-License-Identifier: MIT
#include "looks/StudioPanorama.h"
#include "support/TestCharacter.h"
#include "support/ThreadingModels.h"
#include "support/ViewerGLTest.h"

#include <osgGpuAnimation/looks/PbrMaterial.h>
#include <osgGpuAnimation/nodes/studio/Studio.h>
#include <osgGpuAnimation/nodes/viewing/RaisedHome.h>

#include <osg/ComputeBoundsVisitor>
#include <osgGA/TrackballManipulator>
#include <osgUtil/IntersectionVisitor>
#include <osgUtil/LineSegmentIntersector>
#include <osgViewer/CompositeViewer>

#include <algorithm>
#include <cmath>
#include <utility>

namespace osgGpuAnimation
{

namespace
{

/// The test character's square stands on the ground, at first with its left edge at the origin; its clip moves it by 2
/// units along +X in 2 seconds. The camera looks straight down on it, +Y up in the picture.
class StudioGLTest : public ViewerGLTest, public ::testing::WithParamInterface<bool>
{
protected:
    int pictureSide() const override { return 128; }

    osg::ref_ptr<Studio> makeScene()
    {
        osg::ref_ptr<Studio> studio = new Studio;
        studio->addChild(makeTestCharacter());
        viewer().getCamera()->setViewMatrixAsLookAt({1, 0, 10}, {1, 0, 0}, {0, 1, 0});
        if (GetParam()) viewer().getCamera()->setProjectionMatrixAsPerspective(45.0, 1.0, 0.5, 5000.0);
        return studio;
    }

    /// The brightness of a point on the ground, relative to that of one far from the model in the same row.
    double brightness(const osg::Image& image, double x, double y)
    {
        const osg::Camera& camera = *viewer().getCamera();
        const osg::Matrix toPixels =
            camera.getViewMatrix() * camera.getProjectionMatrix() * camera.getViewport()->computeWindowMatrix();
        const auto greenAt = [&](const osg::Vec3d& point)
        {
            const osg::Vec3d pixel = point * toPixels;
            return image.getColor(static_cast<int>(pixel.x()), static_cast<int>(pixel.y())).g();
        };
        return greenAt({x, y, 0}) / greenAt({-2.8, y, 0});
    }
};

TEST_P(StudioGLTest, theShadowLiesBehindTheModelAndFollowsItsPose)
{
    const osg::ref_ptr<Studio> studio = makeScene();
    // The light comes from (0.6, -0.9, 1.1): a point at height z casts its shadow 0.55 z to the left, 0.82 z behind.
    for (const double time : {0.0, 1.5})
    {
        const osg::ref_ptr<osg::Image> image = pictureOf(studio, {0.0, time});
        const double here = time + 0.3, there = 1.5 - time + 0.3;
        EXPECT_LT(brightness(*image, here, 0.3), 0.85) << time;
        EXPECT_GT(brightness(*image, there, 0.3), 0.97) << time;
        EXPECT_GT(brightness(*image, here, -0.7), 0.97) << "in front of the model " << time;
        EXPECT_LT(brightness(*image, here, 1.9), 1.2) << "the ground fades into the backdrop " << time;
    }
}

/// A low sun, and a grey sky around it. towards: glTF's axes.
osg::ref_ptr<osg::Image> sunnySky(osg::Vec3f towards, float strength = 200.0f)
{
    towards.normalize();
    return makePanorama(256, [towards, strength](const osg::Vec3f& d)
                        { return osg::Vec3f(1, 1, 1) * (0.3f + strength * std::exp(400.0f * (d * towards - 1.0f))); });
}

TEST_P(StudioGLTest, inSurroundingsFromAPictureTheShadowIsThatOfTheirBrightestLight)
{
    const osg::ref_ptr<Studio> studio = makeScene();
    const auto expectShadow = [&](bool isBehind, bool isInFront)
    {
        const osg::ref_ptr<osg::Image> image = pictureOf(studio, {0.0});
        EXPECT_EQ(brightness(*image, 0.5, 0.5) < 0.85, isBehind);
        EXPECT_EQ(brightness(*image, 0.5, -0.5) < 0.85, isInFront);
        return brightness(*image, 0.5, -0.5);
    };
    expectShadow(true, false);
    ASSERT_TRUE(studio->setPanorama(sunnySky({0, 1, -1}))); // behind the model
    const double dark = expectShadow(false, true);
    ASSERT_TRUE(studio->setPanorama(sunnySky({0, 1, -1}, 20.0f)));
    EXPECT_GT(expectShadow(false, true), dark + 0.1) << "as dark as the light is strong";
    studio->setRotation(osg::PIf);
    expectShadow(true, false);
    ASSERT_TRUE(studio->setPanorama(makePanorama(64, [](const osg::Vec3f&) { return osg::Vec3f(1, 1, 1); })));
    expectShadow(false, false);
    studio->setStudio();
    studio->setRotation(0.0f);
    expectShadow(true, false);
}

/// A level rectangle.
osg::ref_ptr<osg::Node> plate(const osg::Vec3& corner, float side)
{
    return osg::createTexturedQuadGeometry(corner, {side, 0, 0}, {0, side, 0});
}

// The key light is 0.16 times as wide as it is far, to either side. The edge of a plate at height z is 1.40 z from its
// shadow, whose ellipses are 1.29 times as long along Y as across the light; the middle half of the light is lost over
// 0.81 of a disk's radius.
TEST_P(StudioGLTest, theEdgeOfAShadowIsAsSoftAsItsCasterIsHigh)
{
    const osg::ref_ptr<Studio> studio = new Studio;
    studio->addChild(plate({0.5f, -3.5f, 0}, 0.1f)); // on the ground
    studio->addChild(plate({-2, -2, 0.5f}, 2));
    studio->addChild(plate({1.5f, -3, 1.5f}, 3));
    const std::pair<double, double> edges[] = {{-1.3, 0.5}, {2.2, 1.5}}; // along X, and their heights
    for (const auto& [x, height] : edges)
    {
        const double y = 0.82 * height;
        viewer().getCamera()->setViewMatrixAsLookAt({x, y, 10}, {x, y, 0}, {0, 1, 0});
        viewer().getCamera()->setProjectionMatrixAsOrtho(-1, 1, -1, 1, 1, 20);
        const osg::ref_ptr<osg::Image> image = pictureOf(studio, {0.0});
        std::vector<double> light; // by row, upwards: the share of the light of the backdrop
        for (int row = 0; row < image->t(); ++row)
        {
            double sum = 0.0;
            for (int column = 48; column < 80; ++column)
                sum += static_cast<double>(linearColor(image->getColor(column, row)).g());
            const float backdrop = 0.74f + 0.19f * (static_cast<float>(row) + 0.5f) / static_cast<float>(image->t());
            light.push_back(sum / static_cast<double>(32.0f * linearColor({0, backdrop, 0, 1}).g()));
        }
        const auto first = light.begin() + 64 - static_cast<std::ptrdiff_t>(0.7 * y * 64); // beside the plate
        const auto [darkest, brightest] = std::minmax_element(first, light.end());
        const auto rowOf = [&, low = *darkest, high = *brightest](double share)
        {
            const double wanted = low + share * (high - low);
            const auto above = std::find_if(std::min_element(first, light.end()), light.end(),
                                            [=](double value) { return value > wanted; });
            return static_cast<double>(above - light.begin()) - (*above - wanted) / (*above - *(above - 1));
        };
        const double width = (rowOf(0.75) - rowOf(0.25)) / 64.0;
        const double expected = 0.81 * 0.16 * 1.40 * 1.29 * height;
        EXPECT_NEAR(width, expected, 0.1 * expected) << height;
    }
}

TEST_P(StudioGLTest, theApplicationsLightsDoNotShine)
{
    osg::ref_ptr<Studio> studio = makeScene();
    viewer().setLightingMode(osg::View::HEADLIGHT);
    const osg::ref_ptr<osg::Image> lit = pictureOf(studio, {0.0});
    viewer().setLightingMode(osg::View::NO_LIGHT);
    EXPECT_EQ(Picture::pixelsDifferent(*lit, *pictureOf(studio, {0.0}), 0.0f), 0);
}

TEST_P(StudioGLTest, groundAndBackdropAreInNoBoundsAndCannotBeHit)
{
    const osg::ref_ptr<Studio> studio = makeScene();
    pictureOf(studio, {0.0});
    ASSERT_TRUE(studio->getGround());
    EXPECT_NEAR(studio->getGround()->middle.z(), 0.0, 1e-5);
    osg::ComputeBoundsVisitor all, model;
    studio->accept(all);
    studio->getChild(0)->accept(model);
    EXPECT_EQ(all.getBoundingBox()._min, model.getBoundingBox()._min);
    EXPECT_EQ(all.getBoundingBox()._max, model.getBoundingBox()._max);
    osg::ref_ptr<osgUtil::LineSegmentIntersector> ray =
        new osgUtil::LineSegmentIntersector(osg::Vec3d(0.3, 0.3, 5.0), osg::Vec3d(0.3, 0.3, -5.0));
    osgUtil::IntersectionVisitor visitor(ray);
    studio->accept(visitor);
    EXPECT_FALSE(ray->containsIntersections());
}

TEST_P(StudioGLTest, anEmptyStudioShowsTheBackdrop)
{
    osg::ref_ptr<Studio> studio = makeScene();
    studio->removeChildren(0, 1);
    const osg::ref_ptr<osg::Image> image = pictureOf(studio, {0.0});
    EXPECT_FALSE(studio->getGround());
    EXPECT_NEAR(image->getColor(64, 127).g(), 0.93, 0.01);
    EXPECT_NEAR(image->getColor(64, 0).g(), 0.74, 0.01);
}

TEST_P(StudioGLTest, theHomeViewIsRaisedUnlessTheApplicationHasSetOne)
{
    for (const bool isSet : {false, true})
    {
        const osg::ref_ptr<Studio> studio = makeScene();
        viewer().getCamera()->setProjectionMatrixAsPerspective(30.0, 1.0, 1.0, 100.0);
        studio->addEventCallback(new RaisedHome);
        osg::ref_ptr<osgGA::TrackballManipulator> manipulator = new osgGA::TrackballManipulator;
        if (isSet) manipulator->setHomePosition({0, -20, 0}, {0, 0, 0}, {0, 0, 1});
        viewer().setSceneData(studio);
        viewer().setCameraManipulator(manipulator);
        drawAt(0.0);
        osg::Vec3d eye, middle, up, back(0.55, -1.0, 0.3);
        manipulator->getHomePosition(eye, middle, up);
        back.normalize();
        osg::Vec3d found = eye - middle;
        const double distance = found.normalize();
        EXPECT_NEAR((found - (isSet ? osg::Vec3d(0, -1, 0) : back)).length(), 0.0, 1e-6) << isSet;
        EXPECT_GT(distance, 1.0);
        EXPECT_LT(distance, isSet ? 20.1 : 8.0);
        viewer().setCameraManipulator(nullptr);
    }
}

/// A view of a viewer with its own window.
class StudioWindow
{
public:
    StudioWindow(osgViewer::CompositeViewer& viewer, osg::Node* scene, const osg::Camera& like, int side)
    {
        osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
        traits->width = traits->height = side;
        context = createOffscreenContext(traits).value();
        const osg::ref_ptr<osgViewer::View> view = new osgViewer::View;
        osg::Camera& camera = *view->getCamera();
        camera.setGraphicsContext(context);
        camera.setViewport(0, 0, side, side);
        camera.setProjectionMatrix(like.getProjectionMatrix());
        camera.setViewMatrix(like.getViewMatrix());
        camera.setComputeNearFarMode(like.getComputeNearFarMode());
        camera.setFinalDrawCallback(picture);
        view->setLightingMode(osg::View::NO_LIGHT);
        view->setSceneData(scene);
        viewer.addView(view);
    }

    osg::ref_ptr<osg::GraphicsContext> context;
    osg::ref_ptr<Picture> picture = new Picture;
};

TEST_P(StudioGLTest, severalWindowsShowTheSamePictureAlsoAfterAResize)
{
    const osg::ref_ptr<Studio> studio = makeScene();
    viewer().setLightingMode(osg::View::NO_LIGHT);
    ASSERT_TRUE(studio->setPanorama(sunnySky({0.6f, 1.1f, 0.9f})));
    const osg::ref_ptr<osg::Image> large = pictureOf(studio, {0.0, 0.5});
    viewer().getCamera()->setViewport(0, 0, 96, 96);
    const osg::ref_ptr<osg::Image> small = pictureOf(studio, {0.5});
    viewer().getCamera()->setViewport(0, 0, 128, 128);
    viewer().setSceneData(nullptr);
    context().releaseContext();
    for (const auto threading : threadingModels)
    {
        SCOPED_TRACE(threading);
        osgViewer::CompositeViewer both;
        both.setThreadingModel(threading);
        StudioWindow windows[] = {{both, studio, *viewer().getCamera(), 128},
                                  {both, studio, *viewer().getCamera(), 128}};
        both.realize();
        for (const double time : {0.0, 0.3, 0.5})
            both.frame(time);
        both.stopThreading();
        for (const StudioWindow& window : windows)
            EXPECT_EQ(Picture::pixelsDifferent(*large, window.picture->image()), 0);
        windows[1].context->resized(0, 0, 96, 96);
        both.startThreading();
        for (int frame = 0; frame < 3; ++frame)
            both.frame(0.5);
        both.stopThreading();
        EXPECT_EQ(Picture::pixelsDifferent(*large, windows[0].picture->image()), 0) << "not resized";
        EXPECT_EQ(Picture::pixelsDifferent(*small, windows[1].picture->image()), 0) << "resized";
        windows[1].context->close(); // the other one keeps its GL objects
        both.startThreading();
        both.frame(0.5);
        both.stopThreading();
        EXPECT_EQ(Picture::pixelsDifferent(*large, windows[0].picture->image()), 0) << "the other window is closed";
    }
    context().makeCurrent();
}

INSTANTIATE_TEST_SUITE_P(Projections, StudioGLTest, ::testing::Bool(),
                         [](const auto& info) { return info.param ? "perspective" : "parallel"; });

} // namespace

} // namespace osgGpuAnimation
