// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/ClipMixer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace osgGpuAnimation
{

namespace
{

/// A share below this is invisible.
constexpr double negligible = 1.0 / 4096.0;

double finiteProduct(double a, double b)
{
    constexpr double max = std::numeric_limits<double>::max();
    return std::clamp(a * b, -max, max);
}

/// The phase of a blend space at the time of one of its clips.
double phaseIn(const BlendSpace::Point& point, const ClipPlayback& playback)
{
    return playback.loopMode() == LoopMode::Loop ? point.phaseAt(playback.time()) : playback.normalizedTime();
}

/// The step of a clip of a looping blend space. rounds: new rounds of the phase. seconds: of the blend space.
PlaybackStep loopStep(const BlendSpace::Point& point, const ClipMixer::ActiveSpace& before, double phase, double rounds,
                      double seconds)
{
    PlaybackStep step;
    step.includesStart = before.isFresh;
    step.isAscending = seconds >= 0.0;
    step.distance = seconds;
    const double duration = point.duration();
    if (!(duration > 0.0)) return step;
    const double from = point.timeAt(before.phase), to = point.timeAt(phase);
    step.from = ClipPlayback::wrapped(from, duration);
    step.to = ClipPlayback::wrapped(to, duration);
    step.crossings = rounds + std::round((to - step.to) / duration) - std::round((from - step.from) / duration);
    if (before.isFresh && seconds < 0.0 && step.from == 0.0) // a new clip that plays backwards starts at its end
    {
        step.from = duration;
        step.crossings += 1.0;
    }
    if (seconds != 0.0) step.distance = finiteProduct(step.to - step.from + step.crossings * duration, 1.0);
    return step;
}

} // namespace

void ClipMixer::clear()
{
    _leaving.clear();
    _spaces.clear();
    _current = ActiveClip();
}

void ClipMixer::start(const ClipPlayback& playback)
{
    clear();
    _current.playback = playback;
    _current.phaseGroup = ++_lastPhaseGroup;
    _fade = Fade(1.0);
}

void ClipMixer::restore(const std::vector<ActiveClip>& activeClips, const Fade& fade, std::vector<ActiveSpace> spaces)
{
    clear();
    _fade = fade;
    _lastPhaseGroup = 0;
    _lastSpace = -1;
    if (activeClips.empty()) return;
    const auto last = activeClips.begin() + std::min(activeClips.size(), maxActiveClips) - 1;
    _leaving.assign(activeClips.begin(), last);
    _current = *last;
    _spaces = std::move(spaces);
    clearSteps();
    for (std::size_t i = 0; i < activeClipCount(); ++i)
        _lastPhaseGroup = std::max(_lastPhaseGroup, activeClip(i).phaseGroup);
    for (const ActiveSpace& space : _spaces)
        _lastSpace = std::max(_lastSpace, space.number);
    removeUnusedSpaces();
}

void ClipMixer::fadeTo(const ClipPlayback& playback, double seconds, FadeCurve curve, bool sharesPhase)
{
    removeFaded();
    if (activeClipCount() == maxActiveClips) dropLightest(maxActiveClips);
    const int group = sharesPhase && !isEmpty() ? _current.phaseGroup : ++_lastPhaseGroup;
    if (!isEmpty()) _leaving.push_back(_current);
    for (ActiveClip& before : _leaving)
        before.shareBefore = before.share;
    _current = ActiveClip();
    _current.playback = playback;
    _current.share = 0.0;
    _current.phaseGroup = group;
    _fade = Fade({0.0, 1.0, seconds, 0.0, curve});
}

void ClipMixer::spread(std::shared_ptr<const BlendSpace> space, std::size_t point, const glm::dvec2& parameter)
{
    ActiveSpace active;
    active.phase = phaseIn(space->points()[point], _current.playback);
    active.isReturning = _current.playback.isReturning();
    active.space = std::move(space);
    active.number = _current.space = ++_lastSpace;
    _spaces.push_back(std::move(active));
    setParameter(parameter);
}

void ClipMixer::setParameter(const glm::dvec2& parameter)
{
    ActiveSpace* space = ownSpace();
    if (!space) return;
    space->parameter = parameter;
    const auto isOfSpace = [&](const ActiveClip& activeClip) { return activeClip.space == _current.space; };
    _leaving.erase(std::remove_if(_leaving.begin(), _leaving.end(), isOfSpace), _leaving.end());
    const BlendSpace::Mix mix = space->space->mixAt(parameter);
    while (_leaving.size() + mix.count > maxActiveClips)
        dropLightest(_leaving.size());
    ActiveClip activeClip = _current;
    activeClip.move = PlaybackStep();
    activeClip.shareBefore = 0.0;
    for (std::size_t i = 0; i < mix.count; ++i)
    {
        const BlendSpace::Point& point = space->space->points()[mix.weights[i].point];
        activeClip.playback = ClipPlayback(static_cast<int>(point.clip), point.duration(), _current.playback.speed(),
                                           _current.playback.loopMode());
        activeClip.point = mix.weights[i].point;
        activeClip.weight = mix.weights[i].weight;
        activeClip.share = activeClip.meanShare = _fade.value() * activeClip.weight;
        if (i + 1 < mix.count)
            _leaving.push_back(activeClip);
        else
            _current = activeClip;
    }
    placeClips(*space);
}

double ClipMixer::phaseFor(int clip) const
{
    for (const ActiveClip& activeClip : _leaving)
        if (isCurrent(activeClip) && activeClip.playback.clip() == clip) return activeClip.playback.phase();
    return _current.playback.phase();
}

void ClipMixer::seek(double seconds)
{
    _current.playback.seek(seconds);
    ActiveSpace* space = ownSpace();
    if (!space) return;
    space->phase = phaseIn(space->space->points()[_current.point], _current.playback);
    space->isFresh = true;
    placeClips(*space);
}

void ClipMixer::setSpeed(double speed)
{
    for (std::size_t i = 0; i < activeClipCount(); ++i)
        if (isCurrent(at(i))) at(i).playback.setSpeed(speed);
}

void ClipMixer::setLoopMode(LoopMode mode)
{
    const bool isNew = mode != _current.playback.loopMode();
    for (std::size_t i = 0; i < activeClipCount(); ++i)
        if (isCurrent(at(i))) at(i).playback.setLoopMode(mode);
    ActiveSpace* space = ownSpace();
    if (!space || !isNew) return;
    space->isReturning = false;
    space->phase = phaseIn(space->space->points()[_current.point], _current.playback);
    placeClips(*space);
}

ClipMixer::ActiveSpace* ClipMixer::ownSpace()
{
    for (ActiveSpace& space : _spaces)
        if (space.number == _current.space) return &space;
    return nullptr;
}

void ClipMixer::remove(std::size_t index)
{
    if (index == _leaving.size()) _current = _leaving[--index];
    _leaving.erase(_leaving.begin() + index);
}

void ClipMixer::removeFaded()
{
    if (_leaving.empty()) return; // the current blend space has one clip or there is none
    for (std::size_t i = _leaving.size(); i-- > 0;)
        if (!isCurrent(_leaving[i]) && (_fade.isFinished() || _leaving[i].share < negligible)) remove(i);
    if (!_spaces.empty()) removeUnusedSpaces();
}

void ClipMixer::removeUnusedSpaces()
{
    const auto isUnused = [&](const ActiveSpace& space)
    {
        return space.number != _current.space &&
               std::none_of(_leaving.begin(), _leaving.end(),
                            [&](const ActiveClip& activeClip) { return activeClip.space == space.number; });
    };
    _spaces.erase(std::remove_if(_spaces.begin(), _spaces.end(), isUnused), _spaces.end());
}

/// Removes the one of the first active clips with the smallest share; the others of them take it over.
void ClipMixer::dropLightest(std::size_t candidates)
{
    std::size_t min = 0;
    double whole = 0.0;
    for (std::size_t i = 0; i < candidates; ++i)
    {
        whole += at(i).share;
        if (at(i).share < at(min).share) min = i;
    }
    const double left = whole - at(min).share;
    remove(min);
    for (std::size_t i = 0; i + 1 < candidates && left > 0.0; ++i)
    {
        at(i).share *= whole / left;
        at(i).shareBefore *= whole / left;
    }
}

std::optional<double> ClipMixer::advance(double seconds, bool isCurrentPlaying)
{
    removeFaded();
    const std::optional<double> moment = _fade.advance(seconds);
    if (moment || isFading())
    {
        for (std::size_t i = 0; i < activeClipCount(); ++i)
        {
            ActiveClip& clip = at(i);
            const bool isComing = isCurrent(clip);
            clip.share = isComing ? clip.weight * _fade.value() : clip.shareBefore * (1.0 - _fade.value());
            clip.meanShare = isComing ? clip.weight * _fade.mean() : clip.shareBefore * (1.0 - _fade.mean());
        }
    }
    else
        for (std::size_t i = 0; i < activeClipCount(); ++i)
            at(i).meanShare = at(i).share;
    for (ActiveClip& activeClip : _leaving)
        if (activeClip.space < 0) activeClip.move = activeClip.playback.move(clipSeconds(activeClip, seconds));
    if (_current.space < 0)
        _current.move = isCurrentPlaying ? _current.playback.move(clipSeconds(_current, seconds)) : PlaybackStep();
    for (ActiveSpace& space : _spaces)
        moveSpace(space, seconds, isCurrentPlaying || space.number != _current.space);
    return moment;
}

/// For a step in which nothing moves: the shares are constant.
void ClipMixer::clearSteps()
{
    for (std::size_t i = 0; i < activeClipCount(); ++i)
    {
        at(i).move = PlaybackStep();
        at(i).meanShare = at(i).share;
    }
}

double ClipMixer::clipSeconds(const ActiveClip& activeClip, double seconds) const
{
    if (_leaving.empty() && !_roundsPerSecond) return finiteProduct(seconds, activeClip.playback.speed());
    return groupSeconds(activeClip, activeClip.playback.roundSeconds(), seconds);
}

/// Seconds on the time line of something in the active clip's phase group that has a round of its own. Clips without a
/// duration follow the others.
double ClipMixer::groupSeconds(const ActiveClip& activeClip, double ownRound, double seconds) const
{
    if (_roundsPerSecond && activeClip.phaseGroup == _current.phaseGroup)
        return finiteProduct(seconds, *_roundsPerSecond * ownRound);
    double speed = activeClip.playback.speed();
    double members = 0.0, share = 0.0, round = 0.0;
    for (std::size_t i = 0; !_leaving.empty() && i < activeClipCount(); ++i)
    {
        const ActiveClip& other = this->activeClip(i);
        if (other.phaseGroup != activeClip.phaseGroup) continue;
        members += 1.0;
        share += other.playback.duration() > 0.0 ? other.meanShare : 0.0;
        round += other.meanShare * other.playback.roundSeconds();
        speed = other.playback.speed(); // the newest member decides
    }
    if (members > 1.0 && round > 0.0)
        speed *= ownRound * share / round;
    else if (members > 1.0)
        speed = activeClip.playback.speed();
    return finiteProduct(seconds, speed);
}

double ClipMixer::meanRoundSeconds() const
{
    double share = 0.0, round = 0.0;
    for (std::size_t i = 0; i < activeClipCount(); ++i)
    {
        const ActiveClip& other = activeClip(i);
        if (other.phaseGroup != _current.phaseGroup || !(other.playback.duration() > 0.0)) continue;
        // A clip that starts to fade in counts as if it were visible.
        const double counted = std::max(other.share, negligible);
        share += counted;
        round += counted * other.playback.roundSeconds();
    }
    return share > 0.0 ? round / share : 0.0;
}

/// The time line of a blend space in LoopMode::Loop: stretches between sync markers, each with the mean duration of the
/// clips by weight.
class ClipMixer::SpaceRound
{
public:
    SpaceRound(const ClipMixer& mixer, const ActiveSpace& space)
        : _stretchCount(space.space->points().front().stops.size() - 1)
    {
        for (std::size_t i = 0; i < mixer.activeClipCount(); ++i)
        {
            const ActiveClip& activeClip = mixer.activeClip(i);
            if (activeClip.space != space.number) continue;
            const BlendSpace::Point& point = space.space->points()[activeClip.point];
            _newest = &activeClip;
            if (!(point.duration() > 0.0)) continue;
            _weights[_count] = activeClip.weight;
            _points[_count++] = &point;
        }
        const double whole = _weights[0] + _weights[1] + _weights[2];
        for (std::size_t i = 0; i < _count; ++i)
        {
            _weights[i] /= whole;
            _seconds += _weights[i] * _points[i]->duration();
        }
    }

    const ActiveClip& newest() const { return *_newest; }
    double seconds() const { return _seconds; } ///< of a round; 0: all clips are poses

    /// Moves a phase; returns the number of new rounds.
    double move(double& phase, double seconds) const
    {
        if (!(_seconds > 0.0)) return 0.0;
        const double unrolled = secondsAt(phase) + seconds;
        double rest = ClipPlayback::wrapped(unrolled, _seconds);
        const double rounds = std::round((unrolled - rest) / _seconds);
        std::size_t stretch = 0;
        for (; stretch + 1 < _stretchCount && rest >= stretchSeconds(stretch); ++stretch)
            rest -= stretchSeconds(stretch);
        const double length = stretchSeconds(stretch);
        const double share = length > 0.0 ? std::min(rest / length, 1.0) : 0.0;
        phase = (static_cast<double>(stretch) + share) / static_cast<double>(_stretchCount);
        return rounds;
    }

private:
    double stretchSeconds(std::size_t stretch) const
    {
        double seconds = 0.0;
        for (std::size_t i = 0; i < _count; ++i)
            seconds += _weights[i] * (_points[i]->stops[stretch + 1] - _points[i]->stops[stretch]);
        return seconds;
    }
    double secondsAt(double phase) const
    {
        double seconds = 0.0;
        for (std::size_t i = 0; i < _count; ++i)
            seconds += _weights[i] * (_points[i]->timeAt(phase) - _points[i]->stops.front());
        return seconds;
    }

    std::size_t _stretchCount, _count = 0;
    const ActiveClip* _newest = nullptr;
    std::array<const BlendSpace::Point*, 3> _points{};
    std::array<double, 3> _weights{};
    double _seconds = 0.0;
};

void ClipMixer::moveSpace(ActiveSpace& space, double seconds, bool isMoving)
{
    const SpaceRound round(*this, space);
    const ClipPlayback& newest = round.newest().playback;
    const double roundSeconds = round.seconds() * (newest.loopMode() == LoopMode::PingPong ? 2.0 : 1.0);
    const double own = isMoving ? groupSeconds(round.newest(), roundSeconds, seconds) : 0.0;
    const ActiveSpace before = space;
    double rounds = 0.0;
    PlaybackStep turn;
    if (newest.loopMode() == LoopMode::Loop)
    {
        rounds = round.move(space.phase, own);
        space.isFresh = space.isFresh && own == 0.0;
    }
    else if (isMoving)
    {
        ClipPlayback whole(0, round.seconds(), newest.speed(), newest.loopMode());
        whole.restore(space.phase * round.seconds(), space.isReturning, space.isFresh);
        turn = whole.move(own);
        space.phase = whole.normalizedTime();
        space.isReturning = whole.isReturning();
        space.isFresh = whole.isFresh();
    }
    for (std::size_t i = 0; i < activeClipCount(); ++i)
    {
        if (at(i).space != space.number) continue;
        const BlendSpace::Point& point = space.space->points()[at(i).point];
        PlaybackStep& move = at(i).move = turn;
        if (newest.loopMode() == LoopMode::Loop)
        {
            if (isMoving) move = loopStep(point, before, space.phase, rounds, own);
            continue;
        }
        const double factor = round.seconds() > 0.0 ? point.duration() / round.seconds() : 0.0;
        move.from *= factor;
        move.to *= factor;
        move.distance = finiteProduct(move.distance, factor);
    }
    placeClips(space);
}

void ClipMixer::placeClips(const ActiveSpace& space)
{
    for (std::size_t i = 0; i < activeClipCount(); ++i)
    {
        ActiveClip& activeClip = at(i);
        if (activeClip.space != space.number) continue;
        const BlendSpace::Point& point = space.space->points()[activeClip.point];
        double time = point.duration() * space.phase;
        if (activeClip.playback.loopMode() == LoopMode::Loop && point.duration() > 0.0)
            time = ClipPlayback::wrapped(point.timeAt(space.phase), point.duration());
        activeClip.playback.restore(time, space.isReturning, space.isFresh);
    }
}

} // namespace osgGpuAnimation
