// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/animation/Fade.h>

#include <algorithm>

namespace osgGpuAnimation
{

Fade::Fade(double from, double to, double seconds, FadeCurve curve)
    : _from(from), _to(to), _value(seconds > 0.0 ? from : to), _seconds(std::max(seconds, 0.0)), _curve(curve)
{
}

double Fade::advance(double seconds)
{
    if (isFinished() || !(seconds > 0.0)) return -1.0;
    const double missing = _seconds - _elapsed;
    _elapsed += seconds;
    if (_elapsed >= _seconds)
    {
        _value = _to;
        return std::clamp(missing / seconds, 0.0, 1.0);
    }
    const double x = _elapsed / _seconds;
    _value = _from + (_to - _from) * (_curve == FadeCurve::Smooth ? x * x * (3.0 - 2.0 * x) : x);
    return -1.0;
}

} // namespace osgGpuAnimation
