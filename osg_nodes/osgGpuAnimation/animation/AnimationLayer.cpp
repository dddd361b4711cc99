// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/AnimationLayer.h>

#include <osgGpuAnimation/animation/JointMask.h>
#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/playback/BlendList.h>
#include <osgGpuAnimation/animation/RootMotion.h>
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
    _crossfadeMoment = _weightFadeMoment = -1.0;
    _mixer.stand();
}

ClipPlayback AnimationLayer::playbackOf(std::size_t clip, LoopMode loopMode) const
{
    return ClipPlayback(static_cast<int>(clip), set().clips()[clip].duration(), _speed, loopMode);
}

Result<bool> AnimationLayer::play(std::size_t clip)
{
    const Result<std::size_t> known = set().clipAt(clip);
    if (!known) return known.error();
    _mixer.start(playbackOf(clip, _loopMode));
    _state = PlayState::Playing;
    show();
    return true;
}

Result<bool> AnimationLayer::play(const std::string& name)
{
    const Result<std::size_t> clip = set().clipNamed(name);
    if (!clip) return clip.error();
    return play(clip.value());
}

Result<bool> AnimationLayer::crossfade(std::size_t clip, double seconds, const CrossfadeOptions& options)
{
    const Result<std::size_t> known = set().clipAt(clip);
    if (!known) return known.error();
    if (!std::isfinite(seconds) || seconds < 0.0)
        return Error{"a crossfade to clip \"" + set().clips()[clip].name() + "\" of " + std::to_string(seconds) +
                     " seconds: expected a finite number, at least 0"};
    if (options.speed && !std::isfinite(*options.speed))
        return Error{"a crossfade to clip \"" + set().clips()[clip].name() + "\" at a speed of " +
                     std::to_string(*options.speed) + ": expected a finite number"};
    if (options.speed) _speed = *options.speed;
    if (options.loopMode) _loopMode = *options.loopMode;
    if (_state == PlayState::Stopped) _mixer.clear();
    ClipPlayback playback = playbackOf(clip, _loopMode);
    const bool sharesPhase = options.sync == Sync::Phase && !_mixer.isEmpty();
    if (sharesPhase) playback.setPhase(_mixer.current().phase());
    if (seconds > 0.0)
        _mixer.fadeTo(playback, seconds, options.curve, sharesPhase);
    else
        _mixer.start(playback);
    _state = PlayState::Playing;
    show();
    return true;
}

Result<bool> AnimationLayer::crossfade(const std::string& name, double seconds, const CrossfadeOptions& options)
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
    if (!_mixer.isEmpty())
    {
        _mixer.start(playbackOf(static_cast<std::size_t>(clip()), _loopMode));
        _mixer.current().seek(0.0);
    }
    show();
}

bool AnimationLayer::seek(double seconds)
{
    if (std::isnan(seconds)) return false;
    if (_mixer.isEmpty()) return true;
    _mixer.current().seek(seconds);
    if (_state == PlayState::Ended && !_mixer.current().isAtEnd()) _state = PlayState::Playing;
    show();
    return true;
}

bool AnimationLayer::setSpeed(double speed)
{
    if (!std::isfinite(speed)) return false;
    _speed = speed;
    if (!_mixer.isEmpty()) _mixer.current().setSpeed(speed);
    return true;
}

void AnimationLayer::setLoopMode(LoopMode mode)
{
    _loopMode = mode;
    if (!_mixer.isEmpty()) _mixer.current().setLoopMode(mode);
    show();
}

bool AnimationLayer::setWeight(float weight)
{
    return fadeWeight(weight, 0.0);
}

bool AnimationLayer::fadeWeight(float weight, double seconds, FadeCurve curve)
{
    if (std::isnan(weight) || !std::isfinite(seconds) || seconds < 0.0) return false;
    _weight = Fade(_weight.value(), std::clamp(static_cast<double>(weight), 0.0, 1.0), seconds, curve);
    show();
    return true;
}

Result<bool> AnimationLayer::setMask(const JointMask& mask)
{
    const Result<std::uint32_t> number = set().addMask(mask.weights());
    if (!number) return number.error();
    _mask = number.value();
    show();
    return true;
}

void AnimationLayer::clearMask()
{
    _mask = 0;
    show();
}

void AnimationLayer::setMode(Mode mode, Reference reference)
{
    _mode = mode;
    _reference = reference;
    show();
}

void AnimationLayer::setStanding(int standing)
{
    _standing = standing;
    show();
}

void AnimationLayer::advance(double seconds)
{
    _crossfadeMoment = _weightFadeMoment = -1.0;
    if (_state == PlayState::Paused)
    {
        _mixer.stand();
        return;
    }
    _weightFadeMoment = _weight.advance(seconds);
    if (_state == PlayState::Stopped)
    {
        _mixer.stand();
        return;
    }
    _crossfadeMoment = _mixer.advance(seconds, _state == PlayState::Playing);
    if (_mixer.voice(_mixer.voiceCount() - 1).move.hasFinished) _state = PlayState::Ended;
}

BlendSample AnimationLayer::sampleOf(const ClipPlayback& playback, double time, double share) const
{
    BlendSample sample = set().sampleAt(playback.clip(), time);
    sample.weight = static_cast<float>(share * _weight.value());
    sample.control |= _mask << POSE_SAMPLE_MASK_SHIFT;
    return sample;
}

void AnimationLayer::collect(SampleStack& out) const
{
    if (_state == PlayState::Stopped) return;
    for (std::size_t v = 0; v < _mixer.voiceCount(); ++v)
    {
        const ClipMixer::Voice& voice = _mixer.voice(v);
        if (!(voice.share > 0.0)) continue;
        const BlendSample sample = sampleOf(voice.playback, voice.playback.shownTime(), voice.share);
        if (_mode == Mode::Override)
            out.add(sample, _standing);
        else if (_reference == Reference::FirstFrame)
            out.addDifference(sampleOf(voice.playback, 0.0, voice.share), sample);
        else
            out.addDifference(BlendSample{0, 0.0f, sample.weight, _mask << POSE_SAMPLE_MASK_SHIFT}, sample);
    }
}

bool AnimationLayer::isPlainLoop() const
{
    const bool isDefault = _mode == Mode::Override && _reference == Reference::RestPose && _mask == 0 &&
                           _standing == static_cast<int>(_index) && _weight.isFinished() && _weight.value() == 1.0;
    if (!isDefault || _loopMode != LoopMode::Loop || _state == PlayState::Ended) return false;
    if (_mixer.isEmpty()) return _state == PlayState::Stopped;
    const ClipPlayback& current = _mixer.current();
    return _state != PlayState::Stopped && !_mixer.isFading() && current.loopMode() == LoopMode::Loop &&
           current.speed() == _speed;
}

/// usual: the curve of any clip of the set. A clip without root motion stands still, and hides other motions at its
/// joint.
void AnimationLayer::collectMotion(MotionBlend& out, const RootMotionCurve& usual) const
{
    if (_state == PlayState::Stopped || _mode == Mode::Additive) return;
    const float* mask = set().masks().weights(_mask);
    for (std::size_t v = 0; v < _mixer.voiceCount(); ++v)
    {
        const ClipMixer::Voice& voice = _mixer.voice(v);
        const Clip& clip = set().clips()[static_cast<std::size_t>(voice.playback.clip())];
        const RootMotionCurve& curve = clip.rootMotion() ? *clip.rootMotion() : usual;
        const double weight = voice.meanShare * _weight.mean() * (mask ? static_cast<double>(mask[curve.joint]) : 1.0);
        out.add(clip.rootMotion() ? rootMotionOf(clip, voice.move, voice.playback.loopMode())
                                  : RootMotion{glm::dvec3(0.0), 0.0, curve.up},
                weight, _standing);
    }
}

LayerStep AnimationLayer::lastStep() const
{
    return {_index, _mixer, _crossfadeMoment, _weightFadeMoment};
}

void AnimationLayer::show()
{
    _owner->show();
}

namespace
{

LayerSnapshot::FadeState stateOf(const Fade& fade)
{
    return {fade.origin(), fade.target(), fade.seconds(), fade.elapsed(), fade.curve()};
}

Fade restored(const LayerSnapshot::FadeState& state)
{
    Fade fade(state.from, state.to, state.seconds, state.curve);
    fade.advance(state.elapsed);
    return fade;
}

bool isShare(double value)
{
    return value >= 0.0 && value <= 1.0;
}

bool isSound(const LayerSnapshot::FadeState& state)
{
    return isShare(state.from) && isShare(state.to) && std::isfinite(state.seconds) && state.seconds >= 0.0 &&
           std::isfinite(state.elapsed) && state.elapsed >= 0.0;
}

std::optional<std::string> findFault(const LayerSnapshot& snapshot, const AnimationSet& set)
{
    if (!std::isfinite(snapshot.speed)) return "a speed that is not finite";
    if (!isSound(snapshot.weight) || !isSound(snapshot.crossfade)) return "a fade that cannot be";
    if (snapshot.voices.size() > ClipMixer::maxVoices)
        return std::to_string(snapshot.voices.size()) + " clips at a time, at most " +
               std::to_string(ClipMixer::maxVoices) + " are possible";
    if (snapshot.voices.empty() && snapshot.state != PlayState::Stopped) return "a state of playing, but no clip";
    for (const LayerSnapshot::Voice& voice : snapshot.voices)
    {
        if (voice.clip < 0 || static_cast<std::size_t>(voice.clip) >= set.clips().size())
            return "clip " + std::to_string(voice.clip) + " of " + std::to_string(set.clips().size());
        if (!std::isfinite(voice.time) || !std::isfinite(voice.speed)) return "a time or speed that is not finite";
        if (voice.phaseGroup < 0 || static_cast<std::size_t>(voice.phaseGroup) >= snapshot.voices.size())
            return "a clip in step with one that is not there";
        if (!isShare(voice.share) || !isShare(voice.shareBefore)) return "a share that is not in [0, 1]";
    }
    const bool isFinite = std::all_of(snapshot.mask.begin(), snapshot.mask.end(), [](float w) { return isShare(w); });
    if (!snapshot.mask.empty() && (snapshot.mask.size() != set.trackCount() || !isFinite))
        return "a mask that is not one weight in [0, 1] for each of " + std::to_string(set.trackCount()) + " tracks";
    return std::nullopt;
}

int phaseGroupOf(const ClipMixer& mixer, std::size_t voice)
{
    std::size_t first = 0;
    while (mixer.voice(first).phaseGroup != mixer.voice(voice).phaseGroup)
        ++first;
    return static_cast<int>(first);
}

} // namespace

LayerSnapshot AnimationLayer::snapshot() const
{
    LayerSnapshot snapshot;
    snapshot.state = _state;
    snapshot.loopMode = _loopMode;
    snapshot.speed = _speed;
    for (std::size_t v = 0; v < _mixer.voiceCount(); ++v)
    {
        const ClipMixer::Voice& voice = _mixer.voice(v);
        const ClipPlayback& playback = voice.playback;
        snapshot.voices.push_back({playback.clip(), playback.time(), playback.speed(), playback.loopMode(),
                                   playback.isReturning(), playback.isFresh(), voice.share, voice.shareBefore,
                                   phaseGroupOf(_mixer, v)});
    }
    snapshot.crossfade = stateOf(_mixer.fade());
    snapshot.weight = stateOf(_weight);
    if (const float* weights = set().masks().weights(_mask))
        snapshot.mask.assign(weights, weights + set().trackCount());
    snapshot.mode = _mode;
    snapshot.reference = _reference;
    snapshot.standing = _standing;
    return snapshot;
}

Result<bool> AnimationLayer::restore(const LayerSnapshot& snapshot)
{
    const AnimationSet& set = this->set();
    if (const std::optional<std::string> fault = findFault(snapshot, set)) return Error{"a layer with " + *fault};
    std::uint32_t mask = 0;
    if (!snapshot.mask.empty())
    {
        const Result<std::uint32_t> number = set.addMask(snapshot.mask);
        if (!number) return number.error();
        mask = number.value();
    }
    std::vector<ClipMixer::Voice> voices;
    for (const LayerSnapshot::Voice& kept : snapshot.voices)
    {
        ClipMixer::Voice voice;
        voice.playback = ClipPlayback(kept.clip, set.clips()[static_cast<std::size_t>(kept.clip)].duration(),
                                      kept.speed, kept.loopMode);
        voice.playback.restore(kept.time, kept.isReturning, kept.isFresh);
        voice.share = kept.share;
        voice.shareBefore = kept.shareBefore;
        voice.phaseGroup = kept.phaseGroup;
        voices.push_back(voice);
    }
    _mixer.restore(voices, restored(snapshot.crossfade));
    _state = snapshot.state;
    _loopMode = snapshot.loopMode;
    _speed = snapshot.speed;
    _weight = restored(snapshot.weight);
    _mask = mask;
    _mode = snapshot.mode;
    _reference = snapshot.reference;
    _standing = snapshot.standing;
    show();
    return true;
}

} // namespace osgGpuAnimation
