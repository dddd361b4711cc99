// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/AnimationSet.h>

#include <osgGpuAnimation/animation/constraints/ConstraintChain.h>
#include <osgGpuAnimation/animation/palette/PaletteBuilder.h>

#include <layout.glsl>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgGpuAnimation
{

namespace
{

template <typename T>
std::string describe(const char* kind, std::size_t index, const T& named)
{
    return std::string(kind) + " " + std::to_string(index) + " \"" + named.name + "\": ";
}

std::optional<Error> findFaultInSkin(const Skin& skin, const std::string& subject, std::size_t jointCount)
{
    if (skin.joints.size() > skin.inverseBinds.size())
        return Error{subject + std::to_string(skin.joints.size()) + " joints but " +
                     std::to_string(skin.inverseBinds.size()) + " inverse bind matrices"};
    for (std::size_t place = 0; place < skin.joints.size(); ++place)
    {
        const int joint = skin.joints[place];
        if (joint < 0 || static_cast<std::size_t>(joint) >= jointCount)
            return Error{subject + "its joint " + std::to_string(place) + " is " + std::to_string(joint) +
                         ", but there are " + std::to_string(jointCount)};
        if (!skin.inverseBinds[place].isFinite())
            return Error{subject + "its inverse bind matrix " + std::to_string(place) + " is not finite"};
    }
    return std::nullopt;
}

std::optional<Error> findFault(const AnimationParts& parts, std::size_t trackCount)
{
    const std::size_t jointCount = parts.skeleton.jointCount();
    for (std::size_t g = 0; g < parts.garments.size(); ++g)
        if (auto fault = findFaultInSkin(parts.garments[g], describe("garment", g, parts.garments[g]), jointCount))
            return fault;
    for (std::size_t s = 0; s < parts.skins.size(); ++s)
        if (auto fault = findFaultInSkin(parts.skins[s], describe("skin", s, parts.skins[s]), jointCount)) return fault;
    for (int joint : parts.rigidJoints)
        if (joint < 0 || static_cast<std::size_t>(joint) >= jointCount)
            return Error{"rigid joint " + std::to_string(joint) + " is not one of " + std::to_string(jointCount)};
    for (std::size_t m = 0; m < parts.morphs.size(); ++m)
        for (float weight : parts.morphs[m].defaults)
            if (!std::isfinite(weight))
                return Error{describe("morph", m, parts.morphs[m]) + "a default weight is not finite"};
    for (std::size_t c = 0; c < parts.clips.size(); ++c)
        if (parts.clips[c].trackCount() != trackCount)
            return Error{"clip " + std::to_string(c) + " \"" + parts.clips[c].name() +
                         "\": " + std::to_string(parts.clips[c].trackCount()) + " tracks, but the set has " +
                         std::to_string(trackCount)};
    return std::nullopt;
}

/// Addresses on the GPU have 31 bits and count texels, at most eight per transform or track (see PackedKeyframes);
/// larger records of compact clips from a file are refused by the limit of buffer textures.
std::optional<Error> findFaultInSize(const std::vector<Clip>& clips)
{
    constexpr std::size_t max = (std::size_t(1) << 31) / 16;
    std::size_t transforms = 0;
    for (const Clip& clip : clips)
        transforms += clip.data().size() + clip.trackCount() + clip.keyframeCount();
    if (transforms <= max) return std::nullopt;
    return Error{"its clips take " + std::to_string(transforms) + " joint transforms, more than the " +
                 std::to_string(max) + " that addresses on the GPU reach"};
}

Result<std::vector<ConstraintChain>> chainsOf(const AnimationParts& parts)
{
    if (parts.constraints.size() > AnimationSet::maxConstraints)
        return Error{std::to_string(parts.constraints.size()) + " constraints, at most " +
                     std::to_string(AnimationSet::maxConstraints)};
    std::vector<ConstraintChain> chains;
    for (const Constraint& constraint : parts.constraints)
    {
        Result<ConstraintChain> chain = ConstraintChain::create(parts.skeleton, constraint);
        if (!chain) return chain.error();
        for (const ConstraintChain& other : chains)
            if (other.name == chain.value().name) return Error{"two constraints are named \"" + other.name + "\""};
        chains.push_back(std::move(chain).value());
    }
    return chains;
}

} // namespace

/// The sets that differ in their garments alone.
struct AnimationSet::Family
{
    std::mutex mutex;
    std::vector<std::weak_ptr<const AnimationSet>> sets;
};

AnimationSet::AnimationSet(AnimationParts parts, std::shared_ptr<MaskTable> masks, std::shared_ptr<Family> family,
                           std::shared_ptr<const std::vector<ConstraintChain>> constraintChains)
    : _parts(std::move(parts)), _constraintChains(std::move(constraintChains)), _masks(std::move(masks)),
      _family(std::move(family))
{
    _restPose = osgGpuAnimation::restPose(_parts.skeleton, _parts.morphs);
    _firstTracksOfMorphs = firstTracksOfMorphs(_parts.skeleton, _parts.morphs);
    _layout = layOutPalette(_parts);
    for (const Clip& clip : _parts.clips)
    {
        _firstKeyframes.push_back(_keyframeCount);
        _keyframeCount += clip.keyframeCount();
    }
}

Result<std::shared_ptr<const AnimationSet>> AnimationSet::create(AnimationParts parts)
{
    return make(std::move(parts), std::make_shared<MaskTable>());
}

std::shared_ptr<const AnimationSet> AnimationSet::orEmpty(std::shared_ptr<const AnimationSet> set)
{
    static const std::shared_ptr<const AnimationSet> empty =
        create({Skeleton::create({}).value(), {}, {}, {}, {}}).value();
    return set ? std::move(set) : empty;
}

Result<std::shared_ptr<const AnimationSet>> AnimationSet::withClips(std::vector<Clip> clips) const
{
    AnimationParts parts = _parts;
    parts.clips = std::move(clips);
    return make(std::move(parts), _masks);
}

Result<std::shared_ptr<const AnimationSet>> AnimationSet::withConstraints(std::vector<Constraint> constraints) const
{
    AnimationParts parts = _parts;
    parts.constraints = std::move(constraints);
    return make(std::move(parts), _masks);
}

Result<std::shared_ptr<const AnimationSet>> AnimationSet::withGarments(std::vector<Skin> garments) const
{
    const auto isSame = [](const Skin& a, const Skin& b)
    { return a.joints == b.joints && a.inverseBinds == b.inverseBinds; };
    const std::lock_guard<std::mutex> lock(_family->mutex);
    for (auto known = _family->sets.begin(); known != _family->sets.end();)
    {
        std::shared_ptr<const AnimationSet> set = known->lock();
        if (set && std::equal(garments.begin(), garments.end(), set->garments().begin(), set->garments().end(), isSame))
            return set;
        known = set ? std::next(known) : _family->sets.erase(known);
    }
    AnimationParts parts = _parts;
    parts.garments = std::move(garments);
    Result<std::shared_ptr<const AnimationSet>> made = make(std::move(parts), _masks, _family);
    if (!made) return made;
    const std::lock_guard<std::mutex> lockSpeeds(_groundSpeedMutex);
    made.value()->_groundSpeeds = _groundSpeeds;
    return made;
}

/// Adds the set to the family. The caller has locked a family that others know.
Result<std::shared_ptr<const AnimationSet>> AnimationSet::make(AnimationParts parts, std::shared_ptr<MaskTable> masks,
                                                               std::shared_ptr<Family> family)
{
    const std::size_t trackCount = firstTracksOfMorphs(parts.skeleton, parts.morphs).back();
    if (auto fault = findFault(parts, trackCount)) return *fault;
    if (auto fault = findFaultInSize(parts.clips)) return *fault;
    Result<std::vector<ConstraintChain>> chains = chainsOf(parts);
    if (!chains) return chains.error();
    if (!family) family = std::make_shared<Family>();
    const std::shared_ptr<const AnimationSet> set(
        new AnimationSet(std::move(parts), std::move(masks), family,
                         std::make_shared<const std::vector<ConstraintChain>>(std::move(chains).value())));
    family->sets.push_back(set);
    return set;
}

int AnimationSet::entryOfRigidJoint(int joint) const
{
    if (joint < 0 || static_cast<std::size_t>(joint) >= _layout.entryOfRigidJoint.size()) return -1;
    return _layout.entryOfRigidJoint[joint];
}

int AnimationSet::findClip(const std::string& name) const
{
    for (std::size_t c = 0; c < _parts.clips.size(); ++c)
        if (_parts.clips[c].name() == name) return static_cast<int>(c);
    return -1;
}

Result<std::size_t> AnimationSet::constraintNamed(const std::string& name) const
{
    return indexNamed("constraint", name, *_constraintChains);
}

Result<std::size_t> AnimationSet::clipNamed(const std::string& name) const
{
    return indexNamed("clip", name, _parts.clips);
}

Result<std::size_t> AnimationSet::clipAt(std::size_t clip) const
{
    if (clip >= _parts.clips.size())
        return Error{"there is no clip " + std::to_string(clip) + "; the clips are " + quotedNames(_parts.clips)};
    return clip;
}

BlendSample AnimationSet::sampleAt(int clip, double time) const
{
    if (clip < 0) return {};
    const auto index = static_cast<std::size_t>(clip);
    const Clip& played = _parts.clips[index];
    const Clip::Span span = played.locate(time);
    return {static_cast<std::uint32_t>(_firstKeyframes[index] + span.keyframe), span.alpha, 1.0f,
            played.form() == Clip::Form::Spline ? POSE_SAMPLE_SPLINE : 0u};
}

std::optional<double> AnimationSet::knownGroundSpeed(std::size_t clip) const
{
    const std::lock_guard<std::mutex> lock(_groundSpeedMutex);
    if (clip >= _groundSpeeds.size() || std::isnan(_groundSpeeds[clip])) return std::nullopt;
    return _groundSpeeds[clip];
}

void AnimationSet::keepGroundSpeed(std::size_t clip, double speed) const
{
    const std::lock_guard<std::mutex> lock(_groundSpeedMutex);
    _groundSpeeds.resize(_parts.clips.size(), std::numeric_limits<double>::quiet_NaN());
    _groundSpeeds[clip] = speed;
}

Result<std::shared_ptr<const SetMask>> AnimationSet::useMask(const std::vector<float>& weights) const
{
    if (weights.size() != trackCount())
        return Error{"a mask of " + std::to_string(weights.size()) + " tracks for a set of " +
                     std::to_string(trackCount())};
    std::shared_ptr<const SetMask> mask = _masks->use(weights);
    if (!mask) return Error{"the set has " + std::to_string(MaskTable::maxMasks) + " masks already"};
    return mask;
}

} // namespace osgGpuAnimation
