// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/bounds/ClipBounds.h>

#include <osgGpuAnimation/animation/keyframes/TrackBlend.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/math/Rotation.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

namespace osgGpuAnimation
{

namespace
{

constexpr auto length = [](const glm::dvec4& v) { return glm::length(v); };
constexpr auto lengthOf3 = [](const glm::dvec4& v) { return glm::length(glm::dvec3(v)); };
constexpr auto maxOf3 = [](const glm::dvec4& v) { return maxComponent(glm::dvec3(v)); };

/// Upper bounds for a joint between two keyframes: the norms of its translation, scale and rotation matrix and of their
/// first two derivatives over the interval [0, 1].
struct TrackMotion
{
    double shift = 0.0, shift1 = 0.0, shift2 = 0.0; ///< translation
    double size = 0.0, size1 = 0.0, size2 = 0.0;    ///< scale: of the largest component
    double turn1 = 0.0, turn2 = 0.0;                ///< rotation matrix; infinite if a spline may pass through 0
};

/// A Hermite piece as a Bézier curve. The convex hull of its points contains the curve; the same is true of its
/// derivatives.
struct Cubic
{
    std::array<glm::dvec4, 4> points;

    Cubic(const JointTransform* a, const JointTransform* b, glm::vec4 JointTransform::*part)
    {
        const glm::dvec4 v0(a[0].*part);
        const glm::dvec4 v1(b[0].*part);
        points = {v0, v0 + glm::dvec4(a[2].*part) / 3.0, v1 - glm::dvec4(b[1].*part) / 3.0, v1};
    }

    template <typename Norm>
    double value(Norm norm) const
    {
        return std::max({norm(points[0]), norm(points[1]), norm(points[2]), norm(points[3])});
    }
    template <typename Norm>
    double first(Norm norm) const
    {
        return 3.0 * std::max({norm(points[1] - points[0]), norm(points[2] - points[1]), norm(points[3] - points[2])});
    }
    template <typename Norm>
    double second(Norm norm) const
    {
        return 6.0 *
               std::max(norm(points[2] - 2.0 * points[1] + points[0]), norm(points[3] - 2.0 * points[2] + points[1]));
    }
};

void boundSlerp(const glm::vec4& a, const glm::vec4& b, TrackMotion& out)
{
    if (a == b) return;
    const glm::dvec4 from = Rotation::unit(glm::dvec4(a));
    const glm::dvec4 to = Rotation::unit(glm::dvec4(b));
    // asin(x) <= x + 0.2215 x^3 up to x = sin 45 degrees: half the chord gives half the arc, a quarter of the turn.
    const double halfChord = 0.5 * std::min(length(to - from), length(to + from));
    out.turn1 = 4.0 * halfChord * (1.0 + 0.2215 * halfChord * halfChord);
    out.turn2 = out.turn1 * out.turn1;
}

/// The rotation of q / |q|: |R'| <= 2 |q'| / |q| =: w, |R''| <= w^2 + 2 |q''| / |q| + w^2 / 2.
void boundNormalized(const Cubic& q, TrackMotion& out)
{
    const glm::dvec4 middle = Rotation::unit(q.points[0] + q.points[1] + q.points[2] + q.points[3]);
    double min = std::numeric_limits<double>::max();
    for (const glm::dvec4& point : q.points)
        min = std::min(min, glm::dot(middle, point));
    if (!(min > 1e-3 * q.value(length)))
    {
        out.turn1 = out.turn2 = std::numeric_limits<double>::infinity();
        return;
    }
    out.turn1 = 2.0 * q.first(length) / min;
    out.turn2 = 1.5 * out.turn1 * out.turn1 + 2.0 * q.second(length) / min;
}

TrackMotion boundLinear(const JointTransform& a, const JointTransform& b)
{
    const glm::dvec3 t0(a.translation), t1(b.translation), s0(a.scale), s1(b.scale);
    TrackMotion motion;
    motion.shift = std::max(glm::length(t0), glm::length(t1));
    motion.shift1 = glm::length(t1 - t0);
    motion.size = std::max(maxComponent(s0), maxComponent(s1));
    motion.size1 = maxComponent(s1 - s0);
    boundSlerp(a.rotation, b.rotation, motion);
    return motion;
}

TrackMotion boundSpline(const JointTransform* a, const JointTransform* b)
{
    const Cubic translation(a, b, &JointTransform::translation);
    const Cubic scale(a, b, &JointTransform::scale);
    TrackMotion motion;
    motion.shift = translation.value(lengthOf3);
    motion.shift1 = translation.first(lengthOf3);
    motion.shift2 = translation.second(lengthOf3);
    motion.size = scale.value(maxOf3);
    motion.size1 = scale.first(maxOf3);
    motion.size2 = scale.second(maxOf3);
    if (a[0].translation.w == 1.0f)
        boundSlerp(a[0].rotation, b[0].rotation, motion);
    else
        boundNormalized(Cubic(a, b, &JointTransform::rotation), motion);
    return motion;
}

/// The distance of the farthest corner from the origin.
double radiusOf(const TransformedBox& box)
{
    double radius = 0.0;
    for (int corner = 0; corner < 8; ++corner)
    {
        const glm::dvec3 signs((corner & 1) ? 1.0 : -1.0, (corner & 2) ? 1.0 : -1.0, (corner & 4) ? 1.0 : -1.0);
        radius = std::max(radius, glm::length(box.centre + box.halfEdges * signs));
    }
    return radius;
}

/// Upper bounds for a joint's transform to model space, v -> A v + c, from root to leaf by the product rule.
struct ChainMotion
{
    double linear = 1.0, linear1 = 0.0, linear2 = 0.0; ///< A's operator norm and those of its derivatives
    double origin = 0.0, origin2 = 0.0;                ///< |c| and |c''|

    ChainMotion child(const TrackMotion& motion) const
    {
        const double turned = motion.size; // |R S| and its derivatives
        const double turned1 = motion.turn1 * motion.size + motion.size1;
        const double turned2 = motion.turn2 * motion.size + 2.0 * motion.turn1 * motion.size1 + motion.size2;
        ChainMotion result;
        result.linear = linear * turned;
        result.linear1 = linear1 * turned + linear * turned1;
        result.linear2 = linear2 * turned + 2.0 * linear1 * turned1 + linear * turned2;
        result.origin = origin + linear * motion.shift;
        result.origin2 = origin2 + linear2 * motion.shift + 2.0 * linear1 * motion.shift1 + linear * motion.shift2;
        return result;
    }

    /// The largest distance from the root of a point within radius of the joint's origin.
    double reach(double radius) const { return origin + linear * radius; }
    /// The largest deviation of such a point from the straight line between its two ends: |p''| / 8.
    double maxDeviation(double radius) const { return (origin2 + linear2 * radius) / 8.0; }
};

/// Moves the boxes of the palette entries through a clip and collects the space that they cover.
///
/// The sampling rate of each piece between two keyframes is chosen so that the deviation from straight lines (see
/// ChainMotion) adds at most a hundredth to the box, with at most 16 steps. Most pieces need one step, since most
/// deviations are well inside the box of the clip.
class ClipSweep
{
public:
    /// The set must outlive this object. entryBoxes: one box per palette entry.
    ClipSweep(const AnimationSet& set, const EntryBoxes& entryBoxes)
        : _set(set), _isNeeded(set.skeleton().jointCount(), false), _jointsToModel(set.skeleton().jointCount()),
          _motions(set.skeleton().jointCount())
    {
        const std::size_t count = std::min(entryBoxes.size(), set.paletteSize());
        for (std::size_t e = 0; e < count; ++e)
        {
            const PaletteEntry& entry = set.palette()[e];
            if (entry.joint < 0 || entryBoxes[e].empty()) continue;
            const TransformedBox box(entry.inverseBind, entryBoxes[e]);
            _parts.push_back({static_cast<std::size_t>(entry.joint), box, radiusOf(box)});
            _isNeeded[_parts.back().joint] = true;
        }
        for (std::size_t j = _isNeeded.size(); j-- > 0;)
            if (_isNeeded[j] && set.skeleton().joint(j).parent >= 0) _isNeeded[set.skeleton().joint(j).parent] = true;
        _boxes.resize(_parts.size());
    }

    Box restPose()
    {
        _seen = Aabb3d();
        const JointTransform* rest = _set.restPose().data();
        sample({rest, rest, 0.0, false});
        return _seen.toBox();
    }

    Box clip(const Clip& clip)
    {
        _seen = _swept = Aabb3d();
        const bool spline = clip.form() == Clip::Form::Spline;
        for (std::size_t k = 0; k < clip.keyframeCount(); ++k)
        {
            const JointTransform* keyframe = clip.data().data() + k * clip.keyframeStride();
            _boxesBefore = _boxes;
            sample({keyframe, keyframe, 0.0, spline});
            if (k > 0 && clip.times()[k - 1] < clip.times()[k])
                sweepPiece({keyframe - clip.keyframeStride(), keyframe, 0.0, spline});
        }
        _swept.add(_seen);
        return _swept.toBox();
    }

private:
    struct Part
    {
        std::size_t joint;
        TransformedBox box; ///< of a palette entry, in joint space
        double radius;      ///< distance of the farthest corner from the joint's origin
    };
    /// v -> linear · v + origin
    struct JointToModel
    {
        glm::dmat3 linear{1.0};
        glm::dvec3 origin{0.0};
    };

    void sample(const KeyframePair& keyframes)
    {
        const JointToModel model;
        for (std::size_t j = 0; j < _jointsToModel.size(); ++j)
        {
            if (!_isNeeded[j]) continue;
            const MixedTrack local = MixedTrack::between(keyframes, j, false);
            glm::dmat3 linear = Rotation::matrix(local.rotation);
            for (int axis = 0; axis < 3; ++axis)
                linear[axis] *= local.scale[axis];
            const int parent = _set.skeleton().joint(j).parent;
            const JointToModel& above = parent < 0 ? model : _jointsToModel[parent];
            _jointsToModel[j] = {above.linear * linear, above.linear * glm::dvec3(local.translation) + above.origin};
        }
        for (std::size_t p = 0; p < _parts.size(); ++p)
        {
            const JointToModel& jointToModel = _jointsToModel[_parts[p].joint];
            _boxes[p] = _parts[p].box.bounds(jointToModel.linear, jointToModel.origin);
            _seen.add(_boxes[p]);
        }
    }

    /// Ignores the alpha of the keyframes.
    void boundMotion(const KeyframePair& keyframes)
    {
        for (std::size_t j = 0; j < _motions.size(); ++j)
        {
            if (!_isNeeded[j]) continue;
            const int parent = _set.skeleton().joint(j).parent;
            const ChainMotion above = parent < 0 ? ChainMotion() : _motions[parent];
            _motions[j] = above.child(keyframes.spline ? boundSpline(keyframes.first + 3 * j, keyframes.second + 3 * j)
                                                       : boundLinear(keyframes.first[j], keyframes.second[j]));
        }
    }

    int stepsNeeded() const
    {
        constexpr double maxSteps = 16.0;
        const double allowed = 0.01 * _seen.diagonal();
        double steps = 1.0;
        for (std::size_t p = 0; p < _parts.size(); ++p)
        {
            const double maxDeviation = _motions[_parts[p].joint].maxDeviation(_parts[p].radius);
            if (!(maxDeviation > allowed) || !std::isfinite(maxDeviation)) continue;
            Aabb3d both = _boxes[p];
            both.add(_boxesBefore[p]);
            steps = std::max(steps, std::ceil(std::sqrt(maxDeviation / (allowed + _seen.slackAround(both)))));
        }
        return static_cast<int>(std::min(steps, maxSteps));
    }

    void addGrown(const std::vector<Aabb3d>& boxes, int steps)
    {
        for (std::size_t p = 0; p < boxes.size(); ++p)
        {
            const ChainMotion& motion = _motions[_parts[p].joint];
            const double maxDeviation = motion.maxDeviation(_parts[p].radius) / (static_cast<double>(steps) * steps);
            _swept.add(boxes[p].grownWithin(maxDeviation, motion.reach(_parts[p].radius)));
        }
    }

    void sweepPiece(KeyframePair keyframes)
    {
        boundMotion(keyframes);
        const int steps = stepsNeeded();
        addGrown(_boxesBefore, steps);
        addGrown(_boxes, steps);
        if (steps == 1) return;

        const std::vector<Aabb3d> boxesAfter = _boxes;
        for (int step = 1; step < steps; ++step)
        {
            keyframes.alpha = static_cast<double>(step) / steps;
            sample(keyframes);
            addGrown(_boxes, steps);
        }
        _boxes = boxesAfter;
    }

    const AnimationSet& _set;
    std::vector<Part> _parts;
    std::vector<bool> _isNeeded;              ///< by joint: true if it or a descendant has a part
    std::vector<JointToModel> _jointsToModel; ///< by joint, at the last sample
    std::vector<ChainMotion> _motions;        ///< by joint
    std::vector<Aabb3d> _boxes;               ///< by part, at the last sample
    std::vector<Aabb3d> _boxesBefore;         ///< by part, at the previous keyframe
    Aabb3d _seen;                             ///< all samples
    Aabb3d _swept;                            ///< all samples and the space between them
};

} // namespace

Box boundsOfClip(const AnimationSet& set, int clip, const EntryBoxes& entryBoxes)
{
    assert(entryBoxes.size() == set.paletteSize() && "a box a palette entry");
    ClipSweep sweep(set, entryBoxes);
    if (clip < 0 || static_cast<std::size_t>(clip) >= set.clips().size()) return sweep.restPose();
    return sweep.clip(set.clips()[clip]);
}

std::vector<Box> boundsOfClips(const AnimationSet& set, const EntryBoxes& entryBoxes)
{
    std::vector<Box> bounds;
    for (int clip = -1; clip < static_cast<int>(set.clips().size()); ++clip)
        bounds.push_back(boundsOfClip(set, clip, entryBoxes));
    return bounds;
}

Box boundsOfJoints(const AnimationSet& set)
{
    std::vector<AffineMatrix> joints;
    Pose::jointToModel(set, set.restPose(), AffineMatrix(), joints);
    Box box;
    for (const AffineMatrix& joint : joints)
    {
        const glm::vec3 origin = joint.transformPoint(glm::vec3(0.0f));
        // Products are limited to the same number.
        if (glm::all(glm::lessThan(glm::abs(origin), glm::vec3(static_cast<float>(Aabb3d::limit))))) box.add(origin);
    }
    return box;
}

} // namespace osgGpuAnimation
