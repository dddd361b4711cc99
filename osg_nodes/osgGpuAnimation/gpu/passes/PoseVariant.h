// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/keyframes/PackedKeyframes.h>
#include <osgGpuAnimation/gpu/FeedbackPass.h>

#include <memory>
#include <string>
#include <tuple>

namespace osgGpuAnimation
{

class PoseBatch;
struct ConstraintChain;
struct ConstraintStep;

/// The kind of a constraint and the lengths of its path, which are constants of its program.
struct ConstraintShape
{
    ConstraintShape(const ConstraintStep& step, const ConstraintChain& chain);

    bool isLookAt;
    int chainLength;
    int midPlace;
    int aboveLength; ///< joints of the path above the chain

    bool operator<(const ConstraintShape& other) const
    {
        return std::tie(isLookAt, chainLength, midPlace, aboveLength) <
               std::tie(other.isLookAt, other.chainLength, other.midPlace, other.aboveLength);
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
    bool hasConstraints = false;    ///< constraints correct the rotations of some entries
    int sampleCount = 0; ///< blend samples of an instance, if they are attributes; 0: the shader fetches them
    PartMotion translationMotion = PartMotion::Constant; ///< the largest of any track in any clip
    PartMotion scaleMotion = PartMotion::Constant;

    /// The features that the batch needs, for constant tracks.
    static PoseVariant of(const PoseBatch& batch);
    /// Sets the motion of the tracks.
    void setMotion(const PackedKeyframes::Track& motion);

    bool operator<(const PoseVariant& other) const { return key() < other.key(); }

    /// The pass of the fused form.
    std::unique_ptr<FeedbackPass> makePosePass(osg::GLExtensions& gl) const;
    /// The pass of one constraint in the fused form.
    std::unique_ptr<FeedbackPass> makeConstraintPass(osg::GLExtensions& gl, const ConstraintShape& shape) const;
    /// The first pass of the separate form.
    std::unique_ptr<FeedbackPass> makeMixPass(osg::GLExtensions& gl) const;

private:
    /// GLSL declarations: one constant per member, with the member's name.
    std::string constants() const;
    /// A unique number per variant.
    unsigned int key() const;
};

} // namespace osgGpuAnimation
