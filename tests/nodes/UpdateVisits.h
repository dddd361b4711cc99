// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Camera>
#include <osg/FrameStamp>
#include <osg/Node>
#include <osgUtil/CullVisitor>
#include <osgUtil/RenderStage>
#include <osgUtil/UpdateVisitor>

namespace osgGpuAnimation
{

/// The update traversals of a viewer, one per frame.
struct UpdateVisits
{
    /// time: of the simulation, in seconds.
    void visit(osg::Node& scene, double time)
    {
        const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
        stamp->setFrameNumber(++frame);
        stamp->setSimulationTime(time);
        osgUtil::UpdateVisitor visitor;
        visitor.setFrameStamp(stamp);
        scene.accept(visitor);
    }

    /// Calls the callback as a cull traversal of the last frame, by a camera at the eye, does for the last node of the
    /// path.
    void cullFrom(const osg::Vec3d& eye, const osg::Vec3d& target, const osg::NodePath& path,
                  osg::NodeCallback& callback) const
    {
        const osg::ref_ptr<osg::Camera> camera = new osg::Camera;
        camera->setViewMatrixAsLookAt(eye, target, osg::Vec3d(0, 0, 1));
        const osg::ref_ptr<osgUtil::RenderStage> stage = new osgUtil::RenderStage;
        stage->setCamera(camera);
        const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
        stamp->setFrameNumber(frame);
        const osg::ref_ptr<osgUtil::CullVisitor> visitor = new osgUtil::CullVisitor;
        visitor->setFrameStamp(stamp);
        visitor->setRenderStage(stage);
        visitor->setCurrentRenderBin(stage);
        for (osg::Node* node : path)
            visitor->pushOntoNodePath(node);
        callback(path.back(), visitor);
    }

    unsigned int frame = 0; ///< the number of the last one
};

} // namespace osgGpuAnimation
