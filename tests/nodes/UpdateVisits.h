// SPDX-License-Identifier: MIT
#pragma once

#include <osg/FrameStamp>
#include <osg/Node>
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

    unsigned int frame = 0; ///< the number of the last one
};

} // namespace osgGpuAnimation
