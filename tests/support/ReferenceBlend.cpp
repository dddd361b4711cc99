// SPDX-License-Identifier: MIT
#include "support/ReferenceBlend.h"

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/Pose.h>

#include <layout.glsl>

namespace osgGpuAnimation::reference
{

namespace
{

Numbers numbers(const glm::vec4& v)
{
    return {v.x, v.y, v.z, v.w};
}

double dot(const Numbers& a, const Numbers& b)
{
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += a[i] * b[i];
    return sum;
}

Numbers scaled(Numbers v, double factor)
{
    for (double& c : v)
        c *= factor;
    return v;
}

Numbers plus(Numbers a, const Numbers& b)
{
    for (std::size_t i = 0; i < a.size(); ++i)
        a[i] += b[i];
    return a;
}

Numbers multiplied(const Numbers& a, const Numbers& b)
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
        Track total{numbers(rest.translation), numbers(rest.rotation), numbers(rest.scale)};
        std::size_t i = 0;
        while (i < _instruction.sampleCount && !isDifference(i))
        {
            std::size_t end = i + 1;
            while (end < _instruction.sampleCount && !isDifference(end) && !has(end, POSE_SAMPLE_ABOVE))
                ++end;
            total = over(total, i, end);
            i = end;
        }
        if (!_isWeights) total.rotation = normalized(total.rotation);
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
        return mask == 0 ? own : own * static_cast<double>(_set.masks().weights(mask)[_track]);
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
        Track cover{Numbers(4, 1.0), Numbers(4, 1.0), Numbers(4, 1.0)};
        if (!has(i, POSE_SAMPLE_POSED)) return cover;
        const std::uint32_t numbers = posed(i).numbers;
        for (std::size_t n = 0; n < 4; ++n)
        {
            cover.translation[n] = numbers >> n & 1u;
            cover.rotation[n] = numbers >> (n + 4) & 1u;
            cover.scale[n] = numbers >> (n + 8) & 1u;
        }
        return cover;
    }

    const JointTransform* keyframe(std::size_t clip, std::size_t place) const
    {
        return _set.clips()[clip].at(place, _track);
    }

    Numbers mixed(const JointTransform* a, const JointTransform* b, double t, bool isSpline,
                  glm::vec4 JointTransform::*part, bool isRotation)
    {
        const Numbers from = numbers(a->*part), to = numbers(b->*part);
        const bool isSlerped = isRotation && (!isSpline || a->translation.w == 1.0f);
        if (isSlerped)
        {
            const Numbers p = normalized(from), q = normalized(to);
            if (t > 0.0) closestDecision = std::min(closestDecision, std::abs(dot(p, q)));
            return slerp(p, q, t);
        }
        if (!isSpline) return plus(scaled(from, 1 - t), scaled(to, t));
        Numbers sum = plus(scaled(from, 2 * t * t * t - 3 * t * t + 1), scaled(to, 3 * t * t - 2 * t * t * t));
        sum = plus(sum, scaled(numbers(a[2].*part), t * t * t - 2 * t * t + t));
        sum = plus(sum, scaled(numbers(b[1].*part), t * t * t - t * t));
        return isRotation ? normalized(sum) : sum;
    }

    Track sampled(std::size_t i)
    {
        const BlendSample& sample = _instruction.samples[i];
        if (has(i, POSE_SAMPLE_POSED))
        {
            const JointTransform values = posed(i).values;
            return {numbers(values.translation), numbers(values.rotation), numbers(values.scale)};
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
            a = keyframe(clip, place);
            b = isLast ? a : keyframe(clip, place + 1);
            isSpline = content.form() == Clip::Form::Spline;
        }
        const double t = static_cast<double>(sample.alpha);
        Track track{mixed(a, b, t, isSpline, &JointTransform::translation, false),
                    mixed(a, b, t, isSpline, &JointTransform::rotation, !_isWeights),
                    mixed(a, b, t, isSpline, &JointTransform::scale, false)};
        return track;
    }

    void add(Track& sum, const Track& track, double factor)
    {
        sum.translation = plus(sum.translation, scaled(track.translation, factor));
        sum.rotation = plus(sum.rotation, scaled(track.rotation, factor));
        sum.scale = plus(sum.scale, scaled(track.scale, factor));
    }

    /// b, or -b if b is in the opposite hemisphere of a.
    Numbers onSide(const Numbers& a, const Numbers& b)
    {
        if (_isWeights) return b;
        const double along = dot(a, b);
        if (along != 0.0) closestDecision = std::min(closestDecision, std::abs(along) / std::sqrt(dot(a, a)));
        return along < 0.0 ? scaled(b, -1.0) : b;
    }

    /// The numbers of a part: `mixed` where the weights sum to 1, the rest from below.
    static Numbers filled(const Numbers& below, Numbers mixed, const Numbers& whole)
    {
        for (std::size_t n = 0; n < mixed.size(); ++n)
            mixed[n] = mixed[n] / std::max(whole[n], 1.0) + below[n] * (1.0 - std::min(whole[n], 1.0));
        return mixed;
    }

    Track over(const Track& below, std::size_t first, std::size_t end)
    {
        Track whole{Numbers(4), Numbers(4), Numbers(4)};
        Track mixed = whole;
        Numbers side;
        for (std::size_t i = first; i < end; ++i)
        {
            if (weight(i) == 0.0) continue;
            Track track = sampled(i);
            const Track has = cover(i);
            if (side.empty() && has.rotation[0] > 0.0) side = track.rotation;
            if (has.rotation[0] > 0.0) track.rotation = onSide(side, track.rotation);
            add(mixed, track, weight(i)); // a number that the sample has not is 0
            add(whole, has, weight(i));
        }
        if (whole.rotation[0] > 0.0 && whole.rotation[0] < 1.0) mixed.rotation = onSide(below.rotation, mixed.rotation);
        return {filled(below.translation, mixed.translation, whole.translation),
                filled(below.rotation, mixed.rotation, whole.rotation), filled(below.scale, mixed.scale, whole.scale)};
    }

    void addDifferences(Track& total, std::size_t first)
    {
        Numbers turn(3), growth(3, 1.0);
        for (std::size_t i = first; i + 1 < _instruction.sampleCount; i += 2)
        {
            const double share = weight(i + 1);
            if (share == 0.0) continue;
            Track from = sampled(i), to = sampled(i + 1);
            const Track has = cover(i + 1);
            for (Numbers Track::*part : {&Track::translation, &Track::rotation, &Track::scale})
                for (std::size_t n = 0; n < 4; ++n)
                    if ((has.*part)[n] == 0.0) (to.*part)[n] = (from.*part)[n];
            total.translation =
                plus(total.translation, scaled(plus(to.translation, scaled(from.translation, -1)), share));
            if (_isWeights)
            {
                total.rotation = plus(total.rotation, scaled(plus(to.rotation, scaled(from.rotation, -1)), share));
                total.scale = plus(total.scale, scaled(plus(to.scale, scaled(from.scale, -1)), share));
                continue;
            }
            const Numbers inverse{-from.rotation[0], -from.rotation[1], -from.rotation[2], from.rotation[3]};
            const Numbers d = onSide({0, 0, 0, 1}, multiplied(inverse, to.rotation));
            const double half = std::acos(std::min(d[3], 1.0));
            const double sine = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
            for (std::size_t c = 0; c < 3; ++c)
            {
                turn[c] += sine < 1e-9 ? share * d[c] : share * d[c] * half / sine;
                if (std::abs(from.scale[c]) > 1e-6) growth[c] *= 1.0 + share * (to.scale[c] / from.scale[c] - 1.0);
            }
        }
        if (_isWeights) return;
        const double pi = std::acos(-1.0);
        const double length = std::sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2]);
        const double angle = std::min(length, pi);
        const double factor = length < 1e-12 ? 0.0 : std::sin(angle) / length;
        total.rotation =
            multiplied(total.rotation, {turn[0] * factor, turn[1] * factor, turn[2] * factor, std::cos(angle)});
        for (std::size_t c = 0; c < 3; ++c)
            total.scale[c] *= growth[c];
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
        const glm::dmat4 local = localMatrix(tracks[j].translation, tracks[j].rotation, tracks[j].scale);
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
            rows[column][0] = block.translation[static_cast<std::size_t>(column)];
            rows[column][1] = block.rotation[static_cast<std::size_t>(column)];
            rows[column][2] = block.scale[static_cast<std::size_t>(column)];
        }
        entries.push_back(rows);
    }
    return entries;
}

} // namespace osgGpuAnimation::reference
