// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <tuple>

namespace osgGpuAnimation
{

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

    bool operator<(const PoseVariant& other) const { return key() < other.key(); }

    /// GLSL: a constant for each member, of its name.
    std::string constants() const
    {
        const auto line = [](const char* name, bool value)
        { return std::string("const bool ") + name + (value ? " = true;\n" : " = false;\n"); };
        return line("hasSplines", hasSplines) + line("hasSeveralSamples", hasSeveralSamples) +
               line("hasWeights", hasWeights) + line("isRootLevel", isRootLevel) + line("hasRoots", hasRoots) +
               line("hasLayers", hasLayers) + line("hasMasks", hasMasks) + line("hasAdditive", hasAdditive);
    }

private:
    std::tuple<bool, bool, bool, bool, bool, bool, bool, bool> key() const
    {
        return {hasSplines, hasSeveralSamples, hasWeights, isRootLevel, hasRoots, hasLayers, hasMasks, hasAdditive};
    }
};

} // namespace osgGpuAnimation
