// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/bounds/TransformBound.h>

#include <osgGpuAnimation/math/Box.h>

#include <layout.glsl>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

static_assert(TransformBound::maxNumber == POSE_LARGEST_NUMBER, "the import lets nothing through that shaders limit");

namespace
{

/// Widens the bound to a value, or to a value and its tangents: a spline stays within their sum.
void widen(TransformBound& bound, const JointTransform* transforms, std::size_t count)
{
    TransformBound sum{0.0, 0.0};
    for (std::size_t i = 0; i < count; ++i)
    {
        sum.distance += glm::length(glm::dvec3(transforms[i].translation));
        sum.stretch += maxComponent(glm::dvec3(transforms[i].scale));
    }
    // Keep NaN: it compares false, so fits() is false.
    if (!(sum.distance <= bound.distance)) bound.distance = sum.distance;
    if (!(sum.stretch <= bound.stretch)) bound.stretch = sum.stretch;
}

/// The local bounds of all joints at rest.
std::vector<TransformBound> localsAtRest(const Skeleton& skeleton)
{
    std::vector<TransformBound> locals;
    for (const Joint& joint : skeleton.joints())
        locals.push_back(TransformBound::of(joint.rest));
    return locals;
}

/// Of each joint in the clip.
void addClip(const Clip& clip, std::vector<TransformBound>& locals)
{
    for (std::size_t keyframe = 0; keyframe < clip.keyframeCount(); ++keyframe)
        for (std::size_t joint = 0; joint < locals.size(); ++joint)
            widen(locals[joint], clip.at(keyframe, joint), clip.transformsPerTrack());
}

std::vector<TransformBound> chained(const Skeleton& skeleton, const std::vector<TransformBound>& locals)
{
    std::vector<TransformBound> bounds;
    for (std::size_t joint = 0; joint < locals.size(); ++joint)
    {
        const int parent = skeleton.joint(joint).parent;
        bounds.push_back(parent < 0 ? locals[joint] : bounds[parent] * locals[joint]);
    }
    return bounds;
}

TransformBound boundOf(const AffineMatrix& matrix)
{
    return TransformBound::of(matrix.toColumns());
}

bool isSmall(const JointTransform& transform)
{
    bool isSmall = true;
    for (std::size_t i = 0; i < 12; ++i)
        isSmall = isSmall && std::abs(transform.number(i)) <= TransformBound::maxNumber; // false for NaN
    return isSmall;
}

} // namespace

TransformBound TransformBound::of(const glm::dmat4& matrix)
{
    const double squares = glm::dot(matrix[0], matrix[0]) + glm::dot(matrix[1], matrix[1]) +
                           glm::dot(matrix[2], matrix[2]); // no less than the longest squared
    return {std::sqrt(squares), glm::length(glm::dvec3(matrix[3]))};
}

TransformBound TransformBound::of(const JointTransform& transform)
{
    TransformBound own{0.0, 0.0};
    widen(own, &transform, 1);
    return own;
}

TransformBound TransformBound::operator*(const TransformBound& inner) const
{
    return {stretch * inner.stretch, of(inner.distance)};
}

void TransformBound::add(const TransformBound& other)
{
    stretch = std::max(stretch, other.stretch);
    distance = std::max(distance, other.distance);
}

std::vector<TransformBound> boundsAtRest(const Skeleton& skeleton)
{
    return chained(skeleton, localsAtRest(skeleton));
}

std::vector<TransformBound> boundsOfClip(const Skeleton& skeleton, const Clip& clip)
{
    std::vector<TransformBound> locals(skeleton.jointCount(), {0.0, 0.0});
    addClip(clip, locals);
    return chained(skeleton, locals);
}

bool fits(const Skeleton& skeleton, const Clip& clip)
{
    const std::vector<TransformBound> bounds = boundsOfClip(skeleton, clip);
    return std::all_of(bounds.begin(), bounds.end(), [](const TransformBound& bound) { return bound.fits(); }) &&
           std::all_of(clip.data().begin(), clip.data().end(), isSmall);
}

std::string outOfRangeText()
{
    return "farther out than 1e18, the limit for float numbers";
}

std::vector<TransformBound> boundsOfEntries(const AnimationSet& set)
{
    std::vector<TransformBound> joints = boundsAtRest(set.skeleton());
    for (const Clip& clip : set.clips())
    {
        const std::vector<TransformBound> moved = boundsOfClip(set.skeleton(), clip);
        for (std::size_t joint = 0; joint < joints.size(); ++joint)
            joints[joint].add(moved[joint]);
    }
    std::vector<TransformBound> entries;
    for (const PaletteEntry& entry : set.palette())
        entries.push_back(entry.joint < 0 ? TransformBound{0.0, 0.0}
                                          : joints[entry.joint] * boundOf(entry.inverseBind));
    return entries;
}

bool hasModestPalette(const AnimationSet& set)
{
    // Joints of several clips may meet in one pose.
    std::vector<TransformBound> locals = localsAtRest(set.skeleton());
    for (const Clip& clip : set.clips())
        addClip(clip, locals);
    const std::vector<TransformBound> toModel = chained(set.skeleton(), locals);
    // As world.glsl multiplies: parentEntry * (parentBind * (local * inverseBind)).
    for (const PaletteEntry& entry : set.palette())
    {
        if (entry.joint < 0) continue;
        TransformBound inner = boundOf(entry.inverseBind), above;
        if (entry.track >= 0) inner = locals[entry.joint] * inner;
        const TransformBound outer = boundOf(entry.parentBind) * inner;
        if (entry.parent >= 0)
        {
            const PaletteEntry& parent = set.palette()[entry.parent];
            above = toModel[parent.joint] * boundOf(parent.inverseBind);
        }
        if (!inner.fits() || !outer.fits() || !(above * outer).fits()) return false;
    }
    return true;
}

} // namespace osgGpuAnimation
