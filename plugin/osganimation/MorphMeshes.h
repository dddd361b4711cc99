// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Channel.h>
#include <osgGpuAnimation/mesh/MorphTarget.h>

#include <osgAnimation/Animation>
#include <osgAnimation/MorphGeometry>

#include <optional>
#include <vector>

namespace osgGpuAnimation::osganimation
{

/// The weights of a MorphGeometry under one osgAnimation::Animation. osgAnimation ignores weights below 0, and so does
/// the curve.
class MorphMotion
{
public:
    /// rest: one weight per target, without animation. update: the callback of the Geode that drives the weights; null:
    /// nothing does.
    MorphMotion(std::vector<float> rest, osgAnimation::UpdateMorph* update, const osgAnimation::Animation& animation);

    bool drives(std::size_t weight) const { return _targets[weight].valid(); }
    /// Copies of the channels that drive the weights.
    const osgAnimation::ChannelList& linkedChannels() const { return _channels; }
    std::vector<float> at(double seconds); ///< one per target
    /// Linear keys, as those of BoneMotion. target: the index of the morph weights.
    Channel channel(int target);

private:
    std::vector<float> _rest;
    std::vector<osg::ref_ptr<osgAnimation::Channel>> _channels;
    std::vector<osg::ref_ptr<osgAnimation::FloatTarget>> _targets; ///< one per weight; null: not driven
};

/// The mesh's own weights, without animation. One that any animation drives is 0 in the others, as osgAnimation has it.
std::vector<float> restWeights(const osgAnimation::MorphGeometry& mesh, osgAnimation::UpdateMorph* update,
                               const osgAnimation::AnimationList& animations);

/// The vertices and normals before any weights; null: none.
osg::Vec3Array* morphSource(const osgAnimation::MorphGeometry& mesh, bool normals);

/// The targets as differences from those vertices. None, if a target has another number of vertices: the mesh cannot be
/// morphed.
std::optional<std::vector<MorphTarget>> morphTargetsOf(const osgAnimation::MorphGeometry& mesh);

} // namespace osgGpuAnimation::osganimation
