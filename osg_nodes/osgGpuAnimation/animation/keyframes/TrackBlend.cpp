// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/keyframes/TrackBlend.h>

#include <osgGpuAnimation/math/Hermite.h>
#include <osgGpuAnimation/math/Rotation.h>

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

glm::dvec4 lerp(const glm::vec4& a, const glm::vec4& b, double alpha)
{
    return glm::dvec4(a) * (1.0 - alpha) + glm::dvec4(b) * alpha;
}

/// a and b each point to value, in-tangent, out-tangent.
MixedTrack mixSpline(const JointTransform* a, const JointTransform* b, double alpha, bool isWeights)
{
    const auto partAt = [&](glm::vec4 JointTransform::*part)
    {
        return hermite(glm::dvec4(a[0].*part), glm::dvec4(a[2].*part), glm::dvec4(b[0].*part), glm::dvec4(b[1].*part),
                       alpha);
    };
    MixedTrack mixed{partAt(&JointTransform::translation), {}, partAt(&JointTransform::scale)};
    const bool isSlerped = a[0].translation.w == 1.0f; // see Clip
    if (isWeights)
        mixed.rotation = partAt(&JointTransform::rotation);
    else
        mixed.rotation = isSlerped ? Rotation::slerp(glm::dvec4(a[0].rotation), glm::dvec4(b[0].rotation), alpha)
                                   : Rotation::unit(partAt(&JointTransform::rotation));
    return mixed;
}

void addScaled(MixedTrack& sum, const MixedTrack& track, double factor)
{
    sum.translation += track.translation * factor;
    sum.rotation += track.rotation * factor;
    sum.scale += track.scale * factor;
}

/// Numbers of one blend priority over those of the lower ones. weight: the sum of the priority's weights.
glm::dvec4 covered(const glm::dvec4& below, const glm::dvec4& group, const glm::dvec4& weight)
{
    return below * (1.0 - glm::min(weight, 1.0)) + group / glm::max(weight, 1.0);
}

/// sample / reference; 1 if the reference is 0.
double ratio(double sample, double reference)
{
    return std::abs(reference) > static_cast<double>(POSE_SMALLEST_SCALE) ? sample / reference : 1.0;
}

} // namespace

MixedTrack MixedTrack::between(const KeyframePair& keyframes, std::size_t track, bool isWeights)
{
    if (keyframes.spline)
        return mixSpline(keyframes.first + 3 * track, keyframes.second + 3 * track, keyframes.alpha, isWeights);
    const JointTransform &a = keyframes.first[track], &b = keyframes.second[track];
    return {lerp(a.translation, b.translation, keyframes.alpha),
            isWeights ? lerp(a.rotation, b.rotation, keyframes.alpha)
                      : Rotation::slerp(glm::dvec4(a.rotation), glm::dvec4(b.rotation), keyframes.alpha),
            lerp(a.scale, b.scale, keyframes.alpha)};
}

TrackBlend::TrackBlend(const JointTransform& rest, bool isWeights) : _isWeights(isWeights)
{
    _total = {glm::dvec4(rest.translation), glm::dvec4(rest.rotation), glm::dvec4(rest.scale)};
}

void TrackBlend::beginBlendPriority()
{
    if (!_isWeights && glm::dot(_total.rotation, _group.rotation) < 0.0) _total.rotation = -_total.rotation;
    _total = {covered(_total.translation, _group.translation, _weights.translation),
              covered(_total.rotation, _group.rotation, _weights.rotation),
              covered(_total.scale, _group.scale, _weights.scale)};
    _group = _weights = MixedTrack();
}

void TrackBlend::add(const MixedTrack& sample, double weight, const MixedTrack& cover)
{
    if (_weights.rotation.w == 0.0) _hemisphere = sample.rotation;
    addScaled(_weights, cover, weight);
    MixedTrack turned = sample;
    if (!_isWeights && glm::dot(_hemisphere, sample.rotation) < 0.0) turned.rotation = -turned.rotation;
    addScaled(_group, turned, weight);
}

void TrackBlend::addDifference(const MixedTrack& reference, const MixedTrack& sample, double weight,
                               const MixedTrack& cover)
{
    const MixedTrack weights{weight * cover.translation, weight * cover.rotation, weight * cover.scale};
    _difference.translation += weights.translation * (sample.translation - reference.translation);
    _difference.rotation += weights.rotation * (sample.rotation - reference.rotation);
    _difference.scale += weights.scale * (sample.scale - reference.scale);
    if (_isWeights) return;
    if (cover.rotation.w > 0.0)
    {
        const glm::dquat turn =
            glm::conjugate(Rotation::quaternion(reference.rotation)) * Rotation::quaternion(sample.rotation);
        const glm::dquat logarithm = glm::log(turn.w < 0.0 ? -turn : turn); // of the turn the short way
        _turn += weight * glm::dvec3(logarithm.x, logarithm.y, logarithm.z);
    }
    for (int axis = 0; axis < 3; ++axis)
        _growth[axis] *= 1.0 + weights.scale[axis] * (ratio(sample.scale[axis], reference.scale[axis]) - 1.0);
}

MixedTrack TrackBlend::result()
{
    beginBlendPriority();
    if (_isWeights)
    {
        addScaled(_total, _difference, 1.0);
        return _total;
    }
    // The sum cannot have length 0: see PoseInstruction.
    _total.rotation = Rotation::unit(_total.rotation);
    // glm::exp returns an uninitialized quaternion below the machine epsilon; so small a turn changes no digit.
    if (const double turned = glm::length(_turn); turned > 1e-15)
        _total.rotation =
            Rotation::numbers(Rotation::quaternion(_total.rotation) *
                              glm::exp(glm::dquat(0.0, _turn * std::min(1.0, glm::pi<double>() / turned))));
    _total.translation += _difference.translation;
    _total.scale *= _growth;
    _total.translation.w = 0.0; // spline clips store a flag there
    _total.scale.w = 0.0;
    return _total;
}

} // namespace osgGpuAnimation
