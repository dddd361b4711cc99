// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/bounds/JointRange.h>

#include <osgGpuAnimation/animation/JointTransform.h>

#include <layout.glsl>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace osgGpuAnimation
{

namespace
{

/// The rotations of a wider cap may lie on two hemispheres.
constexpr double widestCap = 0.785; // 45 degrees

/// The angle between two quaternions up to sign, in radians.
double lineAngle(const glm::dvec4& a, const glm::dvec4& b)
{
    const double lengths = glm::length(a) * glm::length(b);
    return lengths > 0.0 ? std::acos(std::min(std::abs(glm::dot(a, b)) / lengths, 1.0)) : JointRange::anyTurn;
}

double limitedTurn(double turn)
{
    return turn < widestCap ? turn : JointRange::anyTurn;
}

/// All values of one joint in a clip: every keyframe and, for a spline, the inner points of its Bézier form, whose hull
/// contains the curve.
template <typename Function>
void forEachPoint(const Clip& clip, std::size_t joint, Function function)
{
    const bool isSpline = clip.form() == Clip::Form::Spline;
    for (std::size_t k = 0; k < clip.keyframeCount(); ++k)
    {
        const JointTransform* value = clip.at(k, joint);
        const glm::dvec3 translation(value->translation), scale(value->scale);
        const glm::dvec4 rotation(value->rotation);
        function(translation, rotation, scale);
        if (!isSpline) continue;
        const bool isSlerped = value->translation.w == 1.0f;
        for (const auto& [tangent, third] : {std::pair(value + 1, -1.0 / 3.0), std::pair(value + 2, 1.0 / 3.0)})
            function(translation + glm::dvec3(tangent->translation) * third,
                     isSlerped ? rotation : rotation + glm::dvec4(tangent->rotation) * third,
                     scale + glm::dvec3(tangent->scale) * third);
    }
}

JointRange rangeOf(const Clip& clip, std::size_t joint)
{
    glm::dvec3 low(HUGE_VAL), high(-HUGE_VAL), smallest(HUGE_VAL), largest(-HUGE_VAL);
    glm::dvec4 sum(0.0);
    forEachPoint(clip, joint,
                 [&](const glm::dvec3& translation, const glm::dvec4& rotation, const glm::dvec3& scale)
                 {
                     low = glm::min(low, translation);
                     high = glm::max(high, translation);
                     smallest = glm::min(smallest, scale);
                     largest = glm::max(largest, scale);
                     sum += glm::dot(sum, rotation) < 0.0 ? -rotation : rotation;
                 });
    JointRange range;
    range.translation = 0.5 * (low + high);
    range.shift = 0.5 * glm::length(high - low);
    range.scale = 0.5 * (smallest + largest);
    const glm::dvec3 stretch = 0.5 * (largest - smallest);
    range.stretch = std::max({stretch.x, stretch.y, stretch.z});
    range.rotation = Rotation::unit(sum);
    forEachPoint(clip, joint,
                 [&](const glm::dvec3&, const glm::dvec4& rotation, const glm::dvec3&)
                 { range.turn = std::max(range.turn, lineAngle(range.rotation, rotation)); });
    range.turn = limitedTurn(range.turn);
    return range;
}

void include(WeightRange& range, float value)
{
    range.min = std::min(range.min, value);
    range.max = std::max(range.max, value);
}

void includeClip(WeightRange& range, const Clip& clip, std::size_t track, std::size_t place)
{
    const bool isSpline = clip.form() == Clip::Form::Spline;
    for (std::size_t keyframe = 0; keyframe < clip.keyframeCount(); ++keyframe)
    {
        const JointTransform* transform = clip.at(keyframe, track);
        const float value = transform[0].number(place);
        include(range, value);
        if (!isSpline) continue;
        include(range, value - transform[1].number(place) / 3.0f);
        include(range, value + transform[2].number(place) / 3.0f);
    }
}

} // namespace

JointRange JointRange::of(const JointTransform& transform)
{
    JointRange range;
    range.translation = glm::dvec3(transform.translation);
    range.rotation = Rotation::unit(glm::dvec4(transform.rotation));
    range.scale = glm::dvec3(transform.scale);
    return range;
}

void JointRange::add(const JointRange& other)
{
    const glm::dvec3 low = glm::min(translation - shift, other.translation - other.shift);
    const glm::dvec3 high = glm::max(translation + shift, other.translation + other.shift);
    const glm::dvec3 middle = 0.5 * (low + high);
    shift = std::max(glm::length(translation - middle) + shift, glm::length(other.translation - middle) + other.shift);
    translation = middle;

    const glm::dvec3 smallest = glm::min(scale - stretch, other.scale - other.stretch);
    const glm::dvec3 largest = glm::max(scale + stretch, other.scale + other.stretch);
    scale = 0.5 * (smallest + largest);
    const glm::dvec3 half = 0.5 * (largest - smallest);
    stretch = std::max({half.x, half.y, half.z});

    const glm::dvec4 both =
        Rotation::unit(rotation + (glm::dot(rotation, other.rotation) < 0.0 ? -other.rotation : other.rotation));
    turn = limitedTurn(std::max(lineAngle(both, rotation) + turn, lineAngle(both, other.rotation) + other.turn));
    rotation = both;
}

void JointRange::addDifference(const JointRange& added, const JointTransform& reference)
{
    shift += glm::length(added.translation - glm::dvec3(reference.translation)) + added.shift;
    // No limit: additive samples come last, so the result is not mixed again.
    turn += lineAngle(added.rotation, glm::dvec4(reference.rotation)) + added.turn;
    double growth = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
        const double size = std::abs(static_cast<double>(reference.scale[axis]));
        const double change = std::abs(added.scale[axis] - static_cast<double>(reference.scale[axis])) + added.stretch;
        if (size > static_cast<double>(POSE_SMALLEST_SCALE)) growth = std::max(growth, change / size);
    }
    const glm::dvec3 most = glm::abs(scale) + stretch;
    stretch += std::max({most.x, most.y, most.z}) * growth;
}

std::vector<JointRange> rangesOfClip(const AnimationSet& set, const Clip& clip)
{
    std::vector<JointRange> ranges;
    for (std::size_t joint = 0; joint < set.skeleton().jointCount(); ++joint)
        ranges.push_back(clip.keyframeCount() > 0 ? rangeOf(clip, joint) : JointRange::of(set.restPose()[joint]));
    return ranges;
}

std::vector<WeightRange> weightRanges(const AnimationSet& set, std::size_t morph)
{
    std::vector<WeightRange> ranges;
    const std::vector<float>& defaults = set.morphs()[morph].defaults;
    for (std::size_t weight = 0; weight < defaults.size(); ++weight)
    {
        const std::size_t track = set.firstTrackOfMorph(morph) + weight / MorphWeights::weightsPerBlock;
        WeightRange range{defaults[weight], defaults[weight]};
        for (const Clip& clip : set.clips())
            includeClip(range, clip, track, weight % MorphWeights::weightsPerBlock);
        ranges.push_back(range);
    }
    return ranges;
}

} // namespace osgGpuAnimation
