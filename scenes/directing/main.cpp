// SPDX-License-Identifier: MIT
// Usage: direct_scenes SCENES FOLDER
// Reads SCENES/Wanderer.glb and draws into FOLDER, without a display: Crossfade.png, Mask.png, Additive.png and
// Attachment.png, each a row of wanderers, and Crowd.png, thousands of them. The plugin is looked for where
// OSG_LIBRARY_PATH says. Ends with 77 where there is no GL.

#include <osgGpuAnimation/animation/JointMask.h>
#include <osgGpuAnimation/gpu/EglGraphicsContext.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/CharacterProgram.h>
#include <osgGpuAnimation/nodes/Environment.h>
#include <osgGpuAnimation/nodes/JointAttachment.h>
#include <osgGpuAnimation/nodes/PbrMaterial.h>

#include <osg/PositionAttitudeTransform>
#include <osg/ShapeDrawable>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>
#include <osgViewer/Viewer>

#include <functional>
#include <iostream>
#include <random>
#include <string>

using namespace osgGpuAnimation;

namespace
{

constexpr int width = 900, height = 378;
constexpr double apart = 1.0; ///< metres from one wanderer to the next
constexpr int inARow = 5;

/// Sets up number i of the row.
using Direction = std::function<void(AnimatedCharacter& wanderer, int i)>;

/// Says what went wrong, if anything.
template <typename T>
bool succeeds(const Result<T>& result)
{
    if (!result) std::cerr << result.error().message << std::endl;
    return static_cast<bool>(result);
}

/// From Walk to Run in half a second: an eighth of it from each to the next. In phase the feet stay together.
void crossfade(AnimatedCharacter& wanderer, int i)
{
    AnimationController& controller = wanderer.getController();
    CrossfadeOptions options;
    options.sync = Sync::Phase;
    if (!succeeds(controller.play("Walk"))) return;
    controller.seek(0.1);
    if (succeeds(controller.crossfade("Run", 0.5, options))) controller.advance(0.125 * i);
}

/// All walk alike; the right arm of the others waves as well, from the shoulder on.
void maskedWave(AnimatedCharacter& wanderer, int i)
{
    AnimationController& controller = wanderer.getController();
    if (!succeeds(controller.play("Walk"))) return;
    controller.seek(0.3);
    if (i == 0) return;
    const Result<JointMask> arm = JointMask::subtree(wanderer.getAnimationSet(), "Shoulder_R", 1);
    if (!succeeds(arm)) return;
    AnimationLayer& gesture = controller.layer(1);
    if (succeeds(gesture.setMask(arm.value())) && succeeds(gesture.play("Wave"))) gesture.seek(0.5 + 0.35 * i);
}

/// BlendPriority, with more and more of what Wave's pose is besides its first frame added.
void additiveWave(AnimatedCharacter& wanderer, int i)
{
    AnimationController& controller = wanderer.getController();
    if (!succeeds(controller.play("Idle"))) return;
    AnimationLayer& added = controller.layer(1);
    added.setMode(AnimationLayer::Mode::Additive, AnimationLayer::Reference::FirstFrame);
    if (!succeeds(added.play("Wave"))) return;
    added.seek(1.2);
    added.setWeight(0.25f * static_cast<float>(i));
}

/// A stick to walk with, held in its middle; the hand's own axis runs along the fingers.
osg::ref_ptr<osg::Node> makeStaff()
{
    osg::ref_ptr<osg::Cylinder> shape = new osg::Cylinder(osg::Vec3(0.0f, 0.07f, 0.03f), 0.016f, 0.9f);
    shape->setRotation(osg::Quat(osg::DegreesToRadians(-45.0), osg::Vec3d(1, 0, 0)));
    osg::ref_ptr<osg::ShapeDrawable> staff = new osg::ShapeDrawable(shape);
    PbrMaterial wood;
    wood.baseColor = linearColor(osg::Vec4(0.55f, 0.32f, 0.16f, 1.0f));
    wood.metallic = 0.0f;
    wood.roughness = 0.7f;
    applyPbrMaterial(*staff->getOrCreateStateSet(), wood);
    applySurfaceProgram(*staff->getOrCreateStateSet(), false);
    return staff;
}

/// Walking with a staff in the right hand.
void holdStaff(AnimatedCharacter& wanderer, int i)
{
    AnimationController& controller = wanderer.getController();
    if (!succeeds(controller.play("Walk"))) return;
    controller.seek(0.96 * i / inARow);
    osg::ref_ptr<JointAttachment> hand = new JointAttachment("Hand_R");
    hand->addChild(makeStaff());
    wanderer.addChild(hand);
}

osg::ref_ptr<osg::Group> makeRow(const osg::Node& model, const Direction& direction)
{
    osg::ref_ptr<osg::Group> row = new osg::Group;
    for (int i = 0; i < inARow; ++i)
    {
        osg::ref_ptr<osg::PositionAttitudeTransform> place = new osg::PositionAttitudeTransform;
        place->setPosition(osg::Vec3d(apart * (i - (inARow - 1) / 2.0), 0.0, 0.0));
        place->setAttitude(osg::Quat(osg::DegreesToRadians(35.0), osg::Vec3d(0, 0, 1)));
        osg::ref_ptr<osg::Node> wanderer = osg::clone(&model, osg::CopyOp::DEEP_COPY_NODES);
        place->addChild(wanderer);
        row->addChild(place);
        if (AnimatedCharacter* character = findCharacter(*wanderer)) direction(*character, i);
    }
    return row;
}

/// A field of wanderers, most of them walking the same way, each at its own time and a little out of line.
osg::ref_ptr<AnimatedCrowd> makeCrowd(AnimatedCharacter& wanderer)
{
    osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(wanderer);
    std::mt19937 random(7);
    const auto between = [&](double low, double high)
    { return low + (high - low) * static_cast<double>(random()) / static_cast<double>(std::mt19937::max()); };
    constexpr int columns = 60, rows = 70;
    for (int i = 0; i < columns * rows; ++i)
    {
        const char* clips[] = {"Walk", "Walk", "Walk", "Wave", "Idle", "Run"};
        AnimationController controller(crowd->getSharedAnimationSet());
        if (!succeeds(controller.play(clips[random() % 6]))) return crowd;
        controller.seek(between(0.0, 3.0));
        const osg::Vec3d place(1.3 * (i % columns - 0.5 * columns) + between(-0.4, 0.4),
                               1.3 * (i / columns) + between(-0.4, 0.4), 0.0);
        const double shade = between(0.7, 1.0);
        const osg::Vec4 tint(shade, shade * between(0.8, 1.0), shade * between(0.7, 1.0), 1.0);
        if (!succeeds(crowd->add(osg::Matrixd::rotate(between(0.1, 0.7), osg::Vec3d(0, 0, 1)) *
                                     osg::Matrixd::translate(place),
                                 controller, tint)))
            return crowd;
    }
    return crowd;
}

/// Where the camera stands and what it looks at.
struct Sight
{
    osg::Vec3d eye, center;
    double angle; ///< degrees, from top to bottom
};

class ReadPixels : public osg::Camera::DrawCallback
{
public:
    void operator()(osg::RenderInfo&) const override
    {
        image = new osg::Image;
        image->readPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE);
    }
    mutable osg::ref_ptr<osg::Image> image;
};

Result<bool> draw(osg::Node* scene, const Sight& sight, const std::string& file)
{
    osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
    traits->width = width;
    traits->height = height;
    traits->samples = 4;
    traits->sampleBuffers = 1;
    const Result<osg::ref_ptr<EglGraphicsContext>> context = EglGraphicsContext::create(traits);
    if (!context) return context.error();
    osgViewer::Viewer viewer;
    viewer.setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    viewer.setLightingMode(osg::View::NO_LIGHT);
    osg::ref_ptr<Environment> studio = new Environment;
    studio->setToneMapping(true);
    studio->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::ON);
    studio->addChild(scene);
    osg::Camera* camera = viewer.getCamera();
    camera->setGraphicsContext(context.value());
    camera->setViewport(0, 0, width, height);
    camera->setClearColor(osg::Vec4(0.86f, 0.88f, 0.9f, 1.0f));
    camera->setProjectionMatrixAsPerspective(sight.angle, static_cast<double>(width) / height, 1.0, 100.0);
    camera->setViewMatrixAsLookAt(sight.eye, sight.center, osg::Vec3d(0, 0, 1));
    osg::ref_ptr<ReadPixels> reader = new ReadPixels;
    camera->setFinalDrawCallback(reader);
    viewer.setSceneData(studio);
    viewer.realize();
    viewer.frame(0.0);
    if (!osgDB::writeImageFile(*reader->image, file)) return Error{file + ": cannot be written"};
    return true;
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 3)
    {
        std::cerr << "Usage: " << argv[0] << " SCENES FOLDER" << std::endl;
        return 2;
    }
    if (!succeeds(EglGraphicsContext::create(width, height))) return 77;
    const osg::ref_ptr<osg::Node> model =
        osgDB::readRefNodeFile(std::string(argv[1]) + "/Wanderer.glb", new osgDB::Options("noKeys"));
    if (!model) return 1;
    const std::pair<const char*, Direction> pictures[] = {
        {"Crossfade", crossfade}, {"Mask", maskedWave}, {"Additive", additiveWave}, {"Attachment", holdStaff}};
    for (const auto& [name, direction] : pictures)
        if (!succeeds(draw(makeRow(*model, direction), {{0, -5.6, 1.2}, {0, 0, 0.86}, 22.0},
                           std::string(argv[2]) + "/" + name + ".png")))
            return 1;
    AnimatedCharacter* wanderer = findCharacter(*model);
    if (!wanderer) return 1;
    const Sight fromAbove{{-2, -4.5, 4.2}, {1, 9, 0}, 36.0};
    return succeeds(draw(makeCrowd(*wanderer), fromAbove, std::string(argv[2]) + "/Crowd.png")) ? 0 : 1;
}
