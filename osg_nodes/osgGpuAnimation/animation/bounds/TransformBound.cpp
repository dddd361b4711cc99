// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/bounds/TransformBound.h>

#include <layout.glsl>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

static_assert(TransformBound::farthest == POSE_LARGEST_NUMBER, "the import lets nothing through that shaders limit");

namespace
{

/// Of a value, or of a value and its tangents: a spline stays within their sum.
struct Largest
{
    double translation = 0.0;
    double scale = 0.0;

    void add(const JointTransform* transforms, std::size_t count)
    {
        double far = 0.0, large = 0.0;
        for (std::size_t i = 0; i < count; ++i)
        {
            far += glm::length(glm::dvec3(transforms[i].translation));
            const glm::dvec3 sizes = glm::abs(glm::dvec3(transforms[i].scale));
            large += std::max({sizes.x, sizes.y, sizes.z});
        }
        // Keep NaN: it compares false, so fits() is false.
        if (!(far <= translation)) translation = far;
        if (!(large <= scale)) scale = large;
    }
};

/// Of each joint in the clip.
void addClip(const Clip& clip, std::vector<Largest>& locals)
{
    for (std::size_t keyframe = 0; keyframe < clip.keyframeCount(); ++keyframe)
        for (std::size_t joint = 0; joint < locals.size(); ++joint)
            locals[joint].add(clip.at(keyframe, joint), clip.transformsPerTrack());
}

std::vector<TransformBound> chained(const Skeleton& skeleton, const std::vector<Largest>& locals)
{
    std::vector<TransformBound> bounds;
    bounds.reserve(locals.size());
    for (std::size_t joint = 0; joint < locals.size(); ++joint)
    {
        const TransformBound local{locals[joint].scale, locals[joint].translation};
        const int parent = skeleton.joint(joint).parent;
        bounds.push_back(parent < 0 ? local : bounds[static_cast<std::size_t>(parent)] * local);
    }
    return bounds;
}

TransformBound boundOf(const AffineMatrix& matrix)
{
    return TransformBound::of(matrix.toColumns());
}

bool isSmall(const glm::vec4& numbers)
{
    for (int i = 0; i < 4; ++i)
        if (!(std::abs(double(numbers[i])) <= TransformBound::farthest)) return false;
    return true;
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
    Largest own;
    own.add(&transform, 1);
    return {own.scale, own.translation};
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
    std::vector<Largest> locals(skeleton.jointCount());
    for (std::size_t joint = 0; joint < locals.size(); ++joint)
        locals[joint].add(&skeleton.joint(joint).rest, 1);
    return chained(skeleton, locals);
}

std::vector<TransformBound> boundsOfClip(const Skeleton& skeleton, const Clip& clip)
{
    std::vector<Largest> locals(skeleton.jointCount());
    addClip(clip, locals);
    return chained(skeleton, locals);
}

bool fits(const Skeleton& skeleton, const Clip& clip)
{
    const std::vector<TransformBound> bounds = boundsOfClip(skeleton, clip);
    return std::all_of(bounds.begin(), bounds.end(), [](const TransformBound& bound) { return bound.fits(); }) &&
           std::all_of(clip.data().begin(), clip.data().end(),
                       [](const JointTransform& transform) {
                           return isSmall(transform.translation) && isSmall(transform.rotation) &&
                                  isSmall(transform.scale);
                       });
}

std::string beyondFarthest()
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
                                          : joints[static_cast<std::size_t>(entry.joint)] * boundOf(entry.inverseBind));
    return entries;
}

bool hasModestPalette(const AnimationSet& set)
{
    // Joints of several clips may meet in one pose.
    std::vector<Largest> locals(set.skeleton().jointCount());
    for (std::size_t joint = 0; joint < locals.size(); ++joint)
        locals[joint].add(&set.restPose()[joint], 1);
    for (const Clip& clip : set.clips())
        addClip(clip, locals);
    const std::vector<TransformBound> toModel = chained(set.skeleton(), locals);
    // As world.glsl multiplies: parentEntry * (parentBind * (local * inverseBind)).
    for (const PaletteEntry& entry : set.palette())
    {
        if (entry.joint < 0) continue;
        TransformBound inner = boundOf(entry.inverseBind), above;
        const Largest& local = locals[static_cast<std::size_t>(entry.joint)];
        if (entry.track >= 0) inner = TransformBound{local.scale, local.translation} * inner;
        const TransformBound outer = boundOf(entry.parentBind) * inner;
        if (entry.parent >= 0)
        {
            const PaletteEntry& parent = set.palette()[static_cast<std::size_t>(entry.parent)];
            above = toModel[static_cast<std::size_t>(parent.joint)] * boundOf(parent.inverseBind);
        }
        if (!inner.fits() || !outer.fits() || !(above * outer).fits()) return false;
    }
    return true;
}

} // namespace osgGpuAnimation
