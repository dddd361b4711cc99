// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/bounds/JointRange.h>

#include <osgGpuAnimation/animation/keyframes/PosedKeyframe.h>
#include <osgGpuAnimation/math/Box.h>
#include <osgGpuAnimation/math/Rotation.h>

#include <layout.glsl>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
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

/// Calls function(value, tangent, sign) for each keyframe of a track and, in a spline, for the inner points of its
/// Bézier form, whose hull contains the curve: a point is value + sign · tangent / 3. sign: 0, -1 or 1.
template <typename Function>
void forEachPoint(const Clip& clip, std::size_t track, Function function)
{
    for (std::size_t k = 0; k < clip.keyframeCount(); ++k)
    {
        const JointTransform* value = clip.at(k, track);
        function(value[0], JointTransform(), 0.0);
        if (clip.form() != Clip::Form::Spline) continue;
        function(value[0], value[1], -1.0);
        function(value[0], value[2], 1.0);
    }
}

glm::dvec4 rotationAt(const JointTransform& value, const JointTransform& tangent, double sign)
{
    const bool isSpline = sign != 0.0 && value.translation.w != 1.0f; // see Clip
    return isSpline ? glm::dvec4(value.rotation) + glm::dvec4(tangent.rotation) * (sign / 3.0)
                    : glm::dvec4(value.rotation);
}

JointRange rangeOf(const Clip& clip, std::size_t joint)
{
    glm::dvec3 low(HUGE_VAL), high(-HUGE_VAL), minScale(HUGE_VAL), maxScale(-HUGE_VAL);
    glm::dvec4 sum(0.0);
    forEachPoint(clip, joint,
                 [&](const JointTransform& value, const JointTransform& tangent, double sign)
                 {
                     const glm::dvec3 translation =
                         glm::dvec3(value.translation) + glm::dvec3(tangent.translation) * (sign / 3.0);
                     const glm::dvec3 scale = glm::dvec3(value.scale) + glm::dvec3(tangent.scale) * (sign / 3.0);
                     const glm::dvec4 rotation = rotationAt(value, tangent, sign);
                     low = glm::min(low, translation);
                     high = glm::max(high, translation);
                     minScale = glm::min(minScale, scale);
                     maxScale = glm::max(maxScale, scale);
                     sum += glm::dot(sum, rotation) < 0.0 ? -rotation : rotation;
                 });
    JointRange range;
    range.translation = 0.5 * (low + high);
    range.shift = 0.5 * glm::length(high - low);
    range.scale = 0.5 * (minScale + maxScale);
    range.stretch = 0.5 * maxComponent(maxScale - minScale);
    range.rotation = Rotation::unit(sum);
    forEachPoint(clip, joint,
                 [&](const auto&... point)
                 { range.turn = std::max(range.turn, lineAngle(range.rotation, rotationAt(point...))); });
    range.turn = limitedTurn(range.turn);
    return range;
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

    const glm::dvec3 minScale = glm::min(scale - stretch, other.scale - other.stretch);
    const glm::dvec3 maxScale = glm::max(scale + stretch, other.scale + other.stretch);
    scale = 0.5 * (minScale + maxScale);
    stretch = 0.5 * maxComponent(maxScale - minScale);

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
    stretch += maxComponent(glm::abs(scale) + stretch) * growth;
}

JointRange PoseExtent::Joint::range(const JointRange& others) const
{
    JointRange range = others;
    if (moves)
    {
        range.translation = glm::dvec3(translation);
        range.shift = static_cast<double>(shift);
    }
    if (turns) range.turn = JointRange::anyTurn;
    if (scales)
    {
        range.scale = glm::dvec3(scale);
        range.stretch = static_cast<double>(stretch);
    }
    return range;
}

// Without branches, since applications stream whole skeletons.
bool PoseExtent::containsAll(const std::vector<JointTransform>& transforms) const
{
    if (joints.size() != transforms.size()) return false;
    bool isInside = true;
    for (std::size_t joint = 0; joint < transforms.size(); ++joint)
    {
        const Joint& known = joints[joint];
        const JointTransform& t = transforms[joint];
        const glm::vec3 moved = glm::vec3(t.translation) - known.translation;
        const glm::vec3 grown = glm::abs(glm::vec3(t.scale) - known.scale);
        const float distance = glm::dot(moved, moved), stretch = 0.999f * known.stretch;
        const bool isStored = PosedNumbers::isStoredAsItIs(t), isKnown = known.moves & known.turns & known.scales;
        // No maximum, which would hide a NaN.
        isInside = isInside & isStored & isKnown & (distance <= 0.999f * known.shift * known.shift) &
                   (grown.x <= stretch) & (grown.y <= stretch) & (grown.z <= stretch);
    }
    return isInside;
}

std::vector<JointRange> rangesOfClip(const AnimationSet& set, const Clip* clip)
{
    std::vector<JointRange> ranges;
    for (std::size_t joint = 0; joint < set.skeleton().jointCount(); ++joint)
        ranges.push_back(clip ? rangeOf(*clip, joint) : JointRange::of(set.restPose()[joint]));
    return ranges;
}

std::vector<WeightRange> weightRanges(const AnimationSet& set, std::size_t morph)
{
    std::vector<WeightRange> ranges;
    const std::vector<float>& defaults = set.morphs()[morph].defaults;
    for (std::size_t weight = 0; weight < defaults.size(); ++weight)
    {
        const std::size_t track = set.firstTrackOfMorph(morph) + weight / MorphWeights::weightsPerBlock;
        const std::size_t place = weight % MorphWeights::weightsPerBlock;
        WeightRange range{defaults[weight], defaults[weight]};
        const auto include = [&](const JointTransform& value, const JointTransform& tangent, double sign)
        {
            const float point = value.number(place) + static_cast<float>(sign) * tangent.number(place) / 3.0f;
            range.min = std::min(range.min, point);
            range.max = std::max(range.max, point);
        };
        for (const Clip& clip : set.clips())
            forEachPoint(clip, track, include);
        ranges.push_back(range);
    }
    return ranges;
}

} // namespace osgGpuAnimation
