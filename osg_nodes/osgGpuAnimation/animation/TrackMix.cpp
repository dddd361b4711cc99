// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/TrackMix.h>

#include <osgGpuAnimation/animation/Hermite.h>
#include <osgGpuAnimation/animation/Rotation.h>

namespace osgGpuAnimation
{

namespace
{

glm::dvec4 lerp(const glm::vec4& a, const glm::vec4& b, double alpha)
{
    return glm::dvec4(a) * (1.0 - alpha) + glm::dvec4(b) * alpha;
}

MixedTrack mixLinear(const JointTransform& a, const JointTransform& b, double alpha, bool isWeights)
{
    return {lerp(a.translation, b.translation, alpha),
            isWeights ? lerp(a.rotation, b.rotation, alpha)
                      : Rotation::slerp(glm::dvec4(a.rotation), glm::dvec4(b.rotation), alpha),
            lerp(a.scale, b.scale, alpha)};
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

} // namespace

MixedTrack MixedTrack::between(const KeyframePair& keyframes, std::size_t track, bool isWeights)
{
    if (keyframes.spline)
        return mixSpline(keyframes.first + 3 * track, keyframes.second + 3 * track, keyframes.alpha, isWeights);
    return mixLinear(keyframes.first[track], keyframes.second[track], keyframes.alpha, isWeights);
}

} // namespace osgGpuAnimation
