// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/LayerSnapshot.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace osgGpuAnimation
{

namespace
{

bool isShare(double value)
{
    return value >= 0.0 && value <= 1.0;
}

bool isSound(const Fade::State& state)
{
    return isShare(state.from) && isShare(state.to) && std::isfinite(state.seconds) && state.seconds >= 0.0 &&
           std::isfinite(state.elapsed) && state.elapsed >= 0.0;
}

bool isFinite(const glm::dvec2& parameter)
{
    return std::isfinite(parameter.x) && std::isfinite(parameter.y);
}

/// True if the clip is of none of the spaces, or of one that has it.
bool isSound(const LayerSnapshot::ActiveClip& activeClip, const std::vector<LayerSnapshot::ActiveSpace>& spaces)
{
    if (activeClip.space < 0) return true;
    if (static_cast<std::size_t>(activeClip.space) >= spaces.size()) return false;
    const std::vector<BlendSpace::Point>& points = spaces[activeClip.space].space->points();
    return activeClip.point < points.size() && isShare(activeClip.weight) && activeClip.weight > 0.0 &&
           static_cast<int>(points[activeClip.point].clip) == activeClip.clip;
}

std::optional<std::string> findFault(const LayerSnapshot& snapshot, const AnimationSet& set)
{
    if (!std::isfinite(snapshot.settings.speed)) return "a speed that is not finite";
    for (const Fade::State& fade : {snapshot.weight, snapshot.crossfade, snapshot.poseShare})
        if (!isSound(fade)) return "a fade that cannot be";
    if (snapshot.activeClips.size() > ClipMixer::maxActiveClips)
        return std::to_string(snapshot.activeClips.size()) + " clips at a time, at most " +
               std::to_string(ClipMixer::maxActiveClips) + " are possible";
    if (snapshot.activeClips.empty() && snapshot.state != PlayState::Stopped) return "a state of playing, but no clip";
    if (!isFinite(snapshot.settings.parameter)) return "a parameter that is not finite";
    for (const LayerSnapshot::ActiveSpace& space : snapshot.spaces)
        if (!space.space || !isFinite(space.parameter) || !isShare(space.phase)) return "a blend space that cannot be";
    for (const LayerSnapshot::ActiveClip& activeClip : snapshot.activeClips)
    {
        if (!isSound(activeClip, snapshot.spaces)) return "a clip in a blend space that is not there";
        if (activeClip.clip < 0 || static_cast<std::size_t>(activeClip.clip) >= set.clips().size())
            return "clip " + std::to_string(activeClip.clip) + " of " + std::to_string(set.clips().size());
        if (!std::isfinite(activeClip.time) || !std::isfinite(activeClip.speed))
            return "a time or speed that is not finite";
        if (activeClip.phaseGroup < 0 || static_cast<std::size_t>(activeClip.phaseGroup) >= snapshot.activeClips.size())
            return "a clip in step with one that is not there";
        if (!isShare(activeClip.share) || !isShare(activeClip.shareBefore)) return "a share that is not in [0, 1]";
    }
    const bool isFinite = std::all_of(snapshot.mask.begin(), snapshot.mask.end(), [](float w) { return isShare(w); });
    if (!snapshot.mask.empty() && (snapshot.mask.size() != set.trackCount() || !isFinite))
        return "a mask that is not one weight in [0, 1] for each of " + std::to_string(set.trackCount()) + " tracks";
    return std::nullopt;
}

/// The spaces of the snapshot for the set, numbered by their order.
Result<std::vector<ClipMixer::ActiveSpace>> spacesOf(const LayerSnapshot& snapshot, const AnimationSet& set)
{
    std::vector<ClipMixer::ActiveSpace> spaces = snapshot.spaces;
    for (std::size_t number = 0; number < spaces.size(); ++number)
    {
        std::shared_ptr<const BlendSpace>& space = spaces[number].space;
        spaces[number].number = static_cast<int>(number);
        if (space->fits(set)) continue;
        const auto made = BlendSpace::create(set, space->points(), space->syncMarkers());
        if (!made) return made.error();
        space = made.value();
    }
    return spaces;
}

} // namespace

LayerSnapshot LayerSnapshot::of(const AnimationLayer& layer)
{
    LayerSnapshot snapshot;
    snapshot.state = layer._state;
    snapshot.settings = layer._settings;
    const ClipMixer& mixer = layer._mixer;
    snapshot.spaces = mixer.spaces();
    for (std::size_t v = 0; v < mixer.activeClipCount(); ++v)
    {
        const ClipMixer::ActiveClip& activeClip = mixer.activeClip(v);
        const ClipPlayback& playback = activeClip.playback;
        const auto space = std::find_if(mixer.spaces().begin(), mixer.spaces().end(),
                                        [&](const ActiveSpace& active) { return active.number == activeClip.space; });
        const bool isInSpace = space != mixer.spaces().end();
        int group = 0; // the first of its phase group
        while (mixer.activeClip(static_cast<std::size_t>(group)).phaseGroup != activeClip.phaseGroup)
            ++group;
        snapshot.activeClips.push_back(
            {playback.clip(), playback.time(), playback.speed(), playback.loopMode(), playback.isReturning(),
             playback.isFresh(), activeClip.share, activeClip.shareBefore, group,
             isInSpace ? static_cast<int>(space - mixer.spaces().begin()) : -1, activeClip.point, activeClip.weight});
    }
    snapshot.crossfade = mixer.fade().state();
    snapshot.weight = layer._weight.state();
    if (layer._mask) snapshot.mask = layer._mask->weights;
    if (!layer._pose) return snapshot;
    snapshot.pose = layer._pose->tracks();
    snapshot.poseShare = layer._poseShare.state();
    return snapshot;
}

Result<void> LayerSnapshot::restoreTo(AnimationLayer& layer) const
{
    const AnimationSet& set = layer.set();
    if (const std::optional<std::string> fault = findFault(*this, set)) return Error{"a layer with " + *fault};
    std::shared_ptr<const SetMask> usedMask;
    if (!mask.empty())
    {
        const Result<std::shared_ptr<const SetMask>> used = set.useMask(mask);
        if (!used) return used.error();
        usedMask = used.value();
    }
    std::shared_ptr<JointPose> posed;
    if (!pose.empty() || Fade(poseShare).value() > 0.0)
    {
        posed = std::make_shared<JointPose>(layer._stack->set);
        if (const Result<void> isSet = posed->setTracks(pose); !isSet) return isSet.error();
    }
    const Result<std::vector<ActiveSpace>> usedSpaces = spacesOf(*this, set);
    if (!usedSpaces) return Error{"a layer with " + usedSpaces.error().message};
    std::vector<ClipMixer::ActiveClip> clips;
    for (const ActiveClip& kept : activeClips)
    {
        ClipPlayback playback(kept.clip, set.clips()[kept.clip].duration(), kept.speed, kept.loopMode);
        playback.restore(kept.time, kept.isReturning, kept.isFresh);
        clips.push_back({playback, PlaybackStep(), kept.share, kept.share, kept.shareBefore, kept.phaseGroup,
                         kept.space, kept.point, kept.weight});
    }
    layer._mixer.restore(clips, Fade(crossfade), usedSpaces.value());
    layer._state = state;
    layer._settings = settings;
    layer._weight = Fade(weight);
    layer._mask = usedMask;
    layer._pose = posed;
    layer._poseShare = posed ? Fade(poseShare) : Fade(0.0);
    ++layer._changeCount;
    return {};
}

} // namespace osgGpuAnimation
