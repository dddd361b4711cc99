// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/Pose.h>

#include <osgGpuAnimation/animation/constraints/ConstraintSolver.h>
#include <osgGpuAnimation/animation/JointPose.h>
#include <osgGpuAnimation/animation/keyframes/PosedKeyframe.h>

#include <layout.glsl>

#include <algorithm>
#include <array>
#include <cassert>

namespace osgGpuAnimation::Pose
{

namespace
{

/// A blend sample with pointers to its two keyframes.
struct Source
{
    KeyframePair keyframes;
    const PosedKeyframe* posed = nullptr; ///< in place of the keyframes
    double weight = 0.0;
    std::shared_ptr<const SetMask> mask; ///< null: none
    std::uint32_t control = 0;
};

KeyframePair findKeyframes(const AnimationSet& set, const BlendSample& sample)
{
    KeyframePair pair;
    pair.first = pair.second = set.restPose().data();
    const std::size_t keyframe = sample.keyframe;
    const std::vector<Clip>& clips = set.clips();
    const auto firstKeyframe = [&](const Clip& clip)
    { return set.firstKeyframe(static_cast<std::size_t>(&clip - clips.data())); };
    const auto next = std::partition_point(clips.begin(), clips.end(),
                                           [&](const Clip& clip) { return firstKeyframe(clip) <= keyframe; });
    if (next == clips.begin()) return pair; // the rest pose comes before the first clip

    const Clip& data = *(next - 1);
    const std::size_t place = keyframe - firstKeyframe(data);
    assert(place < data.keyframeCount() && "a blend sample names a keyframe of a clip");
    if (place >= data.keyframeCount()) return pair;
    pair.first = pair.second = data.data().data() + place * data.keyframeStride();
    pair.alpha = static_cast<double>(sample.alpha);
    pair.spline = (sample.control & POSE_SAMPLE_SPLINE) != 0;
    // The last keyframe of a clip has no next keyframe.
    if (place + 1 < data.keyframeCount()) pair.second += data.keyframeStride();
    return pair;
}

/// The samples of an instruction; blends them track by track.
class Sources
{
public:
    Sources(const AnimationSet& set, const PoseInstruction& instruction)
        : Sources(set, instruction.samples.data(), instruction.sampleCount,
                  [&](const BlendSample& sample) -> const PosedKeyframe*
                  {
                      if (sample.keyframe >= instruction.poses.size()) return nullptr;
                      const JointPose* pose = instruction.poses[sample.keyframe].get();
                      const bool fits = pose && pose->keyframe().trackCount() == set.trackCount();
                      return fits ? &pose->keyframe() : nullptr;
                  })
    {
    }

    /// find: gives the keyframe of a posed sample, or null.
    template <typename FindPosed>
    Sources(const AnimationSet& set, const BlendSample* samples, std::size_t count, const FindPosed& find)
        : _set(set), _count(std::min(count, PoseInstruction::maxSamples))
    {
        for (std::size_t i = 0; i < _count; ++i)
        {
            const BlendSample& sample = samples[i];
            Source& source = _sources[i];
            source.control = sample.control;
            if (!(sample.weight > 0.0f)) continue;
            if ((sample.control & POSE_SAMPLE_POSED) != 0)
            {
                source.posed = find(sample);
                if (!source.posed) continue;
            }
            else
                source.keyframes = findKeyframes(set, sample);
            source.weight = static_cast<double>(sample.weight);
            source.mask = set.masks().find(sample.control >> POSE_SAMPLE_MASK_SHIFT);
        }
    }

    JointTransform track(std::size_t track) const
    {
        const bool isWeights = track >= _set.skeleton().jointCount();
        TrackBlend blend(_set.restPose()[track], isWeights);
        MixedTrack reference;
        for (std::size_t i = 0; i < _count; ++i)
        {
            const Source& source = _sources[i];
            if ((source.control & POSE_SAMPLE_ABOVE) != 0) blend.beginBlendPriority();
            const double weight =
                source.weight * (source.mask ? static_cast<double>(source.mask->weights[track]) : 1.0);
            if (!(weight > 0.0)) continue;
            MixedTrack cover = MixedTrack::everything();
            const MixedTrack sample = source.posed ? source.posed->sample(track, cover)
                                                   : MixedTrack::between(source.keyframes, track, isWeights);
            if ((source.control & POSE_SAMPLE_REFERENCE) != 0)
                reference = sample;
            else if ((source.control & POSE_SAMPLE_ADDITIVE) != 0)
                blend.addDifference(reference, sample, weight, cover);
            else
                blend.add(sample, weight, cover);
        }
        const MixedTrack mixed = blend.result();
        return {glm::vec4(mixed.translation), glm::vec4(mixed.rotation), glm::vec4(mixed.scale)};
    }

private:
    const AnimationSet& _set;
    std::array<Source, PoseInstruction::maxSamples> _sources;
    std::size_t _count;
};

/// The targets of all constraints, or none, and the space that they are in.
struct Targets
{
    explicit Targets(const PoseInstruction& instruction)
        : first(instruction.targets.data()), count(instruction.targets.size())
    {
    }
    Targets(const AnimationSet& set, const BatchedPose& pose, const AffineMatrix& rootToModel)
        : first(pose.targets), count(pose.targets ? set.constraints().size() : 0), rootToSpace(rootToModel.toColumns())
    {
    }

    const ConstraintTarget* first;
    std::size_t count;
    glm::dmat4 rootToSpace{1.0};
};

/// The joints of a pose, mixed on demand: a joint's matrix and the chains of constraints need few of them.
class MixedJoints
{
public:
    MixedJoints(const Sources& sources, const AnimationSet& set, const Targets& targets,
                std::vector<JointTransform>& joints, std::vector<bool>& isMixed)
        : _sources(sources), _skeleton(set.skeleton()), _joints(joints), _isMixed(isMixed)
    {
        const std::vector<ConstraintChain>& chains = set.constraintChains();
        for (std::size_t c = 0; c < std::min(chains.size(), targets.count); ++c)
            if (targets.first[c].weight > 0.0f) solve(chains[c], targets.first[c], targets.rootToSpace);
    }

    const JointTransform& operator[](int joint) const
    {
        const auto index = static_cast<std::size_t>(joint);
        if (!_isMixed[index]) _joints[index] = _sources.track(index);
        _isMixed[index] = true;
        return _joints[index];
    }

    glm::dmat4 toModel(int joint) const
    {
        glm::dmat4 matrix(1.0);
        for (; joint >= 0; joint = _skeleton.joint(joint).parent)
            matrix = limitedProduct((*this)[joint].toMatrix().toColumns(), matrix);
        return matrix;
    }

private:
    void solve(const ConstraintChain& chain, const ConstraintTarget& target, const glm::dmat4& rootToSpace)
    {
        thread_local std::vector<JointTransform> solved;
        solved.clear();
        for (const int joint : chain.joints)
            solved.push_back((*this)[joint]);
        const int parent = _skeleton.joint(chain.joints.front()).parent;
        solveConstraint(chain, target, limitedProduct(rootToSpace, toModel(parent)), solved);
        for (std::size_t place = 0; place < solved.size(); ++place)
            _joints[chain.joints[place]] = solved[place];
    }

    const Sources& _sources;
    const Skeleton& _skeleton;
    std::vector<JointTransform>& _joints;
    std::vector<bool>& _isMixed;
};

void mix(const AnimationSet& set, const Sources& sources, const Targets& targets,
         std::vector<JointTransform>& outTracks)
{
    outTracks.resize(set.trackCount());
    for (std::size_t track = 0; track < outTracks.size(); ++track)
        outTracks[track] = sources.track(track);
    if (targets.count == 0) return;
    std::vector<bool> isMixed(outTracks.size(), true);
    const MixedJoints constrained(sources, set, targets, outTracks, isMixed);
}

void evaluate(const AnimationSet& set, const Sources& sources, const Targets& targets, const AffineMatrix& rootToModel,
              std::vector<AffineMatrix>& outPalette)
{
    // Picking calls this often: each thread keeps the memory.
    thread_local std::vector<JointTransform> tracks;
    thread_local std::vector<AffineMatrix> joints;
    mix(set, sources, targets, tracks);
    jointToModel(set, tracks, rootToModel, joints);
    palette(set, tracks, joints, outPalette);
}

} // namespace

void mix(const AnimationSet& set, const PoseInstruction& instruction, std::vector<JointTransform>& outTracks)
{
    mix(set, Sources(set, instruction), Targets(instruction), outTracks);
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
        const AffineMatrix& above = parent < 0 ? rootToModel : outJointToModel[parent];
        outJointToModel[j] = above * tracks[j].toMatrix();
    }
}

AffineMatrix jointToModel(const AnimationSet& set, const PoseInstruction& instruction, std::size_t joint)
{
    const Skeleton& skeleton = set.skeleton();
    assert(joint < skeleton.jointCount() && "a joint of the set");
    const Sources sources(set, instruction);
    if (!instruction.targets.empty())
    {
        thread_local std::vector<JointTransform> joints;
        thread_local std::vector<bool> isMixed;
        joints.resize(skeleton.jointCount());
        isMixed.assign(skeleton.jointCount(), false);
        const MixedJoints mixed(sources, set, Targets(instruction), joints, isMixed);
        return AffineMatrix::fromColumns(mixed.toModel(static_cast<int>(joint)));
    }
    AffineMatrix matrix = sources.track(joint).toMatrix();
    for (int parent = skeleton.joint(joint).parent; parent >= 0; parent = skeleton.joint(parent).parent)
        matrix = sources.track(static_cast<std::size_t>(parent)).toMatrix() * matrix;
    return matrix;
}

void properties(const AnimationSet& set, const PoseInstruction& instruction, std::vector<float>& outNumbers)
{
    outNumbers.clear();
    const Sources sources(set, instruction);
    JointTransform block;
    for (std::size_t morph = 0; morph < set.morphs().size(); ++morph)
        for (std::size_t w = 0; set.morphs()[morph].isProperty() && w < set.morphs()[morph].defaults.size(); ++w)
        {
            const std::size_t number = w % MorphWeights::weightsPerBlock;
            if (number == 0) block = sources.track(set.firstTrackOfMorph(morph) + w / MorphWeights::weightsPerBlock);
            outNumbers.push_back(block.number(number));
        }
}

void palette(const AnimationSet& set, const std::vector<JointTransform>& tracks,
             const std::vector<AffineMatrix>& jointToModel, std::vector<AffineMatrix>& outPalette)
{
    const std::vector<PaletteEntry>& entries = set.palette();
    outPalette.resize(entries.size());
    for (std::size_t e = 0; e < entries.size(); ++e)
        if (entries[e].kind != PaletteEntry::Kind::Weights)
            outPalette[e] = jointToModel[entries[e].joint] * entries[e].inverseBind;
        else
        {
            const JointTransform& block = tracks[entries[e].track];
            outPalette[e].rows = {block.translation, block.rotation, block.scale};
        }
}

void evaluate(const AnimationSet& set, const PoseInstruction& instruction, const AffineMatrix& rootToModel,
              std::vector<AffineMatrix>& outPalette)
{
    evaluate(set, Sources(set, instruction), Targets(instruction), rootToModel, outPalette);
}

void evaluate(const AnimationSet& set, const BatchedPose& pose, const AffineMatrix& rootToModel,
              std::vector<AffineMatrix>& outPalette)
{
    const auto find = [&](const BlendSample& sample) { return pose.posed[sample.keyframe].get(); };
    evaluate(set, Sources(set, pose.samples, pose.sampleCount, find), Targets(set, pose, rootToModel), rootToModel,
             outPalette);
}

} // namespace osgGpuAnimation::Pose
