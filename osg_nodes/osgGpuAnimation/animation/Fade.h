// SPDX-License-Identifier: MIT
#pragma once

namespace osgGpuAnimation
{

/// How a weight goes from one value to another.
enum class FadeCurve
{
    Linear, ///< the same change at every moment: the least possible step a frame
    Smooth, ///< begins and ends gently (3x² - 2x³); in its middle half as fast again as Linear
};

/// A value on its way to another.
class Fade
{
public:
    explicit Fade(double value) : _from(value), _to(value) {}
    /// seconds: finite; 0 or less is there at once.
    Fade(double from, double to, double seconds, FadeCurve curve);

    double value() const { return _value; }
    double mean() const { return _mean; } ///< over the seconds of the last advance()
    double origin() const { return _from; }
    double target() const { return _to; }
    double seconds() const { return _seconds; }
    double elapsed() const { return _elapsed; } ///< seconds; beyond seconds() where it has arrived
    FadeCurve curve() const { return _curve; }
    bool isFinished() const { return _elapsed >= _seconds; }
    /// Moves on (seconds below 0 count as 0). Returns which share of the seconds it took to arrive, in [0, 1]; -1 where
    /// it did not arrive or had before.
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
