// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/AnimationLayer.h>

#include <osgGpuAnimation/animation/bounds/JointRange.h>
#include <osgGpuAnimation/animation/JointMask.h>
#include <osgGpuAnimation/animation/playback/BlendList.h>
#include <osgGpuAnimation/animation/playback/FrameEvents.h>

#include <layout.glsl>

#include <algorithm>
#include <cmath>
#include <optional>

namespace osgGpuAnimation
{

AnimationLayer::AnimationLayer(LayerOwner& owner, const AnimationLayer& other) : AnimationLayer(other)
{
    _owner = &owner;
    if (_posed) _posed = std::make_shared<Posed>(Posed{std::make_shared<JointPose>(*_posed->pose), _posed->share});
    _crossfadeMoment = _weightFadeMoment = -1.0;
    _mixer.clearSteps();
}

ClipPlayback AnimationLayer::playbackOf(std::size_t clip, LoopMode loopMode) const
{
    return ClipPlayback(static_cast<int>(clip), set().clips()[clip].duration(), _speed, loopMode);
}

Result<void> AnimationLayer::play(std::size_t clip)
{
    return crossfade(clip, 0.0);
}

Result<void> AnimationLayer::play(const std::string& name)
{
    const Result<std::size_t> clip = set().clipNamed(name);
    if (!clip) return clip.error();
    return play(clip.value());
}

namespace
{

Result<void> checkFade(const std::string& target, double seconds, const CrossfadeOptions& options)
{
    if (!std::isfinite(seconds) || seconds < 0.0)
        return Error{"a crossfade to " + target + " of " + std::to_string(seconds) +
                     " seconds: expected a finite number, at least 0"};
    if (options.speed && !std::isfinite(*options.speed))
        return Error{"a crossfade to " + target + " at a speed of " + std::to_string(*options.speed) +
                     ": expected a finite number"};
    return {};
}

} // namespace

Result<void> AnimationLayer::crossfade(std::size_t clip, double seconds, const CrossfadeOptions& options)
{
    const Result<std::size_t> known = set().clipAt(clip);
    if (!known) return known.error();
    if (const auto sound = checkFade("clip \"" + set().clips()[clip].name() + "\"", seconds, options); !sound)
        return sound.error();
    if (options.speed) _speed = *options.speed;
    if (options.loopMode) _loopMode = *options.loopMode;
    begin(playbackOf(clip, _loopMode), seconds, options);
    rebuildInstruction();
    return {};
}

/// Starts a clip at once or by a fade, at the phase of what the options name. A pose that hides all clips fades out
/// over the new one.
void AnimationLayer::begin(ClipPlayback playback, double seconds, const CrossfadeOptions& options)
{
    const bool isFromPose = clipShare() <= 0.0;
    if (_state == PlayState::Stopped || isFromPose) _mixer.clear();
    const bool sharesPhase = options.sync == Sync::Phase && !_mixer.isEmpty();
    if (sharesPhase) playback.setPhase(_mixer.phaseFor(playback.clip()));
    if (_isPhaseShared)
        if (const std::optional<double> phase = _owner->sharedPhase(*this, playback.clip())) playback.setPhase(*phase);
    if (seconds > 0.0 && !isFromPose)
        _mixer.fadeTo(playback, seconds, options.curve, sharesPhase);
    else
        _mixer.start(playback);
    fadePose(0.0, seconds, options.curve);
    _state = PlayState::Playing;
}

Result<void> AnimationLayer::play(std::shared_ptr<const BlendSpace> space)
{
    return crossfade(std::move(space), 0.0);
}

Result<void> AnimationLayer::crossfade(std::shared_ptr<const BlendSpace> space, double seconds,
                                       const CrossfadeOptions& options)
{
    if (!space || !space->fits(set())) return Error{"the blend space is null or not made for this animation set"};
    if (const auto sound = checkFade("a blend space", seconds, options); !sound) return sound.error();
    if (options.speed) _speed = *options.speed;
    if (options.loopMode) _loopMode = *options.loopMode;
    const BlendSpace::Mix mix = space->mixAt(_parameter);
    std::size_t point = mix.weights[mix.count - 1].point; // the heaviest, unless the current clip is one of them
    for (std::size_t i = 0; i < mix.count; ++i)
        if (static_cast<int>(space->points()[mix.weights[i].point].clip) == clip()) point = mix.weights[i].point;
    begin(playbackOf(space->points()[point].clip, _loopMode), seconds, options);
    _mixer.spread(std::move(space), point, _parameter);
    rebuildInstruction();
    return {};
}

bool AnimationLayer::setParameter(double x, double y)
{
    if (!std::isfinite(x) || !std::isfinite(y)) return false;
    _parameter = {x, y};
    if (!_mixer.currentSpace()) return true;
    _mixer.setParameter(_parameter);
    rebuildInstruction();
    return true;
}

std::shared_ptr<const BlendSpace> AnimationLayer::blendSpace() const
{
    const ClipMixer::ActiveSpace* active = _mixer.currentSpace();
    return active ? active->space : nullptr;
}

void AnimationLayer::setPhaseShared(bool isShared)
{
    _isPhaseShared = isShared;
    if (!isShared) _mixer.setRoundsPerSecond(std::nullopt);
}

Result<void> AnimationLayer::crossfade(const std::string& name, double seconds, const CrossfadeOptions& options)
{
    const Result<std::size_t> clip = set().clipNamed(name);
    if (!clip) return clip.error();
    return crossfade(clip.value(), seconds, options);
}

void AnimationLayer::pause()
{
    if (_state == PlayState::Playing) _state = PlayState::Paused;
}

void AnimationLayer::resume()
{
    if (_state == PlayState::Paused) _state = PlayState::Playing;
}

void AnimationLayer::stop()
{
    _state = PlayState::Stopped;
    fadePose(0.0, 0.0, FadeCurve::Linear);
    if (!_mixer.isEmpty())
    {
        const ClipMixer::ActiveSpace* active = _mixer.currentSpace();
        const std::shared_ptr<const BlendSpace> space = active ? active->space : nullptr;
        const std::size_t point = _mixer.activeClip(_mixer.activeClipCount() - 1).point;
        _mixer.start(playbackOf(static_cast<std::size_t>(clip()), _loopMode));
        if (space) _mixer.spread(space, point, _parameter);
        _mixer.seek(0.0);
    }
    rebuildInstruction();
}

JointPose& AnimationLayer::pose()
{
    if (_posed) return *_posed->pose;
    const double share = _state == PlayState::Stopped ? 1.0 : 0.0;
    _posed = std::make_shared<Posed>(Posed{std::make_shared<JointPose>(_owner->_set), Fade(share)});
    rebuildInstruction();
    return *_posed->pose;
}

bool AnimationLayer::showPose(double seconds, FadeCurve curve)
{
    if (!std::isfinite(seconds) || seconds < 0.0) return false;
    pose();
    fadePose(1.0, seconds, curve);
    advancePose(0.0);
    rebuildInstruction();
    return true;
}

void AnimationLayer::fadePose(double share, double seconds, FadeCurve curve)
{
    if (_posed) _posed->share = Fade({_posed->share.value(), share, seconds, 0.0, curve});
}

/// Returns the share of the step after which the pose's fade ended, in [0, 1]; -1 if it did not end.
double AnimationLayer::advancePose(double seconds)
{
    if (!_posed) return -1.0;
    if (_posed->share.state().to > 0.0 && clipShare() <= 0.0 && _state != PlayState::Stopped)
    {
        _mixer.clear();
        _state = PlayState::Stopped;
    }
    return _posed->share.advance(seconds);
}

bool AnimationLayer::seek(double seconds)
{
    if (std::isnan(seconds)) return false;
    if (_mixer.isEmpty()) return true;
    _mixer.seek(seconds);
    if (_state == PlayState::Ended && !_mixer.current().isAtEnd()) _state = PlayState::Playing;
    rebuildInstruction();
    return true;
}

bool AnimationLayer::setSpeed(double speed)
{
    if (!std::isfinite(speed)) return false;
    _speed = speed;
    _mixer.setSpeed(speed);
    return true;
}

Result<void> AnimationLayer::setGroundSpeed(double speed)
{
    if (!std::isfinite(speed)) return Error{"a ground speed of " + std::to_string(speed) + ": it must be finite"};
    if (_mixer.isEmpty()) return Error{"a ground speed for a layer that plays nothing"};
    const ClipMixer::ActiveSpace* active = _mixer.currentSpace();
    const double measured = active ? active->space->groundSpeedAt(set(), active->parameter)
                                   : measureGroundSpeed(set(), static_cast<std::size_t>(clip()));
    const double factor = measured > 0.0 ? speed / measured : HUGE_VAL;
    if (std::isfinite(factor))
        setSpeed(factor);
    else if (speed == 0.0)
        setSpeed(1.0);
    else
        return Error{"a ground speed for clip \"" + set().clips()[static_cast<std::size_t>(clip())].name() +
                     "\": its feet stand, so no speed fits; setSpeed() sets one"};
    return {};
}

void AnimationLayer::setLoopMode(LoopMode mode)
{
    _loopMode = mode;
    _mixer.setLoopMode(mode);
    rebuildInstruction();
}

bool AnimationLayer::setWeight(float weight)
{
    return fadeWeight(weight, 0.0);
}

bool AnimationLayer::fadeWeight(float weight, double seconds, FadeCurve curve)
{
    if (std::isnan(weight) || !std::isfinite(seconds) || seconds < 0.0) return false;
    const double target = std::clamp(static_cast<double>(weight), 0.0, 1.0);
    _weight = Fade({_weight.value(), target, seconds, 0.0, curve});
    rebuildInstruction();
    return true;
}

Result<void> AnimationLayer::setMask(const JointMask& mask)
{
    const Result<std::shared_ptr<const SetMask>> used = set().useMask(mask.weights());
    if (!used) return used.error();
    _mask = used.value();
    rebuildInstruction();
    return {};
}

void AnimationLayer::clearMask()
{
    _mask = nullptr;
    rebuildInstruction();
}

void AnimationLayer::setMode(Mode mode, Reference reference)
{
    _mode = mode;
    _reference = reference;
    rebuildInstruction();
}

void AnimationLayer::setBlendPriority(int blendPriority)
{
    _blendPriority = blendPriority;
    rebuildInstruction();
}

void AnimationLayer::advance(double seconds)
{
    const bool isPaused = _state == PlayState::Paused; // fades stand still: their means are their values
    if (isPaused && _posed) (void)_posed->share.advance(0.0);
    const double poseMoment = isPaused ? -1.0 : advancePose(seconds);
    const bool isMoving = _state == PlayState::Playing || _state == PlayState::Ended;
    _crossfadeMoment = poseMoment;
    _weightFadeMoment = _weight.advance(isPaused ? 0.0 : seconds);
    if (!isMoving) return _mixer.clearSteps();
    _crossfadeMoment = std::max(poseMoment, _mixer.advance(seconds, _state == PlayState::Playing));
    if (_mixer.activeClip(_mixer.activeClipCount() - 1).move.hasFinished) _state = PlayState::Ended;
}

BlendSample AnimationLayer::sampleOf(const ClipPlayback& playback, double time, double share) const
{
    BlendSample sample = set().sampleAt(playback.clip(), time);
    sample.weight = static_cast<float>(share * clipShare() * _weight.value());
    sample.control |= mask() << POSE_SAMPLE_MASK_SHIFT;
    return sample;
}

void AnimationLayer::collectPose(BlendList& out) const
{
    const std::uint32_t mask = this->mask() << POSE_SAMPLE_MASK_SHIFT;
    const auto weight = static_cast<float>(_posed->share.value() * _weight.value());
    const BlendSample sample{out.addPose(_posed->pose), 0.0f, weight, mask | POSE_SAMPLE_POSED};
    if (_mode == Mode::Override)
        out.add(sample, _blendPriority);
    else
        out.addDifference(BlendSample{0, 0.0f, weight, mask}, sample);
}

void AnimationLayer::collect(BlendList& out) const
{
    if (_posed && _posed->isShown() && _weight.value() > 0.0) collectPose(out);
    if (_state == PlayState::Stopped) return;
    for (std::size_t v = 0; v < _mixer.activeClipCount(); ++v)
    {
        const ClipMixer::ActiveClip& activeClip = _mixer.activeClip(v);
        if (!(activeClip.share > 0.0)) continue;
        const BlendSample sample = sampleOf(activeClip.playback, activeClip.playback.shownTime(), activeClip.share);
        if (_mode == Mode::Override)
            out.add(sample, _blendPriority);
        else if (_reference == Reference::FirstFrame)
            out.addDifference(sampleOf(activeClip.playback, 0.0, activeClip.share), sample);
        else
            out.addDifference(BlendSample{0, 0.0f, sample.weight, mask() << POSE_SAMPLE_MASK_SHIFT}, sample);
    }
}

bool AnimationLayer::isPlainLoop() const
{
    const bool isDefault = _mode == Mode::Override && _reference == Reference::RestPose && !_mask &&
                           _blendPriority == static_cast<int>(_index) && _weight.isFinished() && _weight.value() == 1.0;
    if (!isDefault || _loopMode != LoopMode::Loop || _state == PlayState::Ended) return false;
    if (_posed || _isPhaseShared || _parameter != glm::dvec2(0.0) || _mixer.currentSpace()) return false;
    if (_mixer.isEmpty()) return _state == PlayState::Stopped;
    const ClipPlayback& current = _mixer.current();
    return _state != PlayState::Stopped && !_mixer.isFading() && current.loopMode() == LoopMode::Loop &&
           current.speed() == _speed;
}

/// usual: the curve of any clip of the set. A clip without root motion contributes a motion of 0 at the joint of this
/// curve, with its weight.
void AnimationLayer::collectMotion(RootMotionBlend& out, const RootMotionCurve& usual) const
{
    if (_posed && _mode == Mode::Override) collectPoseMotion(out, usual);
    if (_state == PlayState::Stopped || _mode == Mode::Additive) return;
    const double clipShare = _posed ? 1.0 - _posed->share.mean() : 1.0;
    for (std::size_t v = 0; v < _mixer.activeClipCount(); ++v)
    {
        const ClipMixer::ActiveClip& activeClip = _mixer.activeClip(v);
        const Clip& clip = set().clips()[static_cast<std::size_t>(activeClip.playback.clip())];
        const RootMotionCurve& curve = clip.rootMotion() ? *clip.rootMotion() : usual;
        const double weight = clipShare * activeClip.meanShare * _weight.mean() *
                              (_mask ? static_cast<double>(_mask->weights[curve.joint]) : 1.0);
        out.add(clip.rootMotion() ? rootMotionOf(clip, activeClip.move, activeClip.playback.loopMode())
                                  : RootMotion{glm::dvec3(0.0), 0.0, curve.up},
                weight, _blendPriority);
    }
}

/// A pose that sets the joint's translation holds the character in place.
void AnimationLayer::collectPoseMotion(RootMotionBlend& out, const RootMotionCurve& usual) const
{
    const PoseExtent& extent = *_posed->pose->extent();
    if (usual.joint >= extent.joints.size() || !extent.joints[usual.joint].moves) return;
    const double weight =
        _posed->share.mean() * _weight.mean() * (_mask ? static_cast<double>(_mask->weights[usual.joint]) : 1.0);
    out.add(RootMotion{glm::dvec3(0.0), 0.0, usual.up}, weight, _blendPriority);
}

LayerStep AnimationLayer::lastStep() const
{
    return {_index, _mixer, _crossfadeMoment, _weightFadeMoment};
}

void AnimationLayer::rebuildInstruction()
{
    _owner->rebuildInstruction();
}

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
    const std::vector<BlendSpace::Point>& points = spaces[static_cast<std::size_t>(activeClip.space)].space->points();
    return activeClip.point < points.size() && isShare(activeClip.weight) && activeClip.weight > 0.0 &&
           static_cast<int>(points[activeClip.point].clip) == activeClip.clip;
}

std::optional<std::string> findFault(const LayerSnapshot& snapshot, const AnimationSet& set)
{
    if (!std::isfinite(snapshot.speed)) return "a speed that is not finite";
    for (const Fade::State& fade : {snapshot.weight, snapshot.crossfade, snapshot.poseShare})
        if (!isSound(fade)) return "a fade that cannot be";
    if (snapshot.activeClips.size() > ClipMixer::maxActiveClips)
        return std::to_string(snapshot.activeClips.size()) + " clips at a time, at most " +
               std::to_string(ClipMixer::maxActiveClips) + " are possible";
    if (snapshot.activeClips.empty() && snapshot.state != PlayState::Stopped) return "a state of playing, but no clip";
    if (!isFinite(snapshot.parameter)) return "a parameter that is not finite";
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

int phaseGroupOf(const ClipMixer& mixer, std::size_t activeClip)
{
    std::size_t first = 0;
    while (mixer.activeClip(first).phaseGroup != mixer.activeClip(activeClip).phaseGroup)
        ++first;
    return static_cast<int>(first);
}

/// The spaces of the snapshot for the set, numbered by their order.
Result<std::vector<ClipMixer::ActiveSpace>> spacesOf(const LayerSnapshot& snapshot, const AnimationSet& set)
{
    std::vector<ClipMixer::ActiveSpace> spaces;
    for (const LayerSnapshot::ActiveSpace& kept : snapshot.spaces)
    {
        std::shared_ptr<const BlendSpace> space = kept.space;
        if (!space->fits(set))
        {
            const auto made = BlendSpace::create(set, space->points(), space->syncMarkers());
            if (!made) return made.error();
            space = made.value();
        }
        spaces.push_back(
            {space, static_cast<int>(spaces.size()), kept.parameter, kept.phase, kept.isReturning, kept.isFresh});
    }
    return spaces;
}

} // namespace

LayerSnapshot AnimationLayer::snapshot() const
{
    LayerSnapshot snapshot;
    snapshot.state = _state;
    snapshot.loopMode = _loopMode;
    snapshot.speed = _speed;
    for (const ClipMixer::ActiveSpace& space : _mixer.spaces())
        snapshot.spaces.push_back({space.space, space.parameter, space.phase, space.isReturning, space.isFresh});
    for (std::size_t v = 0; v < _mixer.activeClipCount(); ++v)
    {
        const ClipMixer::ActiveClip& activeClip = _mixer.activeClip(v);
        const ClipPlayback& playback = activeClip.playback;
        const auto space = std::find_if(_mixer.spaces().begin(), _mixer.spaces().end(),
                                        [&](const auto& active) { return active.number == activeClip.space; });
        const bool isInSpace = space != _mixer.spaces().end();
        snapshot.activeClips.push_back(
            {playback.clip(), playback.time(), playback.speed(), playback.loopMode(), playback.isReturning(),
             playback.isFresh(), activeClip.share, activeClip.shareBefore, phaseGroupOf(_mixer, v),
             isInSpace ? static_cast<int>(space - _mixer.spaces().begin()) : -1, activeClip.point, activeClip.weight});
    }
    snapshot.crossfade = _mixer.fade().state();
    snapshot.weight = _weight.state();
    if (_mask) snapshot.mask = _mask->weights;
    if (_posed) snapshot.pose = _posed->pose->tracks();
    if (_posed) snapshot.poseShare = _posed->share.state();
    snapshot.mode = _mode;
    snapshot.reference = _reference;
    snapshot.blendPriority = _blendPriority;
    snapshot.parameter = _parameter;
    snapshot.isPhaseShared = _isPhaseShared;
    return snapshot;
}

Result<void> AnimationLayer::restore(const LayerSnapshot& snapshot)
{
    const AnimationSet& set = this->set();
    if (const std::optional<std::string> fault = findFault(snapshot, set)) return Error{"a layer with " + *fault};
    std::shared_ptr<const SetMask> mask;
    if (!snapshot.mask.empty())
    {
        const Result<std::shared_ptr<const SetMask>> used = set.useMask(snapshot.mask);
        if (!used) return used.error();
        mask = used.value();
    }
    std::shared_ptr<Posed> posed;
    if (!snapshot.pose.empty() || Fade(snapshot.poseShare).value() > 0.0)
    {
        posed = std::make_shared<Posed>(Posed{std::make_shared<JointPose>(_owner->_set), Fade(snapshot.poseShare)});
        if (const Result<void> set = posed->pose->setTracks(snapshot.pose); !set) return set.error();
    }
    const Result<std::vector<ClipMixer::ActiveSpace>> spaces = spacesOf(snapshot, set);
    if (!spaces) return Error{"a layer with " + spaces.error().message};
    std::vector<ClipMixer::ActiveClip> activeClips;
    for (const LayerSnapshot::ActiveClip& kept : snapshot.activeClips)
    {
        ClipMixer::ActiveClip activeClip;
        activeClip.playback = ClipPlayback(kept.clip, set.clips()[static_cast<std::size_t>(kept.clip)].duration(),
                                           kept.speed, kept.loopMode);
        activeClip.playback.restore(kept.time, kept.isReturning, kept.isFresh);
        activeClip.share = kept.share;
        activeClip.shareBefore = kept.shareBefore;
        activeClip.phaseGroup = kept.phaseGroup;
        activeClip.space = kept.space;
        activeClip.point = kept.point;
        activeClip.weight = kept.weight;
        activeClips.push_back(activeClip);
    }
    _mixer.restore(activeClips, Fade(snapshot.crossfade), spaces.value());
    _state = snapshot.state;
    _loopMode = snapshot.loopMode;
    _speed = snapshot.speed;
    _weight = Fade(snapshot.weight);
    _mask = mask;
    _posed = posed;
    _mode = snapshot.mode;
    _reference = snapshot.reference;
    _blendPriority = snapshot.blendPriority;
    _parameter = snapshot.parameter;
    _isPhaseShared = snapshot.isPhaseShared;
    rebuildInstruction();
    return {};
}

} // namespace osgGpuAnimation
