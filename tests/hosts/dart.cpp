// SPDX-License-Identifier: MIT
// Usage: dart [FILE [METRES_PER_SECOND]]
// DART's viewer with a platform, a body that DART simulates, and the character of FILE on it. With a speed, the
// platform moves and the character with it. Nothing here is of the kit: its plugin reads the file.
#include <dart/dart.hpp>
#include <dart/gui/osg/osg.hpp>

#include <osg/MatrixTransform>
#include <osgDB/ReadFile>
#include <osgViewer/ViewerEventHandlers>

#include <cstdlib>
#include <iostream>

namespace
{

/// Places a node where a body is, once a frame, after the steps of the simulation.
class FollowedWorld : public dart::gui::osg::RealTimeWorldNode
{
public:
    FollowedWorld(const dart::simulation::WorldPtr& world, const dart::dynamics::BodyNode* body,
                  osg::MatrixTransform* place)
        : RealTimeWorldNode(world), _body(body), _place(place)
    {
    }
    void customPostRefresh() override { _place->setMatrix(eigToOsgMatrix(_body->getWorldTransform())); }

private:
    const dart::dynamics::BodyNode* _body;
    osg::ref_ptr<osg::MatrixTransform> _place;
};

/// A box whose upper side is the plane z = 0 of the body.
dart::dynamics::BodyNode* addPlatform(const dart::dynamics::SkeletonPtr& skeleton, double metresPerSecond)
{
    auto [joint, body] = skeleton->createJointAndBodyNodePair<dart::dynamics::PrismaticJoint>();
    joint->setAxis(Eigen::Vector3d::UnitX());
    joint->setVelocity(0, metresPerSecond);
    Eigen::Isometry3d below = Eigen::Isometry3d::Identity();
    below.translation().z() = -0.05;
    auto* shape = body->createShapeNodeWith<dart::dynamics::VisualAspect>(
        std::make_shared<dart::dynamics::BoxShape>(Eigen::Vector3d(1.0, 1.0, 0.1)));
    shape->setRelativeTransform(below);
    shape->getVisualAspect()->setColor(Eigen::Vector3d(0.3, 0.4, 0.5));
    return body;
}

} // namespace

int main(int argc, char** argv)
{
    osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform;
    if (argc > 1)
    {
        osg::ref_ptr<osg::Node> character = osgDB::readRefNodeFile(argv[1]);
        if (!character) return EXIT_FAILURE; // OSG has said why
        place->addChild(character);
    }
    auto world = dart::simulation::World::create();
    auto skeleton = dart::dynamics::Skeleton::create("platform");
    dart::dynamics::BodyNode* platform = addPlatform(skeleton, argc > 2 ? std::atof(argv[2]) : 0.0);
    world->addSkeleton(skeleton);

    dart::gui::osg::Viewer viewer;
    osg::ref_ptr<FollowedWorld> node = new FollowedWorld(world, platform, place);
    viewer.addWorldNode(node);
    viewer.getRootGroup()->addChild(place);
    viewer.simulate(true);
    viewer.setUpViewInWindow(0, 0, 640, 480);
    viewer.getCameraManipulator()->setHomePosition(osg::Vec3(2.0, -4.0, 1.5), osg::Vec3(0.0, 0.0, 0.8), osg::Z_AXIS);
    viewer.home();
    return viewer.run();
}
