// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Callback>

namespace osgGpuAnimation
{

/// Moves its AnimatedCharacter by the root motion of the clips: after each update it multiplies the character's matrix
/// by the motion.
///
///     fox->addUpdateCallback(new RootMotionCallback);
///
/// It has no state, so copies of a character may share it.
class RootMotionCallback : public osg::NodeCallback
{
public:
    RootMotionCallback() = default;
    /// A copy; the callback has no state.
    RootMotionCallback(const RootMotionCallback& other, const osg::CopyOp& copyop)
        : osg::Object(other, copyop), osg::Callback(other, copyop), osg::NodeCallback(other, copyop)
    {
    }
    META_Object(osgGpuAnimation, RootMotionCallback)

    /// Applies the root motion since the last call, then continues the traversal.
    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override;

protected:
    ~RootMotionCallback() override = default;
};

} // namespace osgGpuAnimation
