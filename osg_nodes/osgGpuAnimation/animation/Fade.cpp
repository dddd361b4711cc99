// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/Fade.h>

#include <algorithm>

namespace osgGpuAnimation
{

namespace
{

double progress(FadeCurve curve, double x)
{
    return curve == FadeCurve::Smooth ? x * x * (3.0 - 2.0 * x) : x;
}

/// The mean of progress() between two values of x in [0, 1].
double meanProgress(FadeCurve curve, double from, double to)
{
    const double sum = from + to, squares = from * from + to * to;
    // The differences of the integrals x²/2 and x³ - x⁴/2, divided by to - from.
    return curve == FadeCurve::Smooth ? squares + from * to - 0.5 * sum * squares : 0.5 * sum;
}

} // namespace

Fade::Fade(const State& state)
    : _state{state.from, state.to, std::max(state.seconds, 0.0), 0.0, state.curve},
      _value(state.seconds > 0.0 ? state.from : state.to), _mean(_value)
{
    advance(state.elapsed);
}

std::optional<double> Fade::advance(double seconds)
{
    _mean = _value;
    if (isFinished() || !(seconds > 0.0)) return std::nullopt;
    const auto& [from, to, duration, elapsed, curve] = _state;
    const double missing = duration - elapsed;
    const double before = elapsed / duration;
    _state.elapsed += seconds;
    if (isFinished())
    {
        const double moment = std::clamp(missing / seconds, 0.0, 1.0);
        _value = to;
        _mean = from + (to - from) * (1.0 - moment + moment * meanProgress(curve, before, 1.0));
        return moment;
    }
    const double now = elapsed / duration;
    _value = from + (to - from) * progress(curve, now);
    _mean = from + (to - from) * meanProgress(curve, before, now);
    return std::nullopt;
}

} // namespace osgGpuAnimation
