// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/gpu/passes/PoseVariant.h>

#include <osgGpuAnimation/gpu/PoseBatch.h>

#include <layout.glsl>
#include <ShaderSources.h>

#include <algorithm>
#include <initializer_list>

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
    variant.hasPosed = batch.needs().posed;
    return variant;
}

void PoseVariant::setMotion(const PackedKeyframes::Track& motion)
{
    translationMotion = motion.translation;
    scaleMotion = motion.scale;
    hasExactKeys = motion.hasExactKeys;
    hasCompactKeys = motion.hasCompactKeys;
}

std::unique_ptr<FeedbackPass> PoseVariant::makePosePass(osg::GLExtensions& gl) const
{
    using namespace shaders;
    const std::string constants = this->constants();
    return std::unique_ptr<FeedbackPass>(new FeedbackPass(
        gl, "pose", {constants.c_str(), mix_glsl, local_glsl, world_glsl, pose_vert}, {"row0", "row1", "row2"}));
}

std::unique_ptr<FeedbackPass> PoseVariant::makeMixPass(osg::GLExtensions& gl) const
{
    using namespace shaders;
    const std::string constants = this->constants();
    return std::unique_ptr<FeedbackPass>(
        new FeedbackPass(gl, "mix", {constants.c_str(), mix_glsl, mix_vert}, {"translation", "rotation", "scale"}));
}

std::string PoseVariant::constants() const
{
    const auto line = [](const char* name, bool value)
    { return std::string("const bool ") + name + (value ? " = true;\n" : " = false;\n"); };
    const auto number = [](const char* name, int value)
    { return std::string("const int ") + name + " = " + std::to_string(value) + ";\n"; };
    return line("hasSplines", hasSplines) + line("hasSeveralSamples", hasSeveralSamples) +
           line("hasWeights", hasWeights) + line("isRootLevel", isRootLevel) + line("hasRoots", hasRoots) +
           line("hasLayers", hasLayers) + line("hasMasks", hasMasks) + line("hasAdditive", hasAdditive) +
           line("hasPosed", hasPosed) + line("hasExactKeys", hasExactKeys) + line("hasCompactKeys", hasCompactKeys) +
           number("sampleCount", sampleCount) + number("translationMotion", static_cast<int>(translationMotion)) +
           number("scaleMotion", static_cast<int>(scaleMotion));
}

unsigned int PoseVariant::key() const
{
    unsigned int key = 0;
    for (const bool has : {hasSplines, hasSeveralSamples, hasWeights, isRootLevel, hasRoots, hasLayers, hasMasks,
                           hasAdditive, hasPosed, hasExactKeys, hasCompactKeys})
        key = 2 * key + (has ? 1 : 0);
    key = key * (POSE_SAMPLES_AS_ATTRIBUTES + 1) + static_cast<unsigned int>(sampleCount);
    return (4 * key + static_cast<unsigned int>(translationMotion)) * 4 + static_cast<unsigned int>(scaleMotion);
}

} // namespace osgGpuAnimation
