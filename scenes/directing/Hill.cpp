// SPDX-License-Identifier: MIT
#include "Hill.h"

#include "Props.h"

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/GroundFeet.h>
#include <osgGpuAnimation/nodes/SpringBones.h>

#include <osg/Geometry>
#include <osg/Math>
#include <osg/MatrixTransform>

#include <cmath>
#include <random>

namespace osgGpuAnimation
{

namespace
{

/// Metres above 0 at a place of the ground.
double heightAt(double x, double y)
{
    return 0.5 * std::sin(0.45 * x + 0.6) * std::cos(0.4 * y) + 0.12 * std::sin(1.3 * x - 0.9 * y);
}

osg::ref_ptr<osg::Node> makeGround()
{
    constexpr int cells = 160;
    constexpr double side = 24.0;
    osg::ref_ptr<osg::Vec3Array> places = new osg::Vec3Array, normals = new osg::Vec3Array;
    osg::ref_ptr<osg::DrawElementsUInt> triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
    for (unsigned int row = 0; row <= cells; ++row)
        for (unsigned int column = 0; column <= cells; ++column)
        {
            const double x = side * (column / double(cells) - 0.5), y = side * (row / double(cells) - 0.5);
            constexpr double step = 1e-3;
            places->push_back(osg::Vec3d(x, y, heightAt(x, y)));
            osg::Vec3 normal = osg::Vec3d((heightAt(x - step, y) - heightAt(x + step, y)) / (2.0 * step),
                                          (heightAt(x, y - step) - heightAt(x, y + step)) / (2.0 * step), 1.0);
            normal.normalize();
            normals->push_back(normal);
            const unsigned int corner = row * (cells + 1) + column;
            if (row < cells && column < cells)
                for (const unsigned int offset : {0, 1, cells + 2, 0, cells + 2, cells + 1})
                    triangles->push_back(corner + offset);
        }
    osg::ref_ptr<osg::Geometry> ground = new osg::Geometry;
    ground->setVertexArray(places);
    ground->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    ground->addPrimitiveSet(triangles);
    applyMaterial(*ground, osg::Vec4(0.3f, 0.42f, 0.2f, 1.0f));
    return ground;
}

constexpr double pathRadius = 3.0; ///< metres, of the circle that the wanderer follows

double speedAt(double time)
{
    return 1.3 - 0.6 * std::cos(0.5 * time);
}

/// Radians from +X, at that time.
double angleAt(double time)
{
    return (1.3 * time - 1.2 * std::sin(0.5 * time)) / pathRadius; // the integral of the speed
}

/// Flies beside the wanderer's head, inside the circle, to and fro.
class FlyAbout : public osg::NodeCallback
{
public:
    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override
    {
        const double time = visitor->getFrameStamp()->getSimulationTime();
        const double angle = angleAt(time) + 0.15 + 0.2 * std::sin(0.9 * time - 2.7);
        const double radius = pathRadius - 1.15 + 0.25 * std::sin(0.7 * time - 2.1);
        const double x = radius * std::cos(angle), y = radius * std::sin(angle);
        dynamic_cast<osg::MatrixTransform&>(*node).setMatrix(
            osg::Matrixd::translate(x, y, heightAt(x, y) + 1.45 + 0.15 * std::sin(1.7 * time - 5.1)));
        traverse(node, visitor);
    }
};

/// Leads its character round a circle on the ground, at 0.7 to 1.9 m/s. It runs before GroundFeet.
class Walk : public osg::NodeCallback
{
public:
    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override
    {
        auto& wanderer = dynamic_cast<AnimatedCharacter&>(*node);
        const double time = visitor->getFrameStamp()->getSimulationTime();
        const double speed = speedAt(time), angle = angleAt(time);
        const double x = pathRadius * std::cos(angle), y = pathRadius * std::sin(angle);
        wanderer.setMatrix(osg::Matrixd::rotate(angle + osg::PI, osg::Vec3d(0, 0, 1)) *
                           osg::Matrixd::translate(x, y, heightAt(x, y)));
        AnimationLayer& gait = wanderer.getController().layer(0);
        gait.setParameter(speed);
        (void)gait.setGroundSpeed(speed);
        traverse(node, visitor);
    }
};

/// The eyes of a wanderer; spine, neck and head share the turn.
LookAt makeLook(float turnSpeed)
{
    LookAt look{"look", {"Chest", "Neck", "Head"}};
    look.shares = {0.2f, 0.3f, 0.5f};
    look.offset = {0.0f, 0.1f, 0.1f};
    look.cone = 1.4f;
    look.turnSpeed = turnSpeed;
    return look;
}

Result<void> addConstraints(AnimatedCharacter& wanderer, const std::vector<Constraint>& constraints)
{
    const auto set = wanderer.getAnimationSet().withConstraints(constraints);
    if (!set) return set.error();
    return wanderer.setAnimationSet(set.value());
}

} // namespace

Result<void> addLook(AnimatedCharacter& wanderer)
{
    return addConstraints(wanderer, {makeLook(0.0f)});
}

Result<osg::ref_ptr<SpringBones>> addSprings(AnimatedCharacter& wanderer)
{
    SpringChain scarf{{{"Scarf1"}, {"Scarf2"}, {"Scarf3"}}, {0}}, hood{{{"HoodTip1"}, {"HoodTip2"}}, {}};
    for (SpringChain* chain : {&scarf, &hood})
        for (SpringJoint& joint : chain->joints)
        {
            joint.stiffness = 0.4f;
            joint.gravity = 0.5f;
            joint.drag = 0.25f;
            joint.radius = 0.03f;
        }
    const SpringCollider back{"Chest", osg::Vec3(0.0f, -0.1f, 0.0f), osg::Vec3(0.0f, 0.2f, 0.0f), 0.16f};
    const osg::ref_ptr<SpringBones> springs = new SpringBones;
    const Result<void> set = springs->setChains(wanderer.getAnimationSet(), {scarf, hood}, {back});
    if (!set) return set.error();
    wanderer.addUpdateCallback(springs);
    return springs;
}

Result<void> playGaits(AnimatedCharacter& wanderer, double speed)
{
    const auto gaits =
        BlendSpace::create(wanderer.getAnimationSet(), {{"Walk", 0.71}, {"Run", 2.1}}, {"left foot", "right foot"});
    if (!gaits) return gaits.error();
    AnimationLayer& gait = wanderer.getController().layer(0);
    Result<void> played = gait.play(gaits.value());
    if (!played) return played;
    gait.setParameter(speed);
    return gait.setGroundSpeed(speed);
}

Result<void> addGroundFeet(AnimatedCharacter& wanderer, osg::Node& ground)
{
    const Result<void> added =
        addConstraints(wanderer, {TwoBoneIk{"left leg", "UpperLeg_L", "LowerLeg_L", "Foot_L"},
                                  TwoBoneIk{"right leg", "UpperLeg_R", "LowerLeg_R", "Foot_R"}, makeLook(3.0f)});
    if (!added) return added;
    const osg::ref_ptr<GroundFeet> feet = new GroundFeet(ground);
    const Result<void> set =
        feet->setLegs(wanderer.getAnimationSet(), {{"left leg", "Toes_L"}, {"right leg", "Toes_R"}});
    if (set) wanderer.addUpdateCallback(feet);
    return set;
}

Result<osg::ref_ptr<osg::Node>> makeHill(const osg::Node& model)
{
    const osg::ref_ptr<osg::Group> hill = makeSunlight({-0.45f, 0.45f, 0.8f});
    const osg::ref_ptr<osg::Node> ground = makeGround();
    ground->setNodeMask(receivesShadow);
    const osg::ref_ptr<osg::MatrixTransform> lantern = new osg::MatrixTransform;
    lantern->addChild(makeLantern());
    lantern->addUpdateCallback(new FlyAbout);
    const osg::ref_ptr<osg::Node> copy = osg::clone(&model, osg::CopyOp::DEEP_COPY_NODES);
    for (osg::Node* child : {ground.get(), static_cast<osg::Node*>(lantern), copy.get()})
        hill->addChild(child);
    AnimatedCharacter* wanderer = findCharacter(*copy);
    if (!wanderer) return Error{"the model has no character"};
    wanderer->addUpdateCallback(new Walk);
    if (const Result<void> feet = addGroundFeet(*wanderer, *ground); !feet) return feet.error();
    if (const Result<void> gaits = playGaits(*wanderer, 0.7); !gaits) return gaits.error();
    if (const Result<void> followed = wanderer->constraint("look").follow(lantern); !followed) return followed.error();
    if (const auto springs = addSprings(*wanderer); !springs) return springs.error();
    return osg::ref_ptr<osg::Node>(hill);
}

Result<osg::ref_ptr<osg::Node>> makeGazers(const osg::Node& model)
{
    const osg::ref_ptr<osg::Group> square = new osg::Group;
    const osg::ref_ptr<osg::Node> copy = osg::clone(&model, osg::CopyOp::DEEP_COPY_NODES);
    AnimatedCharacter* wanderer = findCharacter(*copy);
    if (!wanderer) return Error{"the model has no character"};
    if (const Result<void> look = addLook(*wanderer); !look) return look.error();
    const osg::ref_ptr<osg::MatrixTransform> bird = new osg::MatrixTransform(
        osg::Matrixd::scale(1.2, 1.2, 1.2) * osg::Matrixd::rotate(0.6, osg::Vec3d(0, 1, 0)) *
        osg::Matrixd::rotate(-1.2, osg::Vec3d(0, 0, 1)) * osg::Matrixd::translate(2.9, -0.8, 3.0));
    bird->addChild(makeBird());
    square->addChild(bird);
    const osg::ref_ptr<AnimatedCrowd> crowd = new AnimatedCrowd(*wanderer);
    square->addChild(crowd);
    std::mt19937 random(11);
    const auto between = [&](double low, double high)
    { return low + (high - low) * static_cast<double>(random()) / static_cast<double>(std::mt19937::max()); };
    constexpr int columns = 50, rows = 40;
    for (int i = 0; i < columns * rows; ++i)
    {
        AnimationController controller(crowd->getSharedAnimationSet());
        if (const Result<void> played = controller.play("Idle"); !played) return played.error();
        controller.seek(between(0.0, 5.0));
        const osg::Vec3d place(1.1 * (i % columns - 0.5 * columns) + between(-0.3, 0.3),
                               1.1 * (i / columns) + between(-0.3, 0.3), 0.0);
        const double facing = between(-0.4, 0.4); // the bodies; the heads turn from there
        const double shade = between(0.7, 1.0);
        const auto instance =
            crowd->add(osg::Matrixd::rotate(facing, osg::Vec3d(0, 0, 1)) * osg::Matrixd::translate(place), controller,
                       osg::Vec4d(shade, shade * between(0.9, 1.0), shade * between(0.8, 1.0), 1.0));
        if (!instance) return instance.error();
        if (const Result<void> followed = crowd->constraint(instance.value(), "look").follow(bird); !followed)
            return followed.error();
    }
    return osg::ref_ptr<osg::Node>(square);
}

} // namespace osgGpuAnimation
