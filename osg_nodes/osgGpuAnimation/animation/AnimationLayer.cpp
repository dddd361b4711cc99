// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/AnimationLayer.h>

#include <osgGpuAnimation/animation/bounds/JointRange.h>
#include <osgGpuAnimation/animation/JointMask.h>
#include <osgGpuAnimation/animation/playback/BlendList.h>
#include <osgGpuAnimation/animation/playback/FrameEvents.h>

#include <layout.glsl>

#include <algorithm>
#include <cmath>

namespace osgGpuAnimation
{

AnimationLayer::AnimationLayer(const Stack& stack, const AnimationLayer& other) : AnimationLayer(other)
{
    _stack = &stack;
    if (_pose) _pose = std::make_shared<JointPose>(*_pose);
    _crossfadeMoment = _weightFadeMoment = std::nullopt;
    _mixer.clearSteps();
}

ClipPlayback AnimationLayer::playbackOf(std::size_t clip) const
{
    return ClipPlayback(static_cast<int>(clip), set().clips()[clip].duration(), _settings.speed, _settings.loopMode);
}

Result<void> AnimationLayer::crossfade(std::size_t clip, double seconds, const CrossfadeOptions& options)
{
    const Result<std::size_t> known = set().clipAt(clip);
    if (!known) return known.error();
    const Result<void> taken = takeOptions("clip \"" + set().clips()[clip].name() + "\"", seconds, options);
    if (taken) begin(clip, seconds, options);
    return taken;
}

Result<void> AnimationLayer::crossfade(const std::string& name, double seconds, const CrossfadeOptions& options)
{
    const Result<std::size_t> clip = set().clipNamed(name);
    if (!clip) return clip.error();
    return crossfade(clip.value(), seconds, options);
}

Result<void> AnimationLayer::crossfade(std::shared_ptr<const BlendSpace> space, double seconds,
                                       const CrossfadeOptions& options)
{
    if (!space || !space->fits(set())) return Error{"the blend space is null or not made for this animation set"};
    const Result<void> taken = takeOptions("a blend space", seconds, options);
    if (!taken) return taken;
    const BlendSpace::Mix mix = space->mixAt(_settings.parameter);
    std::size_t point = mix.weights[mix.count - 1].point; // the heaviest, unless the current clip is one of them
    for (std::size_t i = 0; i < mix.count; ++i)
        if (static_cast<int>(space->points()[mix.weights[i].point].clip) == playback().clip())
            point = mix.weights[i].point;
    begin(space->points()[point].clip, seconds, options);
    _mixer.spread(std::move(space), point, _settings.parameter);
    return {};
}

/// Takes the speed and the loop mode. Errors, without a change: see crossfade().
Result<void> AnimationLayer::takeOptions(const std::string& target, double seconds, const CrossfadeOptions& options)
{
    if (!std::isfinite(seconds) || seconds < 0.0)
        return Error{"a crossfade to " + target + " of " + std::to_string(seconds) +
                     " seconds: expected a finite number, at least 0"};
    if (options.speed && !std::isfinite(*options.speed))
        return Error{"a crossfade to " + target + " at a speed of " + std::to_string(*options.speed) +
                     ": expected a finite number"};
    _settings.speed = options.speed.value_or(_settings.speed);
    _settings.loopMode = options.loopMode.value_or(_settings.loopMode);
    return {};
}

/// Starts a clip at once or by a fade, at the phase of what the options name. A pose that hides all clips fades out
/// over the new one.
void AnimationLayer::begin(std::size_t clip, double seconds, const CrossfadeOptions& options)
{
    ClipPlayback playback = playbackOf(clip);
    const bool isFromPose = clipShare() <= 0.0;
    if (_state == PlayState::Stopped || isFromPose) _mixer.clear();
    const bool sharesPhase = options.sync == Sync::Phase && !_mixer.isEmpty();
    if (sharesPhase) playback.setPhase(_mixer.phaseFor(playback.clip()));
    if (_settings.isPhaseShared)
        if (const std::optional<double> phase = sharedPhase(playback.clip())) playback.setPhase(*phase);
    if (seconds > 0.0 && !isFromPose)
        _mixer.fadeTo(playback, seconds, options.curve, sharesPhase);
    else
        _mixer.start(playback);
    fadePose(0.0, seconds, options.curve);
    _state = PlayState::Playing;
}

/// The phase of the lowest other layer that shares its phase with this one; of this clip, if it plays there.
std::optional<double> AnimationLayer::sharedPhase(int clip) const
{
    for (std::size_t i = 0; i < _stack->count(); ++i)
    {
        const AnimationLayer& other = _stack->at(i);
        const bool isPartner = &other != this && other._settings.isPhaseShared && other._state == PlayState::Playing &&
                               other._settings.blendPriority == _settings.blendPriority;
        if (isPartner) return other._mixer.phaseFor(clip);
    }
    return std::nullopt;
}

bool AnimationLayer::setParameter(double x, double y)
{
    if (!std::isfinite(x) || !std::isfinite(y)) return false;
    _settings.parameter = {x, y};
    _mixer.setParameter(_settings.parameter);
    ++_changeCount;
    return true;
}

void AnimationLayer::setPhaseShared(bool isShared)
{
    _settings.isPhaseShared = isShared;
    if (!isShared) _mixer.setRoundsPerSecond(std::nullopt);
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
    if (_mixer.isEmpty()) return;
    const ClipMixer::ActiveSpace* active = _mixer.currentSpace();
    const std::shared_ptr<const BlendSpace> space = active ? active->space : nullptr;
    const std::size_t point = _mixer.activeClip(_mixer.activeClipCount() - 1).point;
    _mixer.start(playbackOf(playback().clip()));
    if (space) _mixer.spread(space, point, _settings.parameter);
    _mixer.seek(0.0);
}

JointPose& AnimationLayer::pose()
{
    if (_pose) return *_pose;
    _pose = std::make_shared<JointPose>(_stack->set);
    _poseShare = Fade(_state == PlayState::Stopped ? 1.0 : 0.0);
    ++_changeCount;
    return *_pose;
}

bool AnimationLayer::showPose(double seconds, FadeCurve curve)
{
    if (!std::isfinite(seconds) || seconds < 0.0) return false;
    pose();
    fadePose(1.0, seconds, curve);
    advancePose(0.0);
    return true;
}

void AnimationLayer::fadePose(double share, double seconds, FadeCurve curve)
{
    if (_pose) _poseShare = Fade({_poseShare.value(), share, seconds, 0.0, curve});
    ++_changeCount;
}

/// The share of the step after which the pose's fade ended; none: it did not end.
std::optional<double> AnimationLayer::advancePose(double seconds)
{
    if (!_pose) return std::nullopt;
    if (_poseShare.state().to > 0.0 && clipShare() <= 0.0 && _state != PlayState::Stopped)
    {
        _mixer.clear();
        _state = PlayState::Stopped;
    }
    return _poseShare.advance(seconds);
}

bool AnimationLayer::seek(double seconds)
{
    if (std::isnan(seconds)) return false;
    if (_mixer.isEmpty()) return true;
    _mixer.seek(seconds);
    if (_state == PlayState::Ended && !playback().isAtEnd()) _state = PlayState::Playing;
    ++_changeCount;
    return true;
}

bool AnimationLayer::setSpeed(double speed)
{
    if (!std::isfinite(speed)) return false;
    _settings.speed = speed;
    _mixer.setSpeed(speed);
    return true;
}

Result<void> AnimationLayer::setGroundSpeed(double speed)
{
    if (!std::isfinite(speed)) return Error{"a ground speed of " + std::to_string(speed) + ": it must be finite"};
    if (_mixer.isEmpty()) return Error{"a ground speed for a layer that plays nothing"};
    const std::size_t clip = playback().clip();
    const ClipMixer::ActiveSpace* active = _mixer.currentSpace();
    const double measured =
        active ? active->space->groundSpeedAt(set(), active->parameter) : measureGroundSpeed(set(), clip);
    const double factor = measured > 0.0 ? speed / measured : HUGE_VAL;
    if (!std::isfinite(factor) && speed != 0.0)
        return Error{"a ground speed for clip \"" + set().clips()[clip].name() +
                     "\": its feet stand, so no speed fits; setSpeed() sets one"};
    setSpeed(std::isfinite(factor) ? factor : 1.0);
    return {};
}

void AnimationLayer::setLoopMode(LoopMode mode)
{
    _settings.loopMode = mode;
    _mixer.setLoopMode(mode);
    ++_changeCount;
}

bool AnimationLayer::fadeWeight(float weight, double seconds, FadeCurve curve)
{
    if (std::isnan(weight) || !std::isfinite(seconds) || seconds < 0.0) return false;
    const double target = std::clamp(static_cast<double>(weight), 0.0, 1.0);
    _weight = Fade({_weight.value(), target, seconds, 0.0, curve});
    ++_changeCount;
    return true;
}

Result<void> AnimationLayer::setMask(const JointMask& mask)
{
    const Result<std::shared_ptr<const SetMask>> used = set().useMask(mask.weights());
    if (!used) return used.error();
    _mask = used.value();
    ++_changeCount;
    return {};
}

void AnimationLayer::clearMask()
{
    _mask = nullptr;
    ++_changeCount;
}

void AnimationLayer::setMode(Mode mode, Reference reference)
{
    _settings.mode = mode;
    _settings.reference = reference;
    ++_changeCount;
}

void AnimationLayer::setBlendPriority(int blendPriority)
{
    _settings.blendPriority = blendPriority;
    ++_changeCount;
}

void AnimationLayer::advance(double seconds)
{
    const bool isPaused = _state == PlayState::Paused; // fades stand still: their means are their values
    if (isPaused && _pose) _poseShare.advance(0.0);
    _crossfadeMoment = isPaused ? std::nullopt : advancePose(seconds);
    _weightFadeMoment = _weight.advance(isPaused ? 0.0 : seconds);
    if (_state != PlayState::Playing && _state != PlayState::Ended) return _mixer.clearSteps();
    _crossfadeMoment = std::max(_crossfadeMoment, _mixer.advance(seconds, _state == PlayState::Playing));
    if (_mixer.activeClip(_mixer.activeClipCount() - 1).move.hasFinished) _state = PlayState::Ended;
}

/// The mask in the control of a blend sample.
std::uint32_t AnimationLayer::maskBits() const
{
    return _mask ? _mask->number << POSE_SAMPLE_MASK_SHIFT : 0;
}

BlendSample AnimationLayer::sampleOf(const ClipPlayback& playback, double time, double share) const
{
    BlendSample sample = set().sampleAt(playback.clip(), time);
    sample.weight = static_cast<float>(share * clipShare() * _weight.value());
    sample.control |= maskBits();
    return sample;
}

void AnimationLayer::collect(BlendList& out) const
{
    if (_pose && _poseShare.value() > 0.0 && _weight.value() > 0.0)
    {
        const auto weight = static_cast<float>(_poseShare.value() * _weight.value());
        const BlendSample sample{out.addPose(_pose), 0.0f, weight, maskBits() | POSE_SAMPLE_POSED};
        if (_settings.mode == Mode::Override)
            out.add(sample, _settings.blendPriority);
        else
            out.addDifference(BlendSample{0, 0.0f, weight, maskBits()}, sample);
    }
    if (_state == PlayState::Stopped) return;
    for (std::size_t v = 0; v < _mixer.activeClipCount(); ++v)
    {
        const ClipMixer::ActiveClip& activeClip = _mixer.activeClip(v);
        if (!(activeClip.share > 0.0)) continue;
        const BlendSample sample = sampleOf(activeClip.playback, activeClip.playback.shownTime(), activeClip.share);
        if (_settings.mode == Mode::Override)
            out.add(sample, _settings.blendPriority);
        else if (_settings.reference == Reference::FirstFrame)
            out.addDifference(sampleOf(activeClip.playback, 0.0, activeClip.share), sample);
        else
            out.addDifference(BlendSample{0, 0.0f, sample.weight, maskBits()}, sample);
    }
}

/// usual: the curve of any clip of the set. A clip without root motion contributes a motion of 0 at the joint of this
/// curve, with its weight.
void AnimationLayer::collectMotion(RootMotionBlend& out, const RootMotionCurve& usual) const
{
    const double layerWeight = _weight.mean();
    const auto masked = [&](std::size_t joint) { return layerWeight * (_mask ? _mask->weights[joint] : 1.0); };
    // A pose that sets the joint's translation holds the character in place.
    const std::vector<PoseExtent::Joint>* posed = _pose ? &_pose->extent()->joints : nullptr;
    if (posed && _settings.mode == Mode::Override && usual.joint < posed->size() && (*posed)[usual.joint].moves)
        out.add({glm::dvec3(0.0), 0.0, usual.up}, _poseShare.mean() * masked(usual.joint), _settings.blendPriority);
    if (_state == PlayState::Stopped || _settings.mode == Mode::Additive) return;
    const double clipShare = _pose ? 1.0 - _poseShare.mean() : 1.0;
    for (std::size_t v = 0; v < _mixer.activeClipCount(); ++v)
    {
        const ClipMixer::ActiveClip& activeClip = _mixer.activeClip(v);
        const Clip& clip = set().clips()[activeClip.playback.clip()];
        const RootMotionCurve& curve = clip.rootMotion() ? *clip.rootMotion() : usual;
        out.add(clip.rootMotion() ? rootMotionOf(clip, activeClip.move, activeClip.playback.loopMode())
                                  : RootMotion{glm::dvec3(0.0), 0.0, curve.up},
                clipShare * activeClip.meanShare * masked(curve.joint), _settings.blendPriority);
    }
}

LayerStep AnimationLayer::lastStep() const
{
    return {_index, _mixer, _crossfadeMoment, _weightFadeMoment};
}

} // namespace osgGpuAnimation
