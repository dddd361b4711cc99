// SPDX-License-Identifier: MIT
#include "support/ReferencePose.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/JointPose.h>
#include <osgGpuAnimation/animation/Pose.h>

#include <glm/geometric.hpp>
#include <layout.glsl>

#include <optional>

namespace osgGpuAnimation::reference
{

namespace
{

constexpr glm::dvec4 Track::*parts[] = {&Track::translation, &Track::rotation, &Track::scale};

Numbers numbers(const glm::dvec4& v)
{
    return {v.x, v.y, v.z, v.w};
}

glm::dvec4 vector(const Numbers& v)
{
    return {v[0], v[1], v[2], v[3]};
}

/// The product of two quaternions.
glm::dvec4 multiplied(const glm::dvec4& a, const glm::dvec4& b)
{
    return {
        a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1], a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
        a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3], a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]};
}

/// Evaluates one track of one instruction.
class TrackBlender
{
public:
    TrackBlender(const AnimationSet& set, const PoseInstruction& instruction, std::size_t track)
        : _set(set), _instruction(instruction), _track(track), _isWeights(track >= set.skeleton().jointCount())
    {
    }

    double closestDecision = 1.0;

    Track result()
    {
        const JointTransform& rest = _set.restPose()[_track];
        Track total{rest.translation, rest.rotation, rest.scale};
        std::size_t i = 0;
        while (i < _instruction.sampleCount && !isDifference(i))
        {
            std::size_t end = i + 1;
            while (end < _instruction.sampleCount && !isDifference(end) && !has(end, POSE_SAMPLE_ABOVE))
                ++end;
            total = over(total, i, end);
            i = end;
        }
        if (!_isWeights) total.rotation = glm::normalize(total.rotation);
        addDifferences(total, i);
        return total;
    }

private:
    bool has(std::size_t i, std::uint32_t bits) const { return (_instruction.samples[i].control & bits) != 0; }
    bool isDifference(std::size_t i) const { return has(i, POSE_SAMPLE_REFERENCE) || has(i, POSE_SAMPLE_ADDITIVE); }

    double weight(std::size_t i) const
    {
        const BlendSample& sample = _instruction.samples[i];
        const std::uint32_t mask = sample.control >> POSE_SAMPLE_MASK_SHIFT;
        const double own = sample.weight > 0.0f ? static_cast<double>(sample.weight) : 0.0;
        return mask == 0 ? own : own * static_cast<double>(_set.masks().find(mask)->weights[_track]);
    }

    /// What the pose of a posed sample has of the track; 0 where nothing is set.
    JointPose::Track posed(std::size_t i) const
    {
        const std::uint32_t pose = _instruction.samples[i].keyframe;
        if (pose < _instruction.poses.size() && _instruction.poses[pose])
            for (const JointPose::Track& track : _instruction.poses[pose]->tracks())
                if (track.track == _track) return track;
        return {0, 0, {glm::vec4(0.0f), glm::vec4(0.0f), glm::vec4(0.0f)}};
    }

    /// 1 for each number that the sample has, else 0.
    Track cover(std::size_t i) const
    {
        const std::uint32_t numbers = has(i, POSE_SAMPLE_POSED) ? posed(i).numbers : ~0u;
        const auto four = [&](int first)
        {
            return glm::dvec4(numbers >> first & 1u, numbers >> (first + 1) & 1u, numbers >> (first + 2) & 1u,
                              numbers >> (first + 3) & 1u);
        };
        return {four(0), four(4), four(8)};
    }

    glm::dvec4 mixed(const JointTransform* a, const JointTransform* b, double t, bool isSpline,
                     glm::vec4 JointTransform::*part, bool isRotation)
    {
        const glm::dvec4 from = a->*part, to = b->*part;
        const bool isSlerped = isRotation && (!isSpline || a->translation.w == 1.0f);
        if (isSlerped)
        {
            const glm::dvec4 p = glm::normalize(from), q = glm::normalize(to);
            if (t > 0.0) closestDecision = std::min(closestDecision, std::abs(glm::dot(p, q)));
            return vector(slerp(numbers(p), numbers(q), t));
        }
        if (!isSpline) return from * (1.0 - t) + to * t;
        const glm::dvec4 outgoing = a[2].*part, incoming = b[1].*part;
        const glm::dvec4 sum = from * (2 * t * t * t - 3 * t * t + 1) + to * (3 * t * t - 2 * t * t * t) +
                               outgoing * (t * t * t - 2 * t * t + t) + incoming * (t * t * t - t * t);
        return isRotation ? glm::normalize(sum) : sum;
    }

    Track sampled(std::size_t i)
    {
        const BlendSample& sample = _instruction.samples[i];
        if (has(i, POSE_SAMPLE_POSED))
        {
            const JointTransform values = posed(i).values;
            return {values.translation, values.rotation, values.scale};
        }
        const JointTransform* a = &_set.restPose()[_track];
        const JointTransform* b = a;
        bool isSpline = false;
        for (std::size_t clip = 0; clip < _set.clips().size(); ++clip)
        {
            const Clip& content = _set.clips()[clip];
            const std::size_t first = _set.firstKeyframe(clip);
            if (sample.keyframe < first || sample.keyframe >= first + content.keyframeCount()) continue;
            const std::size_t place = sample.keyframe - first;
            const bool isLast = place + 1 >= content.keyframeCount();
            a = content.at(place, _track);
            b = isLast ? a : content.at(place + 1, _track);
            isSpline = content.form() == Clip::Form::Spline;
        }
        const double t = static_cast<double>(sample.alpha);
        return {mixed(a, b, t, isSpline, &JointTransform::translation, false),
                mixed(a, b, t, isSpline, &JointTransform::rotation, !_isWeights),
                mixed(a, b, t, isSpline, &JointTransform::scale, false)};
    }

    /// b, or -b if b is in the opposite hemisphere of a.
    glm::dvec4 onSide(const glm::dvec4& a, const glm::dvec4& b)
    {
        if (_isWeights) return b;
        const double along = glm::dot(a, b);
        if (along != 0.0) closestDecision = std::min(closestDecision, std::abs(along) / glm::length(a));
        return along < 0.0 ? -b : b;
    }

    /// The numbers of a part: `mixed` where the weights sum to 1, the rest from below.
    static glm::dvec4 filled(const glm::dvec4& below, const glm::dvec4& mixed, const glm::dvec4& whole)
    {
        return mixed / glm::max(whole, 1.0) + below * (1.0 - glm::min(whole, 1.0));
    }

    Track over(const Track& below, std::size_t first, std::size_t end)
    {
        Track whole, mixed; // a number that a sample has not is 0
        std::optional<glm::dvec4> side;
        for (std::size_t i = first; i < end; ++i)
        {
            if (weight(i) == 0.0) continue;
            Track track = sampled(i);
            const Track has = cover(i);
            if (!side && has.rotation[0] > 0.0) side = track.rotation;
            if (has.rotation[0] > 0.0) track.rotation = onSide(*side, track.rotation);
            for (const auto part : parts)
            {
                mixed.*part += track.*part * weight(i);
                whole.*part += has.*part * weight(i);
            }
        }
        if (whole.rotation[0] > 0.0 && whole.rotation[0] < 1.0) mixed.rotation = onSide(below.rotation, mixed.rotation);
        return {filled(below.translation, mixed.translation, whole.translation),
                filled(below.rotation, mixed.rotation, whole.rotation), filled(below.scale, mixed.scale, whole.scale)};
    }

    void addDifferences(Track& total, std::size_t first)
    {
        glm::dvec3 turn(0.0), growth(1.0);
        for (std::size_t i = first; i + 1 < _instruction.sampleCount; i += 2)
        {
            const double share = weight(i + 1);
            if (share == 0.0) continue;
            const Track from = sampled(i), has = cover(i + 1);
            Track to = sampled(i + 1);
            for (const auto part : parts)
                for (int n = 0; n < 4; ++n)
                    if ((has.*part)[n] == 0.0) (to.*part)[n] = (from.*part)[n];
            total.translation += share * (to.translation - from.translation);
            if (_isWeights)
            {
                total.rotation += share * (to.rotation - from.rotation);
                total.scale += share * (to.scale - from.scale);
                continue;
            }
            const glm::dvec4 inverse(-glm::dvec3(from.rotation), from.rotation.w);
            const glm::dvec4 d = onSide({0, 0, 0, 1}, multiplied(inverse, to.rotation));
            const double half = std::acos(std::min(d.w, 1.0)), sine = glm::length(glm::dvec3(d));
            turn += glm::dvec3(d) * (sine < 1e-9 ? share : share * half / sine);
            for (int c = 0; c < 3; ++c)
                if (std::abs(from.scale[c]) > 1e-6) growth[c] *= 1.0 + share * (to.scale[c] / from.scale[c] - 1.0);
        }
        if (_isWeights) return;
        const double length = glm::length(turn), angle = std::min(length, std::acos(-1.0));
        const double factor = length < 1e-12 ? 0.0 : std::sin(angle) / length;
        total.rotation = multiplied(total.rotation, glm::dvec4(turn * factor, std::cos(angle)));
        total.scale *= glm::dvec4(growth, 1.0);
    }

    const AnimationSet& _set;
    const PoseInstruction& _instruction;
    std::size_t _track;
    bool _isWeights;
};

} // namespace

BlendedPose blend(const AnimationSet& set, const PoseInstruction& instruction)
{
    BlendedPose pose;
    for (std::size_t track = 0; track < set.trackCount(); ++track)
    {
        TrackBlender blender(set, instruction, track);
        pose.tracks.push_back(blender.result());
        pose.closestDecision = std::min(pose.closestDecision, blender.closestDecision);
    }
    return pose;
}

std::vector<glm::dmat4> BlendedPose::palette(const AnimationSet& set) const
{
    std::vector<glm::dmat4> joints;
    for (std::size_t j = 0; j < set.skeleton().jointCount(); ++j)
    {
        const Track& track = tracks[j];
        const glm::dmat4 local = localMatrix(numbers(track.translation), numbers(track.rotation), numbers(track.scale));
        const int parent = set.skeleton().joint(j).parent;
        joints.push_back(parent < 0 ? local : joints[static_cast<std::size_t>(parent)] * local);
    }
    std::vector<glm::dmat4> entries;
    for (const PaletteEntry& entry : set.palette())
    {
        if (entry.kind != PaletteEntry::Kind::Weights)
        {
            entries.push_back(joints[static_cast<std::size_t>(entry.joint)] * entry.inverseBind.toColumns());
            continue;
        }
        const Track& block = tracks[static_cast<std::size_t>(entry.track)];
        glm::dmat4 rows(1.0);
        for (int column = 0; column < 4; ++column)
        {
            rows[column][0] = block.translation[column];
            rows[column][1] = block.rotation[column];
            rows[column][2] = block.scale[column];
        }
        entries.push_back(rows);
    }
    return entries;
}

} // namespace osgGpuAnimation::reference
