// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/keyframes/PackedKeyframes.h>

#include <string>
#include <tuple>

namespace osgGpuAnimation
{

class PoseBatch;
struct ConstraintStep;

/// The features of a constraint, the lengths of its path and the features of its targets in a batch: the constants of
/// its program.
struct ConstraintShape
{
    ConstraintShape() = default;
    ConstraintShape(const ConstraintStep& step, const PoseBatch& batch);

    bool isLookAt = true;
    int chainLength = 1;
    int midPlace = 0;
    int aboveLength = 0;        ///< joints of the path above the chain
    bool hasSources = false;    ///< constraints before have turned joints of the path
    bool hasCone = false;       ///< of a look-at
    bool hasOffset = false;     ///< of a look-at
    bool hasDirections = false; ///< some target has a pole, a twist or a rotation
    bool hasFractions = false;  ///< some target has a weight below 1

    /// GLSL declarations: one constant per member, with the member's name.
    std::string constants() const;

    friend bool operator<(const ConstraintShape& left, const ConstraintShape& right)
    {
        const auto key = [](const ConstraintShape& shape)
        {
            return std::tie(shape.isLookAt, shape.chainLength, shape.midPlace, shape.aboveLength, shape.hasSources,
                            shape.hasCone, shape.hasOffset, shape.hasDirections, shape.hasFractions);
        };
        return key(left) < key(right);
    }
};

/// A permutation of the mix stage's programs. It omits the features that its batch does not need, since some drivers
/// (llvmpipe) execute both sides of every branch.
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
    bool hasPosed = false;          ///< some sample shows a posed keyframe
    bool hasExactKeys = false;      ///< some exact clip moves some of the tracks
    bool hasCompactKeys = false;    ///< some compact clip moves some of the tracks
    bool hasCorrections = false;    ///< constraints have corrected the rotations of all entries
    bool hasLimits = false;         ///< products are limited, see POSE_LARGEST_NUMBER
    int sampleCount = 0; ///< blend samples of an instance, if they are attributes; 0: the shader fetches them
    PartMotion translationMotion = PartMotion::Constant; ///< the largest of any track in any clip
    PartMotion scaleMotion = PartMotion::Constant;

    /// The features that the batch needs, for constant tracks. isModest: see hasModestPalette().
    static PoseVariant of(const PoseBatch& batch, bool isModest);
    /// Sets the motion of the tracks.
    void setMotion(const PackedKeyframes::Track& motion);

    bool operator<(const PoseVariant& other) const { return key() < other.key(); }

    /// GLSL declarations: one constant per member, with the member's name.
    std::string constants() const;

private:
    /// A unique number per variant.
    unsigned int key() const;
};

} // namespace osgGpuAnimation
