// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/Playback.h>

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

Fade::Fade(double from, double to, double seconds, FadeCurve curve)
    : _from(from), _to(to), _value(seconds > 0.0 ? from : to), _seconds(std::max(seconds, 0.0)), _curve(curve)
{
}

double Fade::advance(double seconds)
{
    _mean = _value;
    if (isFinished() || !(seconds > 0.0)) return -1.0;
    const double missing = _seconds - _elapsed;
    const double before = _elapsed / _seconds;
    _elapsed += seconds;
    if (_elapsed >= _seconds)
    {
        const double moment = std::clamp(missing / seconds, 0.0, 1.0);
        _value = _to;
        _mean = _from + (_to - _from) * (1.0 - moment + moment * meanProgress(_curve, before, 1.0));
        return moment;
    }
    const double now = _elapsed / _seconds;
    _value = _from + (_to - _from) * progress(_curve, now);
    _mean = _from + (_to - _from) * meanProgress(_curve, before, now);
    return -1.0;
}

} // namespace osgGpuAnimation
