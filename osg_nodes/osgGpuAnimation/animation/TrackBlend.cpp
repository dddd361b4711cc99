// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/TrackBlend.h>

#include <osgGpuAnimation/animation/Rotation.h>

#include <layout.glsl>

#include <glm/common.hpp>
#include <glm/ext/quaternion_exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

namespace
{

constexpr double pi = glm::pi<double>();

void addScaled(MixedTrack& sum, const MixedTrack& track, double factor)
{
    sum.translation += track.translation * factor;
    sum.rotation += track.rotation * factor;
    sum.scale += track.scale * factor;
}

/// sample / reference; 1 if the reference is 0.
double ratio(double sample, double reference)
{
    return std::abs(reference) > static_cast<double>(POSE_SMALLEST_SCALE) ? sample / reference : 1.0;
}

} // namespace

TrackBlend::TrackBlend(const JointTransform& rest, bool isWeights) : _isWeights(isWeights)
{
    _total = {glm::dvec4(rest.translation), glm::dvec4(rest.rotation), glm::dvec4(rest.scale)};
}

void TrackBlend::beginStanding()
{
    const double left = 1.0 - std::min(_weight, 1.0);
    const double share = 1.0 / std::max(_weight, 1.0);
    const bool isTurned = !_isWeights && glm::dot(_total.rotation, _group.rotation) < 0.0;
    if (isTurned) _total.rotation = -_total.rotation;
    MixedTrack total;
    addScaled(total, _total, left);
    addScaled(total, _group, share);
    _total = total;
    _group = MixedTrack();
    _weight = 0.0;
}

void TrackBlend::add(const MixedTrack& sample, double weight)
{
    if (_weight == 0.0) _hemisphere = sample.rotation;
    _weight += weight;
    MixedTrack turned = sample;
    if (!_isWeights && glm::dot(_hemisphere, sample.rotation) < 0.0) turned.rotation = -turned.rotation;
    addScaled(_group, turned, weight);
}

void TrackBlend::addDifference(const MixedTrack& reference, const MixedTrack& sample, double weight)
{
    addScaled(_difference, sample, weight);
    addScaled(_difference, reference, -weight);
    if (_isWeights) return;
    const glm::dquat turn =
        glm::conjugate(Rotation::quaternion(reference.rotation)) * Rotation::quaternion(sample.rotation);
    const glm::dquat logarithm = glm::log(turn.w < 0.0 ? -turn : turn); // of the turn the short way
    _turn += weight * glm::dvec3(logarithm.x, logarithm.y, logarithm.z);
    for (int axis = 0; axis < 3; ++axis)
        _growth[axis] *= 1.0 + weight * (ratio(sample.scale[axis], reference.scale[axis]) - 1.0);
}

MixedTrack TrackBlend::result()
{
    beginStanding();
    if (_isWeights)
    {
        addScaled(_total, _difference, 1.0);
        return _total;
    }
    // The sum cannot have length 0: see PoseInstruction.
    _total.rotation = Rotation::unit(_total.rotation);
    if (const double turned = glm::length(_turn); turned > 0.0)
        _total.rotation = Rotation::numbers(Rotation::quaternion(_total.rotation) *
                                            glm::exp(glm::dquat(0.0, _turn * std::min(1.0, pi / turned))));
    _total.translation += _difference.translation;
    _total.scale *= _growth;
    _total.translation.w = 0.0; // in a spline clip it held a flag
    _total.scale.w = 0.0;
    return _total;
}

} // namespace osgGpuAnimation
