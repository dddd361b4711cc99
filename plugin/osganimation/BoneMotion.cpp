// SPDX-License-Identifier: MIT
#include "osganimation/BoneMotion.h"

#include "osganimation/CurveKeys.h"

#include <osgGpuAnimation/math/Rotation.h>
#include <osgGpuAnimation/scene/OsgMatrix.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation::osganimation
{

namespace
{

osg::Matrixd matrixOf(const JointTransform& transform)
{
    return toOsg(transform.toMatrix());
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
    return BoneMotion::difference(matrixOf(transformOf(matrix)), matrix) < 1e-4 * BoneMotion::size(matrix);
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

double BoneMotion::difference(const osg::Matrixd& a, const osg::Matrixd& b)
{
    double max = 0.0;
    for (int i = 0; i < 16; ++i)
        max = std::max(max, std::abs(a.ptr()[i] - b.ptr()[i]));
    return max;
}

double BoneMotion::size(const osg::Matrixd& matrix)
{
    return difference(matrix, osg::Matrixd(0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0));
}

osg::Matrixd BoneMotion::between(const osg::Matrixd& from, const osg::Matrixd& to, float share)
{
    const JointTransform a = transformOf(from), b = transformOf(to);
    const glm::dvec4 rotation =
        Rotation::slerp(glm::dvec4(a.rotation), glm::dvec4(b.rotation), static_cast<double>(share));
    return matrixOf(
        {glm::mix(a.translation, b.translation, share), glm::vec4(rotation), glm::mix(a.scale, b.scale, share)});
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
    const std::vector<CurveKey<osg::Matrixd>> keys = linearKeys(*this, keyTimesOf(_channels));
    std::vector<Channel> made;
    if (keys.empty()) return made;
    for (const Channel::Path path : {Channel::Path::Translation, Channel::Path::Rotation, Channel::Path::Scale})
    {
        Channel channel;
        channel.path = path;
        channel.target = target;
        for (const CurveKey<osg::Matrixd>& key : keys)
        {
            const JointTransform transform = transformOf(key.value);
            const glm::vec4& part = path == Channel::Path::Translation ? transform.translation
                                    : path == Channel::Path::Rotation  ? transform.rotation
                                                                       : transform.scale;
            channel.times.push_back(key.seconds);
            for (int i = 0; i < (path == Channel::Path::Rotation ? 4 : 3); ++i)
                channel.values.push_back(static_cast<double>(part[i]));
        }
        made.push_back(std::move(channel));
    }
    return made;
}

} // namespace osgGpuAnimation::osganimation
