// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Channel.h>
#include <osgGpuAnimation/math/JointTransform.h>

#include <osg/Matrixd>
#include <osgAnimation/Animation>
#include <osgAnimation/Bone>
#include <osgAnimation/UpdateBone>

#include <cmath>
#include <vector>

namespace osgGpuAnimation::osganimation
{

/// A bone's local transform under one osgAnimation::Animation, computed by osgAnimation itself from copies of the
/// bone's stacked transforms and of its channels, so that the scene does not change. All kinds of stacked transforms
/// and channels are covered.
class BoneMotion
{
public:
    /// update: the bone's callback; null: the bone keeps its matrix. animation: null: the pose without animation.
    BoneMotion(const osgAnimation::Bone& bone, const osgAnimation::UpdateBone* update,
               const osgAnimation::Animation* animation);

    /// Copies of the channels that drive the bone.
    const osgAnimation::ChannelList& linkedChannels() const { return _channels; }
    osg::Matrixd at(double seconds); ///< in the parent bone's space

    /// Keys for translation, rotation and scale, all at the same times, with linear interpolation between them: at the
    /// channels' own key times, and at as many more as it takes for the matrix between them to differ by less than
    /// 1e-5 of its largest number. Where the matrix jumps, two keys are next to each other. target: the joint's index.
    std::vector<Channel> channels(int target);

private:
    osg::Matrixd _still; ///< without stacked transforms
    osg::ref_ptr<osgAnimation::UpdateBone> _update;
    std::vector<osg::ref_ptr<osgAnimation::Channel>> _channels;
};

/// T, R, S of a matrix that has no shear: the nearest otherwise.
JointTransform transformOf(const osg::Matrixd& matrix);
/// True if T · R · S differs from the matrix by less than 1e-4 of its largest number.
bool hasNoShear(const osg::Matrixd& matrix);

// For sampledTrack(): what keys may deviate from osgAnimation, as a part of the value, and how many of that are a jump.
constexpr double tolerance = 1e-5, minJump = 100.0;

/// The key times of all channels, ascending, each once: floats from 0 on, as clips have them. Others are left out.
std::vector<double> keyTimesOf(const std::vector<osg::ref_ptr<osgAnimation::Channel>>& channels);

/// The next float towards 0.
inline double justBefore(double time)
{
    return static_cast<double>(std::nextafter(static_cast<float>(time), 0.0f));
}

} // namespace osgGpuAnimation::osganimation
