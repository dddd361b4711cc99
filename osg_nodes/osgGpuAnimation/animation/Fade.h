// SPDX-License-Identifier: MIT
#pragma once

namespace osgGpuAnimation
{

/// The progress of a fade over its time x in [0, 1].
enum class FadeCurve
{
    Linear, ///< constant speed
    Smooth, ///< 3x² - 2x³: slow at both ends, up to 1.5 times the speed of Linear in the middle
};

/// A value that moves from one number to another over some seconds.
class Fade
{
public:
    explicit Fade(double value) : _from(value), _to(value) {}
    /// seconds: finite; at 0 or less the value is the target at once.
    Fade(double from, double to, double seconds, FadeCurve curve);

    double value() const { return _value; }
    double mean() const { return _mean; } ///< mean value during the last advance()
    double origin() const { return _from; }
    double target() const { return _to; }
    double seconds() const { return _seconds; }
    double elapsed() const { return _elapsed; } ///< seconds; at least seconds() once the fade has finished
    FadeCurve curve() const { return _curve; }
    bool isFinished() const { return _elapsed >= _seconds; }
    /// Moves the value on; seconds below 0 count as 0. Returns the share of the seconds after which the fade finished,
    /// in [0, 1]; -1 if it did not finish in this step.
    double advance(double seconds);

private:
    double _from, _to;
    double _value = _to;
    double _mean = _value;
    double _elapsed = 0.0;
    double _seconds = 0.0;
    FadeCurve _curve = FadeCurve::Linear;
};

} // namespace osgGpuAnimation
