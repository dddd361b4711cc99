// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/PackedKeyframes.h>
#include <osgGpuAnimation/animation/PartMotion.h>

#include <initializer_list>
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
    bool hasLayers = false;         ///< some instance has samples of several standings
    bool hasMasks = false;          ///< some sample has a mask
    bool hasAdditive = false;       ///< some sample is additive
    bool hasExactKeys = false;      ///< some clip moves some of the tracks, in full precision
    bool hasCompactKeys = false;    ///< some compact clip moves some of the tracks
    PartMotion translationMotion = PartMotion::Held; ///< of the tracks, the most that any does in any clip
    PartMotion scaleMotion = PartMotion::Held;

    /// What the batch asks of the mix stage; of tracks that stay as they are.
    static PoseVariant of(const PoseBatch& batch);
    /// The most that any of the tracks does.
    void setMotion(const PackedKeyframes::Track& motion);

    bool operator<(const PoseVariant& other) const { return key() < other.key(); }

    /// GLSL: a constant for each member, of its name.
    std::string constants() const
    {
        const auto line = [](const char* name, bool value)
        { return std::string("const bool ") + name + (value ? " = true;\n" : " = false;\n"); };
        const auto motion = [](const char* name, PartMotion value)
        { return std::string("const int ") + name + " = " + std::to_string(static_cast<int>(value)) + ";\n"; };
        return line("hasSplines", hasSplines) + line("hasSeveralSamples", hasSeveralSamples) +
               line("hasWeights", hasWeights) + line("isRootLevel", isRootLevel) + line("hasRoots", hasRoots) +
               line("hasLayers", hasLayers) + line("hasMasks", hasMasks) + line("hasAdditive", hasAdditive) +
               line("hasExactKeys", hasExactKeys) + line("hasCompactKeys", hasCompactKeys) +
               motion("translationMotion", translationMotion) + motion("scaleMotion", scaleMotion);
    }

private:
    /// A number of its own for each variant.
    unsigned int key() const
    {
        unsigned int key = 0;
        for (const bool has : {hasSplines, hasSeveralSamples, hasWeights, isRootLevel, hasRoots, hasLayers, hasMasks,
                               hasAdditive, hasExactKeys, hasCompactKeys})
            key = 2 * key + (has ? 1 : 0);
        return (4 * key + static_cast<unsigned int>(translationMotion)) * 4 + static_cast<unsigned int>(scaleMotion);
    }
};

} // namespace osgGpuAnimation
