// SPDX-License-Identifier: MIT
// Usage: direct_scenes SCENES FOLDER
//        direct_scenes --view SCENES
// Reads SCENES/Wanderer.glb and draws into FOLDER, without a display: Crossfade.png, Mask.png and others, each a row of
// wanderers, Gaze.png and Hill.png, and People.png and Street.png of SCENES/People.glb. With --view it shows the hill
// in a window. The plugin is looked for where OSG_LIBRARY_PATH says. Ends with 77 where there is no GL, and with 1
// where there is no display for --view.

#include "Hill.h"
#include "Props.h"
#include "Street.h"

#include <osgGpuAnimation/animation/JointMask.h>
#include <osgGpuAnimation/gpu/OffscreenContext.h>
#include <osgGpuAnimation/looks/Environment.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/JointAttachment.h>
#include <osgGpuAnimation/nodes/studio/Studio.h>

#include <osg/PositionAttitudeTransform>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>
#include <osgViewer/Viewer>

#include <cmath>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

using namespace osgGpuAnimation;

namespace
{

constexpr int width = 900, height = 378;
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

/// Turns a joint from its rest, in the space of its parent. angle: radians.
bool turnJoint(const AnimatedCharacter& wanderer, JointPose& pose, const char* name, float angle, const glm::vec3& axis)
{
    const Result<std::size_t> joint = wanderer.getAnimationSet().skeleton().jointNamed(name);
    if (!succeeds(joint)) return false;
    const glm::vec4 rest = pose.transform(joint.value()).rotation;
    return pose.setRotation(joint.value(), glm::angleAxis(angle, axis) * glm::quat(rest.w, rest.x, rest.y, rest.z));
}

/// Walking with a staff in the right hand: the forearm and the fingers are posed, the rest of the arm swings.
void holdStaff(AnimatedCharacter& wanderer, int i)
{
    AnimationController& controller = wanderer.getController();
    if (!succeeds(controller.play("Walk"))) return;
    controller.seek(0.96 * i / inARow);
    // The joints of the arm point along +Y; the thumb is on the side of +Z, the palm looks along -X.
    const glm::vec3 bend(1, 0, 0), curl(0, 0, 1);
    JointPose& pose = controller.layer(1).pose();
    turnJoint(wanderer, pose, "LowerArm_R", 1.5f, bend);
    turnJoint(wanderer, pose, "Hand_R", 0.85f, glm::vec3(0, 1, 0));
    turnJoint(wanderer, pose, "Fingers_R", 1.5f, curl);
    turnJoint(wanderer, pose, "FingerTips_R", 1.6f, curl);
    turnJoint(wanderer, pose, "Thumb_R", 0.8f, curl);
    osg::ref_ptr<JointAttachment> hand = new JointAttachment("Hand_R");
    hand->addChild(makePart(new osg::Cylinder({-0.035f, 0.1f, 0.0f}, 0.016f, 1.35f), {0.55f, 0.32f, 0.16f, 1.0f}));
    wanderer.addChild(hand);
}

/// From Walk to Run by the parameter of a blend space.
void blendGaits(AnimatedCharacter& wanderer, int i)
{
    if (succeeds(playGaits(wanderer, 0.71 + 0.3475 * i))) wanderer.getController().advance(0.3);
}

/// A layer shows a pose of the application: the right arm, higher and higher.
void poseArm(AnimatedCharacter& wanderer, int i)
{
    AnimationController& controller = wanderer.getController();
    if (!succeeds(controller.play("Idle"))) return;
    const Result<std::size_t> arm = wanderer.getAnimationSet().skeleton().jointNamed("UpperArm_R");
    if (!succeeds(arm)) return;
    JointPose& pose = controller.layer(1).pose();
    const glm::vec4 rest = pose.transform(arm.value()).rotation;
    pose.setRotation(arm.value(), glm::quat(rest.w, rest.x, rest.y, rest.z) *
                                      glm::angleAxis(-0.5f * static_cast<float>(i), glm::vec3(1, 0, 0)));
}

/// The group of all wanderers, whose first child is their ground.
osg::Group* rowOf(const AnimatedCharacter& wanderer)
{
    const osg::NodePathList paths = wanderer.getParentalNodePaths();
    return paths.empty() ? nullptr : paths.front().front()->asGroup();
}

const osg::Vec3d seenPoint(0.5, -0.6, 1.4); ///< of the picture LookAt: before the row, between two wanderers

void lookAtBall(AnimatedCharacter& wanderer, int i)
{
    if (osg::Group* row = rowOf(wanderer); row && i == 0)
        row->addChild(makePart(new osg::Sphere(seenPoint, 0.08f), {0.85f, 0.2f, 0.12f, 1.0f}));
    if (!succeeds(wanderer.getController().play("Idle")) || !succeeds(addLook(wanderer))) return;
    succeeds(wanderer.constraint("look").setWorldTarget(seenPoint));
}

constexpr double springSeconds = 2.0; ///< of the picture Springs

/// Turns its character on the spot. All have the same direction at springSeconds.
class Spin : public osg::NodeCallback
{
public:
    explicit Spin(double speed) : _speed(speed) {}
    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override
    {
        const double time = visitor->getFrameStamp()->getSimulationTime();
        dynamic_cast<AnimatedCharacter&>(*node).setMatrix(
            osg::Matrixd::rotate(_speed * (time - springSeconds), osg::Vec3d(0, 0, 1)));
        traverse(node, visitor);
    }

private:
    double _speed; ///< radians a second
};

/// They turn on the spot, faster from pair to pair. Of each pair, scarf and hood of the right one swing.
void swingScarf(AnimatedCharacter& wanderer, int i)
{
    if (!succeeds(wanderer.getController().play("Idle"))) return;
    wanderer.addUpdateCallback(new Spin(osg::PI * (1 << (i / 2))));
    if (i % 2 == 1) succeeds(addSprings(wanderer));
}

/// Walking uphill. Of each pair, the feet of the right one stay on the ground.
void walkUphill(AnimatedCharacter& wanderer, int i)
{
    if (!succeeds(playGaits(wanderer, 0.71))) return;
    wanderer.getController().seek(0.04 + 0.48 * (i / 2));
    osg::Group* row = rowOf(wanderer);
    if (row && i % 2 == 1) succeeds(addGroundFeet(wanderer, *row->getChild(0)));
}

/// A picture of a row.
struct Row
{
    const char* name;
    Direction direction;
    double seconds = 0.0; ///< of the animation before the picture
    double facing = 35.0; ///< degrees; 0: towards the camera
    int pairs = 0;        ///< of wanderers; 0: five, not in pairs
    bool onRamps = false; ///< each has its own ramp of 20 degrees below, in sunlight
};

osg::ref_ptr<osg::Group> makeRow(const osg::Node& model, const Row& row)
{
    const int count = row.pairs > 0 ? 2 * row.pairs : inARow;
    const double gap = row.pairs > 0 ? 0.8 : 1.0, pairGap = row.pairs > 0 ? 0.15 : 0.0; // metres
    osg::ref_ptr<osg::Group> group = new osg::Group, ground = new osg::Group;
    group->addChild(ground);
    for (int i = 0; i < count; ++i)
    {
        const double x = gap * (i - (count - 1) / 2.0) + pairGap * (i / 2 - (row.pairs - 1) / 2.0);
        osg::ref_ptr<osg::PositionAttitudeTransform> place = new osg::PositionAttitudeTransform;
        place->setPosition(osg::Vec3d(x, 0.0, 0.0));
        place->setAttitude(osg::Quat(osg::DegreesToRadians(row.facing), osg::Vec3d(0, 0, 1)));
        osg::ref_ptr<osg::Node> wanderer = osg::clone(&model, osg::CopyOp::DEEP_COPY_NODES);
        place->addChild(wanderer);
        group->addChild(place);
        if (row.onRamps) ground->addChild(makeRamp(osg::DegreesToRadians(20.0), osg::Vec3d(x, 0.0, 0.0)));
    }
    for (int i = 0; i < count; ++i)
        if (AnimatedCharacter* wanderer = findCharacter(*group->getChild(i + 1))) row.direction(*wanderer, i);
    if (!row.onRamps) return group;
    ground->addChild(makePart(new osg::Box({0, 0, -0.36f}, 40.0f, 40.0f, 0.5f), {0.68f, 0.7f, 0.72f, 1.0f}));
    ground->setNodeMask(receivesShadow);
    osg::ref_ptr<osg::Group> sunlight = makeSunlight({-0.1f, 0.25f, 1.0f});
    sunlight->addChild(group);
    return sunlight;
}

/// Where the camera stands and what it looks at.
struct Sight
{
    osg::Vec3d eye, center;
    double angle; ///< degrees, from top to bottom
    int pictureWidth = width, pictureHeight = height;
};

class ReadPixels : public osg::Camera::DrawCallback
{
public:
    void operator()(osg::RenderInfo& info) const override
    {
        const osg::Viewport& all = *info.getCurrentCamera()->getViewport();
        image = new osg::Image;
        image->readPixels(0, 0, static_cast<int>(all.width()), static_cast<int>(all.height()), GL_RGB,
                          GL_UNSIGNED_BYTE);
    }
    mutable osg::ref_ptr<osg::Image> image;
};

/// surroundings: of the scene. seconds: of the animation before the picture is taken.
Result<osg::ref_ptr<osg::Image>> drawn(osg::Node* scene, Environment* surroundings, const Sight& sight, double seconds)
{
    osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
    traits->width = sight.pictureWidth;
    traits->height = sight.pictureHeight;
    traits->samples = 4;
    traits->sampleBuffers = 1;
    const Result<osg::ref_ptr<osg::GraphicsContext>> context = createOffscreenContext(traits);
    if (!context) return context.error();
    osgViewer::Viewer viewer;
    viewer.setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    viewer.setLightingMode(osg::View::NO_LIGHT);
    const osg::ref_ptr<Environment> studio = surroundings;
    studio->setToneMapping(true);
    studio->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::ON);
    studio->addChild(scene);
    osg::Camera* camera = viewer.getCamera();
    camera->setGraphicsContext(context.value());
    camera->setViewport(0, 0, sight.pictureWidth, sight.pictureHeight);
    camera->setClearColor(osg::Vec4(0.86f, 0.88f, 0.9f, 1.0f));
    camera->setProjectionMatrixAsPerspective(sight.angle, static_cast<double>(sight.pictureWidth) / sight.pictureHeight,
                                             1.0, 100.0);
    camera->setViewMatrixAsLookAt(sight.eye, sight.center, osg::Vec3d(0, 0, 1));
    osg::ref_ptr<ReadPixels> reader = new ReadPixels;
    camera->setFinalDrawCallback(reader);
    viewer.setSceneData(studio);
    viewer.realize();
    constexpr double step = 1.0 / 60.0;
    viewer.advance(0.0);
    viewer.updateTraversal();
    for (int frame = 1; frame <= std::lround(seconds / step); ++frame)
    {
        viewer.advance(step * frame);
        viewer.updateTraversal();
    }
    viewer.renderingTraversals();
    return reader->image;
}

Result<void> write(const osg::Image& image, const std::string& file)
{
    return osgDB::writeImageFile(image, file) ? Result<void>() : Error{file + ": cannot be written"};
}

Result<void> draw(osg::Node* scene, Environment* surroundings, const Sight& sight, double seconds,
                  const std::string& file)
{
    const Result<osg::ref_ptr<osg::Image>> image = drawn(scene, surroundings, sight, seconds);
    return image ? write(*image.value(), file) : image.error();
}

/// The rows of makeOutfitRows(), one above the other.
Result<void> drawRows(const std::vector<osg::ref_ptr<osg::Node>>& rows, const std::string& file)
{
    const Sight sight{{0, -22, 2.4}, {0, 0, 0.9}, 5.0, 1200, 231};
    const int count = static_cast<int>(rows.size());
    osg::ref_ptr<osg::Image> all = new osg::Image;
    all->allocateImage(sight.pictureWidth, count * sight.pictureHeight, 1, GL_RGB, GL_UNSIGNED_BYTE);
    for (int row = 0; row < count; ++row)
    {
        const auto image = drawn(rows[static_cast<std::size_t>(row)], new Studio, sight, 0.0);
        if (!image) return image.error();
        all->copySubImage(0, (count - 1 - row) * sight.pictureHeight, 0, image.value());
    }
    return write(*all, file);
}

int view(const osg::Node& model)
{
    const Result<osg::ref_ptr<osg::Node>> hill = makeHill(model);
    if (!succeeds(hill)) return 1;
    osg::ref_ptr<Environment> studio = new Environment;
    studio->setToneMapping(true);
    studio->addChild(hill.value());
    osgViewer::Viewer viewer;
    viewer.setSceneData(studio);
    const osg::NotifySeverity severity = osg::getNotifyLevel();
    osg::setNotifyLevel(osg::FATAL); // one sentence instead of OSG's
    viewer.setUpViewInWindow(100, 100, 1024, 768);
    viewer.realize();
    osg::setNotifyLevel(severity);
    if (viewer.isRealized()) return viewer.run();
    std::cerr << "There is no display to show the hill on; \"direct_scenes SCENES FOLDER\" draws pictures without one."
              << std::endl;
    return 1;
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 3)
    {
        std::cerr << "Usage: " << argv[0] << " SCENES FOLDER\n       " << argv[0] << " --view SCENES" << std::endl;
        return 2;
    }
    const bool isViewed = std::string(argv[1]) == "--view";
    const std::string scenes = argv[isViewed ? 2 : 1], folder = argv[2];
    if (!isViewed && !succeeds(createOffscreenContext(width, height))) return 77;
    const osg::ref_ptr<osg::Node> model =
        osgDB::readRefNodeFile(scenes + "/Wanderer.glb", new osgDB::Options("noKeys"));
    if (!model) return 1;
    if (isViewed) return view(*model);

    const Row rows[] = {{"Crossfade", crossfade},
                        {"BlendSpace", blendGaits},
                        {"Mask", maskedWave},
                        {"Additive", additiveWave},
                        {"PosedJoints", poseArm},
                        {"Springs", swingScarf, springSeconds, 180.0, 3},
                        {"LookAt", lookAtBall, 0.0, 0.0},
                        {"Feet", walkUphill, 0.0, 85.0, 2, true},
                        {"Attachment", holdStaff}};
    const Sight whole{{0, -5.6, 1.2}, {0, 0, 0.86}, 22.0}, legs{{0, -5.6, 1.9}, {0, 0, 0.46}, 15.0};
    for (const Row& row : rows)
    {
        const osg::ref_ptr<osg::Group> scene = makeRow(*model, row);
        const osg::ref_ptr<Environment> surroundings =
            row.onRamps ? new Environment : static_cast<Environment*>(new Studio);
        if (!succeeds(
                draw(scene, surroundings, row.onRamps ? legs : whole, row.seconds, folder + "/" + row.name + ".png")))
            return 1;
    }
    const osg::ref_ptr<osg::Node> people = osgDB::readRefNodeFile(scenes + "/People.glb", new osgDB::Options("noKeys"));
    if (!people) return 1;
    const auto rowsOfPeople = makeOutfitRows(*people, scenes + "/People.outfits.json");
    if (!succeeds(rowsOfPeople) || !succeeds(drawRows(rowsOfPeople.value(), folder + "/People.png"))) return 1;
    const Result<osg::ref_ptr<osg::Node>> gazers = makeGazers(*model), hill = makeHill(*model),
                                          street = makeStreet(*people, scenes + "/People.outfits.json");
    if (!succeeds(gazers) || !succeeds(hill) || !succeeds(street)) return 1;
    const Sight alongTheStreet{{-3, -6.5, 4.6}, {0.6, 10, 0}, 33.0}, square{{0, -6, 2.9}, {0, 6, 0.9}, 36.0};
    const Sight onTheHill{{-1.6, 2.2, 1.5}, {1.86, 1.95, 1.17}, 34.0};
    const bool isDrawn = succeeds(draw(street.value(), new Studio, alongTheStreet, 0.0, folder + "/Street.png")) &&
                         succeeds(draw(gazers.value(), new Studio, square, 0.0, folder + "/Gaze.png")) &&
                         succeeds(draw(hill.value(), new Environment, onTheHill, 3.0, folder + "/Hill.png"));
    return isDrawn ? 0 : 1;
}
