// SPDX-License-Identifier: MIT
#pragma once

#include "MotionBound.h"
#include "SweptBox.h"

#include <vector>

namespace osgGpuAnimation
{

/// Moves the boxes of the palette entries through a clip and gathers where they have been.
///
/// Each piece between two keyframes is looked at in as many steps as it takes for the entries' straying from straight
/// lines (see ChainMotion) to add no more than a hundredth to the box: one for most, since most straying happens well
/// inside the box that the clip fills anyway.
class ClipSweep
{
public:
    /// The set must outlive the sweep. entryBoxes as for boundsOfClip.
    ClipSweep(const AnimationSet& set, const EntryBoxes& entryBoxes);

    Box restPose();
    Box clip(const Clip& clip);

private:
    /// A palette entry's box as seen from its joint: a parallelepiped.
    struct Part
    {
        std::size_t joint = 0;
        glm::dvec3 centre{0.0};
        glm::dmat3 halfEdges{0.0};
        double radius = 0.0; ///< of the farthest corner from the joint's origin
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
    std::vector<bool> _isNeeded;        ///< by joint: whether a part hangs on it or below it
    std::vector<Placement> _placements; ///< by joint
    std::vector<ChainMotion> _motions;  ///< by joint
    std::vector<SweptBox> _boxes;       ///< by part: where it was at the last look
    std::vector<SweptBox> _boxesBefore; ///< by part: at the keyframe before
    SweptBox _seen;                     ///< all that was looked at
    SweptBox _swept;                    ///< all that, and what may lie between
};

} // namespace osgGpuAnimation
