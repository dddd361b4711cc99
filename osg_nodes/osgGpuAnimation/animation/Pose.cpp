// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/Pose.h>

#include "TrackMix.h"
#include <osgGpuAnimation/animation/Rotation.h>

#include <layout.glsl>

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstring>

namespace osgGpuAnimation::Pose
{

namespace
{

/// A blend sample with its two keyframes found.
struct Source
{
    KeyframePair keyframes;
    double weight = 0.0; ///< share of the whole
};

Source findSource(const AnimationSet& set, const BlendSample& sample)
{
    Source source;
    source.keyframes.first = source.keyframes.second = set.restPose().data();
    const std::size_t offset = sample.keyframe;
    std::size_t clip = set.clips().size();
    for (std::size_t low = 0; low < clip;)
    {
        const std::size_t middle = low + (clip - low) / 2;
        if (set.keyframeOffset(middle) <= offset)
            low = middle + 1;
        else
            clip = middle;
    }
    if (clip == 0) return source; // before the first clip lies the rest pose

    const Clip& data = set.clips()[clip - 1];
    const std::size_t place = offset - set.keyframeOffset(clip - 1);
    assert(place + data.keyframeStride() <= data.data().size() && "a blend sample names a keyframe of a clip");
    if (place + data.keyframeStride() > data.data().size()) return source;
    source.keyframes.first = source.keyframes.second = data.data().data() + place;
    source.keyframes.alpha = static_cast<double>(sample.alpha);
    source.keyframes.spline = (sample.control & POSE_SAMPLE_SPLINE) != 0;
    // The last keyframe is never mixed with what follows it.
    if (place + 2 * data.keyframeStride() <= data.data().size()) source.keyframes.second += data.keyframeStride();
    return source;
}

/// The samples that count, and the rest pose for what their weights leave of 1.
std::size_t findSources(const AnimationSet& set, const PoseInstruction& instruction,
                        std::array<Source, PoseInstruction::maxSamples + 1>& out)
{
    std::size_t count = 0;
    double sum = 0.0;
    for (std::size_t i = 0; i < std::min(instruction.sampleCount, PoseInstruction::maxSamples); ++i)
    {
        const BlendSample& sample = instruction.samples[i];
        if (!(sample.weight > 0.0f)) continue;
        out[count] = findSource(set, sample);
        out[count].weight = static_cast<double>(sample.weight);
        sum += out[count++].weight;
    }
    if (sum < 1.0)
    {
        out[count] = findSource(set, BlendSample());
        out[count++].weight = 1.0 - sum;
    }
    for (std::size_t i = 0; sum > 1.0 && i < count; ++i)
        out[i].weight /= sum;
    return count;
}

MixedTrack mixTrack(const Source* sources, std::size_t count, std::size_t track, bool isWeights)
{
    MixedTrack sum;
    glm::dvec4 hemisphere(0.0);
    for (std::size_t i = 0; i < count; ++i)
    {
        const Source& source = sources[i];
        const MixedTrack one = MixedTrack::between(source.keyframes, track, isWeights);
        if (i == 0) hemisphere = one.rotation;
        const bool turned = !isWeights && glm::dot(hemisphere, one.rotation) < 0.0;
        sum.translation += one.translation * source.weight;
        sum.rotation += one.rotation * (turned ? -source.weight : source.weight);
        sum.scale += one.scale * source.weight;
    }
    if (isWeights) return sum;
    // Rotations on one hemisphere can only cancel out where each is square to the first; then that one stands.
    sum.rotation = glm::dot(sum.rotation, sum.rotation) > 1e-20 ? Rotation::unit(sum.rotation) : hemisphere;
    sum.translation.w = 0.0; // in a spline clip it held a flag
    sum.scale.w = 0.0;
    return sum;
}

AffineMatrix weightsAsMatrix(const JointTransform& block)
{
    AffineMatrix matrix;
    matrix.rows = {block.translation, block.rotation, block.scale};
    return matrix;
}

} // namespace

void mix(const AnimationSet& set, const PoseInstruction& instruction, std::vector<JointTransform>& outTracks)
{
    std::array<Source, PoseInstruction::maxSamples + 1> sources;
    const std::size_t count = findSources(set, instruction, sources);
    const std::size_t jointCount = set.skeleton().jointCount();
    outTracks.resize(set.trackCount());
    for (std::size_t track = 0; track < outTracks.size(); ++track)
    {
        const MixedTrack mixed = mixTrack(sources.data(), count, track, track >= jointCount);
        outTracks[track] = {glm::vec4(mixed.translation), glm::vec4(mixed.rotation), glm::vec4(mixed.scale)};
    }
}

void jointToModel(const AnimationSet& set, const std::vector<JointTransform>& tracks, const AffineMatrix& rootToModel,
                  std::vector<AffineMatrix>& outJointToModel)
{
    const Skeleton& skeleton = set.skeleton();
    assert(tracks.size() >= skeleton.jointCount() && "one transform a joint");
    outJointToModel.resize(skeleton.jointCount());
    for (std::size_t j = 0; j < outJointToModel.size(); ++j)
    {
        const int parent = skeleton.joint(j).parent;
        const AffineMatrix& above = parent < 0 ? rootToModel : outJointToModel[static_cast<std::size_t>(parent)];
        outJointToModel[j] = above * tracks[j].toMatrix();
    }
}

void palette(const AnimationSet& set, const std::vector<JointTransform>& tracks,
             const std::vector<AffineMatrix>& jointToModel, std::vector<AffineMatrix>& outPalette)
{
    const std::vector<PaletteEntry>& entries = set.palette();
    outPalette.resize(entries.size());
    for (std::size_t e = 0; e < entries.size(); ++e)
        outPalette[e] = entries[e].kind == PaletteEntry::Kind::Weights
                            ? weightsAsMatrix(tracks[static_cast<std::size_t>(entries[e].track)])
                            : jointToModel[static_cast<std::size_t>(entries[e].joint)] * entries[e].inverseBind;
}

void evaluate(const AnimationSet& set, const PoseInstruction& instruction, const AffineMatrix& rootToModel,
              std::vector<AffineMatrix>& outPalette)
{
    // Picking asks again and again: the room in between is kept, once a thread.
    thread_local std::vector<JointTransform> tracks;
    thread_local std::vector<AffineMatrix> joints;
    mix(set, instruction, tracks);
    jointToModel(set, tracks, rootToModel, joints);
    palette(set, tracks, joints, outPalette);
}

} // namespace osgGpuAnimation::Pose
