// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/MotionBound.h>
#include <osgGpuAnimation/animation/SweptBox.h>

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <vector>

namespace osgGpuAnimation
{

/// Moves the boxes of the palette entries through a clip and collects the space that they cover.
///
/// Each piece between two keyframes is sampled so often that the deviation from straight lines (see ChainMotion) adds
/// at most a hundredth to the box. Most pieces need one step, since most deviations lie well inside the box of the
/// clip.
class ClipSweep
{
public:
    /// The set must outlive this object. entryBoxes: one box per palette entry.
    ClipSweep(const AnimationSet& set, const EntryBoxes& entryBoxes);

    Box restPose();
    Box clip(const Clip& clip);

private:
    /// A palette entry's box in joint space: a parallelepiped.
    struct Part
    {
        std::size_t joint = 0;
        glm::dvec3 centre{0.0};
        glm::dmat3 halfEdges{0.0};
        double radius = 0.0; ///< distance of the farthest corner from the joint's origin
    };
    struct Placement
    {
        glm::dmat3 linear{1.0};
        glm::dvec3 origin{0.0};
    };

    static Part partOf(const PaletteEntry& entry, const Box& box);
    void lookAt(const KeyframePair& keyframes);
    void boundMotion(const KeyframePair& keyframes);
    int stepsNeeded() const;
    void gatherStrayed(const std::vector<SweptBox>& boxes, int steps);
    void sweepPiece(KeyframePair keyframes);

    const AnimationSet& _set;
    std::vector<Part> _parts;
    std::vector<bool> _isNeeded;        ///< by joint: true if it or a descendant has a part
    std::vector<Placement> _placements; ///< by joint
    std::vector<ChainMotion> _motions;  ///< by joint
    std::vector<SweptBox> _boxes;       ///< by part, at the last sample
    std::vector<SweptBox> _boxesBefore; ///< by part, at the previous keyframe
    SweptBox _seen;                     ///< all samples
    SweptBox _swept;                    ///< all samples and the space between them
};

} // namespace osgGpuAnimation
