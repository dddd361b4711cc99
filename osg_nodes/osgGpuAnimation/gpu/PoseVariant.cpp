// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/gpu/PoseVariant.h>

#include <osgGpuAnimation/gpu/PoseBatch.h>

#include <algorithm>

namespace osgGpuAnimation
{

PoseVariant PoseVariant::of(const PoseBatch& batch)
{
    const std::vector<Clip>& clips = batch.set().clips();
    PoseVariant variant;
    variant.hasSplines =
        std::any_of(clips.begin(), clips.end(), [](const Clip& clip) { return clip.form() == Clip::Form::Spline; });
    variant.hasWeights = !batch.set().morphs().empty();
    variant.hasSeveralSamples = batch.needs().mixing;
    variant.hasLayers = batch.needs().layers;
    variant.hasMasks = batch.needs().masks;
    variant.hasAdditive = batch.needs().additive;
    return variant;
}

void PoseVariant::setMotion(const PackedKeyframes::Track& motion)
{
    translationMotion = motion.translation;
    scaleMotion = motion.scale;
    hasExactKeys = motion.hasExactKeys;
    hasCompactKeys = motion.hasCompactKeys;
}

} // namespace osgGpuAnimation
