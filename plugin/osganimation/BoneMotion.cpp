// SPDX-License-Identifier: MIT
#include "osganimation/BoneMotion.h"

#include <osgGpuAnimation/authoring/keyframes/SampledTrack.h>
#include <osgGpuAnimation/math/Rotation.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>

namespace osgGpuAnimation::osganimation
{

namespace
{

osg::Matrixd matrixOf(const JointTransform& transform)
{
    return toOsg(transform.toMatrix());
}

/// The largest of two numbers.
double difference(const osg::Matrixd& a, const osg::Matrixd& b)
{
    double max = 0.0;
    for (int i = 0; i < 16; ++i)
        max = std::max(max, std::abs(a.ptr()[i] - b.ptr()[i]));
    return max;
}

/// The same as a part of the largest number of b, which is an affine matrix.
double deviation(const osg::Matrixd& a, const osg::Matrixd& b)
{
    return difference(a, b) / difference(b, osg::Matrixd(0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0));
}

/// Linear, and slerp the short way, as the kit mixes two keys.
osg::Matrixd between(const osg::Matrixd& from, const osg::Matrixd& to, double share)
{
    const JointTransform a = transformOf(from), b = transformOf(to);
    const glm::dvec4 rotation = Rotation::slerp(glm::dvec4(a.rotation), glm::dvec4(b.rotation), share);
    const auto part = static_cast<float>(share);
    return matrixOf(
        {glm::mix(a.translation, b.translation, part), glm::vec4(rotation), glm::mix(a.scale, b.scale, part)});
}

template <class... Values>
void addTimesOf(const osgAnimation::KeyframeContainer& keys, std::vector<double>& times)
{
    const auto add = [&](const auto* typed)
    {
        for (std::size_t i = 0; typed && i < typed->size(); ++i)
            times.push_back((*typed)[i].getTime());
    };
    (add(dynamic_cast<const osgAnimation::TemplateKeyframeContainer<Values>*>(&keys)), ...);
}

} // namespace

JointTransform transformOf(const osg::Matrixd& matrix)
{
    glm::dvec3 axes[3];
    for (int axis = 0; axis < 3; ++axis)
        axes[axis] = {matrix(axis, 0), matrix(axis, 1), matrix(axis, 2)};
    glm::dvec3 scale(glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2]));
    if (glm::dot(glm::cross(axes[0], axes[1]), axes[2]) < 0.0) scale.x = -scale.x;
    JointTransform transform;
    const osg::Vec3d place = matrix.getTrans();
    transform.translation = glm::vec4(place.x(), place.y(), place.z(), 0.0);
    transform.scale = glm::vec4(glm::vec3(scale), 0.0f);
    const osg::Matrixd turn =
        rotationOf(osg::Matrixd::scale(scale.x < 0.0 ? -1.0 : 1.0, 1.0, 1.0) * matrix); // rotationOf keeps +Z and +Y
    const osg::Quat rotation = turn.getRotate();
    transform.rotation = glm::vec4(rotation.x(), rotation.y(), rotation.z(), rotation.w());
    return transform;
}

bool hasNoShear(const osg::Matrixd& matrix)
{
    return deviation(matrixOf(transformOf(matrix)), matrix) < 1e-4;
}

BoneMotion::BoneMotion(const osgAnimation::Bone& bone, const osgAnimation::UpdateBone* update,
                       const osgAnimation::Animation* animation)
    : _still(bone.getMatrix())
{
    if (!update || update->getStackedTransforms().empty()) return;
    _update = new osgAnimation::UpdateBone(*update, osg::CopyOp::DEEP_COPY_ALL);
    if (!animation) return;
    for (const osg::ref_ptr<osgAnimation::Channel>& channel : animation->getChannels())
    {
        if (channel->getTargetName() != update->getName() || !channel->getSampler()) continue;
        const osg::ref_ptr<osgAnimation::Channel> copy = channel->clone();
        if (_update->link(copy)) _channels.push_back(copy);
    }
}

osg::Matrixd BoneMotion::at(double seconds)
{
    if (!_update) return _still;
    for (const osg::ref_ptr<osgAnimation::Channel>& channel : _channels)
        channel->getTarget()->reset();
    for (const osg::ref_ptr<osgAnimation::Channel>& channel : _channels)
        channel->update(seconds, 1.0f, 0);
    _update->getStackedTransforms().update(static_cast<float>(seconds));
    return _update->getStackedTransforms().getMatrix();
}

std::vector<Channel> BoneMotion::channels(int target)
{
    const auto function = [this](double time, bool before) { return at(before ? justBefore(time) : time); };
    const auto inTolerances = [](const osg::Matrixd& a, const osg::Matrixd& b) { return deviation(a, b) / tolerance; };
    const auto keys = sampledTrack(keyTimesOf(_channels), function, between, inTolerances, minJump);
    std::vector<Channel> made;
    if (keys.empty()) return made;
    for (const Channel::Path path : {Channel::Path::Translation, Channel::Path::Rotation, Channel::Path::Scale})
    {
        Channel channel;
        channel.path = path;
        channel.target = target;
        for (const auto& [time, matrix] : keys)
        {
            const JointTransform transform = transformOf(matrix);
            const glm::vec4& part = path == Channel::Path::Translation ? transform.translation
                                    : path == Channel::Path::Rotation  ? transform.rotation
                                                                       : transform.scale;
            channel.times.push_back(time);
            for (int i = 0; i < (path == Channel::Path::Rotation ? 4 : 3); ++i)
                channel.values.push_back(static_cast<double>(part[i]));
        }
        made.push_back(std::move(channel));
    }
    return made;
}

std::vector<double> keyTimesOf(const std::vector<osg::ref_ptr<osgAnimation::Channel>>& channels)
{
    std::vector<double> times;
    for (const osg::ref_ptr<osgAnimation::Channel>& channel : channels)
    {
        // Without a const KeyframeContainer in osgAnimation.
        osgAnimation::Sampler* const sampler = channel->getSampler();
        if (const osgAnimation::KeyframeContainer* const keys = sampler->getKeyframeContainer())
            addTimesOf<float, double, osg::Vec2, osg::Vec3, osg::Vec4, osg::Quat, osg::Matrixf,
                       osgAnimation::FloatCubicBezier, osgAnimation::DoubleCubicBezier, osgAnimation::Vec2CubicBezier,
                       osgAnimation::Vec3CubicBezier, osgAnimation::Vec4CubicBezier>(*keys, times);
    }
    // Times of a clip are floats.
    for (double& time : times)
        time = static_cast<double>(static_cast<float>(time));
    times.erase(
        std::remove_if(times.begin(), times.end(), [](double time) { return !(time >= 0.0) || !std::isfinite(time); }),
        times.end());
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    return times;
}

} // namespace osgGpuAnimation::osganimation
