// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Clip.h>

#include <cstddef>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// The keys of one property of a clip, as a glTF animation sampler has them (2.0, section 3.11).
struct ClipKeys
{
    const char* interpolation = "LINEAR"; ///< LINEAR, STEP or CUBICSPLINE
    std::vector<float> times;             ///< strictly ascending; empty: the property keeps its rest value
    std::vector<float> values;            ///< key by key; CUBICSPLINE: in-tangent, value, out-tangent
};

/// The numbers of a property in a keyframe: consecutive ones of a track, or of several tracks (see MorphWeights).
struct ClipProperty
{
    std::size_t track = 0;
    std::size_t firstNumber = 0; ///< see JointTransform::number()
    std::size_t count = 0;       ///< beyond 12, they go on in the next track
    bool isRotation = false;
};

/// The property's keys without those that their neighbours make superfluous. rest: the values of the rest pose. In the
/// clip two keyframes at one time are a jump; here the first of them is one float earlier, or the keys are STEP.
/// Pieces that ClipBuilder has cut from one spline are joined again: cut rotations are not unit.
ClipKeys keysOf(const Clip& clip, const ClipProperty& property, const std::vector<float>& rest);

} // namespace osgGpuAnimation::gltf
