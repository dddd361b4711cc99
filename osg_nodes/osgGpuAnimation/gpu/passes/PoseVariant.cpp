// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/gpu/passes/PoseVariant.h>

#include <osgGpuAnimation/animation/constraints/ConstraintPlan.h>
#include <osgGpuAnimation/gpu/PoseBatch.h>

#include <layout.glsl>

#include <algorithm>

namespace osgGpuAnimation
{

namespace
{

std::string declaration(const char* name, bool value)
{
    return std::string("const bool ") + name + (value ? " = true;\n" : " = false;\n");
}

std::string declaration(const char* name, int value)
{
    return std::string("const int ") + name + " = " + std::to_string(value) + ";\n";
}

} // namespace

ConstraintShape::ConstraintShape(const ConstraintStep& step, const PoseBatch& batch)
{
    const ConstraintChain& chain = batch.set().constraintChains()[step.constraint];
    isLookAt = chain.isLookAt;
    chainLength = static_cast<int>(chain.joints.size());
    midPlace = static_cast<int>(chain.mid);
    aboveLength = static_cast<int>(step.chainBegin);
    hasSources = std::any_of(step.sources.begin(), step.sources.end(),
                             [](const CorrectionPlace& source) { return source.count > 0; });
    hasCone = chain.hasCone();
    hasOffset = chain.offset != glm::dvec3(0.0);
    hasDirections = (batch.needs().directedTargets >> step.constraint & 1) != 0;
    hasFractions = (batch.needs().partialTargets >> step.constraint & 1) != 0;
}

std::string ConstraintShape::constants() const
{
    return declaration("isLookAt", isLookAt) + declaration("chainLength", chainLength) +
           declaration("midPlace", midPlace) + declaration("aboveLength", aboveLength) +
           declaration("hasSources", hasSources) + declaration("hasCone", hasCone) +
           declaration("hasOffset", hasOffset) + declaration("hasDirections", hasDirections) +
           declaration("hasFractions", hasFractions);
}

PoseVariant PoseVariant::of(const PoseBatch& batch, bool isModest)
{
    const std::vector<Clip>& clips = batch.set().clips();
    PoseVariant variant;
    variant.hasSplines =
        std::any_of(clips.begin(), clips.end(), [](const Clip& clip) { return clip.form() == Clip::Form::Spline; });
    const std::vector<MorphWeights>& morphs = batch.set().morphs();
    variant.hasWeights =
        std::any_of(morphs.begin(), morphs.end(), [](const MorphWeights& morph) { return !morph.isProperty(); });
    variant.hasSeveralSamples = batch.needs().mixing;
    variant.hasLayers = batch.needs().layers;
    variant.hasMasks = batch.needs().masks;
    variant.hasAdditive = batch.needs().additive;
    variant.hasPosed = batch.needs().posed;
    variant.hasLimits = !isModest || variant.hasPosed || variant.hasAdditive;
    return variant;
}

void PoseVariant::setMotion(const PackedKeyframes::Track& motion)
{
    translationMotion = motion.translation;
    scaleMotion = motion.scale;
    hasExactKeys = motion.hasExactKeys;
    hasCompactKeys = motion.hasCompactKeys;
}

std::string PoseVariant::constants() const
{
    return declaration("hasSplines", hasSplines) + declaration("hasSeveralSamples", hasSeveralSamples) +
           declaration("hasWeights", hasWeights) + declaration("isRootLevel", isRootLevel) +
           declaration("hasRoots", hasRoots) + declaration("hasLayers", hasLayers) + declaration("hasMasks", hasMasks) +
           declaration("hasAdditive", hasAdditive) + declaration("hasPosed", hasPosed) +
           declaration("hasExactKeys", hasExactKeys) + declaration("hasCompactKeys", hasCompactKeys) +
           declaration("hasCorrections", hasCorrections) + declaration("hasLimits", hasLimits) +
           declaration("sampleCount", sampleCount) +
           declaration("translationMotion", static_cast<int>(translationMotion)) +
           declaration("scaleMotion", static_cast<int>(scaleMotion));
}

unsigned int PoseVariant::key() const
{
    unsigned int key = 0;
    for (const bool has : {hasSplines, hasSeveralSamples, hasWeights, isRootLevel, hasRoots, hasLayers, hasMasks,
                           hasAdditive, hasPosed, hasExactKeys, hasCompactKeys, hasCorrections, hasLimits})
        key = 2 * key + (has ? 1 : 0);
    key = key * (POSE_SAMPLES_AS_ATTRIBUTES + 1) + static_cast<unsigned int>(sampleCount);
    return (4 * key + static_cast<unsigned int>(translationMotion)) * 4 + static_cast<unsigned int>(scaleMotion);
}

} // namespace osgGpuAnimation
