// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Callback>
#include <osg/Node>

namespace osgGpuAnimation
{

/// A node with animation that follows the simulation time.
class Updatable
{
public:
    /// simulationTime: seconds, of the frame stamp.
    virtual void update(double simulationTime) = 0;

protected:
    ~Updatable() = default;
};

/// Updates the Updatable node it is on (AnimatedCharacter, AnimatedCrowd) with the frame stamp's simulation time. It
/// has no state, so copies of a node may share it.
class AnimationUpdateCallback : public osg::NodeCallback
{
public:
    AnimationUpdateCallback() = default;
    AnimationUpdateCallback(const AnimationUpdateCallback& other, const osg::CopyOp& copyop);
    META_Object(osgGpuAnimation, AnimationUpdateCallback)

    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override;

protected:
    ~AnimationUpdateCallback() override = default;
};

} // namespace osgGpuAnimation
