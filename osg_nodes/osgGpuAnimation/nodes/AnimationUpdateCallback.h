// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Callback>
#include <osg/Node>

namespace osgGpuAnimation
{

/// A node whose animation follows the simulation time.
class Updatable
{
public:
    /// Advances the animation. simulationTime: seconds, from the frame stamp.
    virtual void update(double simulationTime) = 0;

protected:
    ~Updatable() = default;
};

/// Updates its node (AnimatedCharacter, AnimatedCrowd) with the frame stamp's simulation time. It has no state, so
/// copies of a node may share it.
class AnimationUpdateCallback : public osg::NodeCallback
{
public:
    AnimationUpdateCallback() = default;
    /// A copy; the callback has no state.
    AnimationUpdateCallback(const AnimationUpdateCallback& other, const osg::CopyOp& copyop);
    META_Object(osgGpuAnimation, AnimationUpdateCallback)

    /// Updates the node, then continues the traversal.
    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override;

protected:
    ~AnimationUpdateCallback() override = default;
};

} // namespace osgGpuAnimation
