// SPDX-License-Identifier: MIT
#include "osganimation/BoneMotion.h"

#include <osgGpuAnimation/nodes/OsgMatrix.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace osgGpuAnimation::osganimation
{

namespace
{

constexpr double tolerance = 1e-5;
constexpr int mostHalvings = 8;

using KeyframeContainers =
    std::tuple<osgAnimation::FloatKeyframeContainer, osgAnimation::DoubleKeyframeContainer,
               osgAnimation::Vec2KeyframeContainer, osgAnimation::Vec3KeyframeContainer,
               osgAnimation::Vec4KeyframeContainer, osgAnimation::QuatKeyframeContainer,
               osgAnimation::MatrixKeyframeContainer, osgAnimation::FloatCubicBezierKeyframeContainer,
               osgAnimation::DoubleCubicBezierKeyframeContainer, osgAnimation::Vec2CubicBezierKeyframeContainer,
               osgAnimation::Vec3CubicBezierKeyframeContainer, osgAnimation::Vec4CubicBezierKeyframeContainer>;

template <class Container>
void addTimes(const osgAnimation::KeyframeContainer& keys, std::vector<double>& times)
{
    const auto* const typed = dynamic_cast<const Container*>(&keys);
    for (std::size_t i = 0; typed && i < typed->size(); ++i)
        times.push_back((*typed)[i].getTime());
}

template <class... Containers>
void addTimesOf(const osgAnimation::KeyframeContainer& keys, std::vector<double>& times, std::tuple<Containers...>*)
{
    (addTimes<Containers>(keys, times), ...);
}

double largestNumber(const osg::Matrixd& matrix)
{
    double largest = 0.0;
    for (int i = 0; i < 16; ++i)
        largest = std::max(largest, std::abs(matrix.ptr()[i]));
    return largest;
}

double largestDifference(const osg::Matrixd& a, const osg::Matrixd& b)
{
    double largest = 0.0;
    for (int i = 0; i < 16; ++i)
        largest = std::max(largest, std::abs(a.ptr()[i] - b.ptr()[i]));
    return largest;
}

osg::Matrixd matrixOf(const JointTransform& transform)
{
    return toOsg(transform.toMatrix());
}

/// Linear, and slerp the short way, as the kit mixes two keys.
JointTransform between(const JointTransform& a, const JointTransform& b, float share)
{
    const glm::dvec4 rotation =
        Rotation::slerp(glm::dvec4(a.rotation), glm::dvec4(b.rotation), static_cast<double>(share));
    return {glm::mix(a.translation, b.translation, share), glm::vec4(rotation), glm::mix(a.scale, b.scale, share)};
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
    return largestDifference(matrixOf(transformOf(matrix)), matrix) < 1e-4 * largestNumber(matrix);
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

std::vector<double> BoneMotion::keyTimes() const
{
    std::vector<double> times;
    for (const osg::ref_ptr<osgAnimation::Channel>& channel : _channels)
    {
        // Without a const KeyframeContainer in osgAnimation.
        osgAnimation::Sampler* const sampler = channel->getSampler();
        if (const osgAnimation::KeyframeContainer* const keys = sampler->getKeyframeContainer())
            addTimesOf(*keys, times, static_cast<KeyframeContainers*>(nullptr));
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

void BoneMotion::addBetween(const Key& from, const Key& to, int depth, std::vector<Key>& keys)
{
    const JointTransform first = transformOf(from.matrix), last = transformOf(to.matrix);
    bool isLinear = true;
    for (const double share : {0.25, 0.5, 0.75})
    {
        const osg::Matrixd exact = at(from.seconds + share * (to.seconds - from.seconds));
        const osg::Matrixd linear = matrixOf(between(first, last, static_cast<float>(share)));
        isLinear = isLinear && largestDifference(linear, exact) <= tolerance * largestNumber(exact);
    }
    const auto middle = static_cast<double>(static_cast<float>(0.5 * (from.seconds + to.seconds)));
    if (isLinear || depth == mostHalvings || !(from.seconds < middle && middle < to.seconds)) return;
    const Key between{middle, at(middle)};
    addBetween(from, between, depth + 1, keys);
    keys.push_back(between);
    addBetween(between, to, depth + 1, keys);
}

std::vector<Channel> BoneMotion::channels(int target)
{
    std::vector<Key> keys;
    for (const double time : keyTimes())
    {
        const Key next{time, at(time)};
        if (!keys.empty())
        {
            // A step: the value just before this key is far from the value at it.
            const Key previous = keys.back();
            const double before = static_cast<double>(std::nextafter(static_cast<float>(time), 0.0f));
            const Key last{before, before > previous.seconds ? at(before) : next.matrix};
            const bool isStep = largestDifference(last.matrix, next.matrix) > 1e-3 * largestNumber(next.matrix) + 1e-9;
            addBetween(previous, isStep ? last : next, 0, keys);
            if (isStep) keys.push_back(last);
        }
        keys.push_back(next);
    }
    std::vector<Channel> made;
    if (keys.empty()) return made;
    for (const Channel::Path path : {Channel::Path::Translation, Channel::Path::Rotation, Channel::Path::Scale})
    {
        Channel channel;
        channel.path = path;
        channel.target = target;
        for (const Key& key : keys)
        {
            const JointTransform transform = transformOf(key.matrix);
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
