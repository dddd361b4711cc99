// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/keyframes/TrackBlend.h>
#include <osgGpuAnimation/math/Box.h>

#include <vector>

namespace osgGpuAnimation
{

/// Upper bounds for a joint between two keyframes: the norms of its translation, scale and rotation matrix and of their
/// first two derivatives over the interval [0, 1].
struct TrackMotion
{
    double shift = 0.0, shift1 = 0.0, shift2 = 0.0; ///< translation
    double size = 0.0, size1 = 0.0, size2 = 0.0;    ///< scale: of the largest component
    double turn1 = 0.0, turn2 = 0.0;                ///< rotation matrix; infinite if a spline may pass through 0

    /// Ignores the alpha of the keyframes.
    static TrackMotion between(const KeyframePair& keyframes, std::size_t track);
};

/// Upper bounds for a joint's transform to model space, v -> A v + c, from root to leaf by the product rule.
struct ChainMotion
{
    double linear = 1.0, linear1 = 0.0, linear2 = 0.0; ///< A's operator norm and those of its derivatives
    double origin = 0.0, origin2 = 0.0;                ///< |c| and |c''|

    ChainMotion child(const TrackMotion& motion) const;

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
    ClipSweep(const AnimationSet& set, const EntryBoxes& entryBoxes);

    Box restPose();
    Box clip(const Clip& clip);

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

    void sample(const KeyframePair& keyframes);
    void boundMotion(const KeyframePair& keyframes);
    int stepsNeeded() const;
    void addGrown(const std::vector<Aabb3d>& boxes, int steps);
    void sweepPiece(KeyframePair keyframes);

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

/// A box, in model space, that contains every vertex at every time of the clip. The box is conservative: a vertex is a
/// convex combination of its positions under each of its palette entries, and between the sampled times the box grows
/// by a bound on the deviation from a straight line. The box is tight: the sampling rate follows the rotation of the
/// joints. clip: a clip of the set; any other number gives the rest pose. entryBoxes: one box per palette entry.
Box boundsOfClip(const AnimationSet& set, int clip, const EntryBoxes& entryBoxes);

/// The box of the rest pose, then the boxes of all clips: the box of clip c is at index c + 1.
std::vector<Box> boundsOfClips(const AnimationSet& set, const EntryBoxes& entryBoxes);

/// The box of the origins of all joints in the rest pose. Ignores origins beyond Aabb3d::limit.
Box boundsOfJoints(const AnimationSet& set);

} // namespace osgGpuAnimation
