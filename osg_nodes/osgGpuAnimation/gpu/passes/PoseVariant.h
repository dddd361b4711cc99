// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/keyframes/PackedKeyframes.h>

#include <string>

namespace osgGpuAnimation
{

class PoseBatch;

/// What the programs of the mix stage are made for: each variant leaves out what its batch does not need, since some
/// drivers (llvmpipe) run both sides of every branch.
struct PoseVariant
{
    bool hasSplines = false;        ///< some clip of the set is a Spline clip
    bool hasSeveralSamples = false; ///< some instance has more than one blend sample, or one of less than full weight
    bool hasWeights = false;        ///< some of the entries are weight blocks
    bool isRootLevel = false;       ///< entries have no parents
    bool hasRoots = false;          ///< instances have root matrices
    bool hasLayers = false;         ///< some instance has samples of several blend priorities
    bool hasMasks = false;          ///< some sample has a mask
    bool hasAdditive = false;       ///< some sample is additive
    bool hasExactKeys = false;      ///< some clip moves some of the tracks, in full precision
    bool hasCompactKeys = false;    ///< some compact clip moves some of the tracks
    int sampleCount = 0; ///< blend samples of an instance, where they are attributes; 0: there are more, to be fetched
    PartMotion translationMotion = PartMotion::Constant; ///< of the tracks, the most that any does in any clip
    PartMotion scaleMotion = PartMotion::Constant;

    /// What the batch asks of the mix stage; of tracks that stay as they are.
    static PoseVariant of(const PoseBatch& batch);
    /// The most that any of the tracks does.
    void setMotion(const PackedKeyframes::Track& motion);

    bool operator<(const PoseVariant& other) const { return key() < other.key(); }

    /// GLSL: a constant for each member, of its name.
    std::string constants() const;

private:
    /// A number of its own for each variant.
    unsigned int key() const;
};

} // namespace osgGpuAnimation
