// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

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
    /// Everything that a fade needs to continue.
    struct State
    {
        double from = 1.0,                   ///< value at the start
            to = 1.0;                        ///< value at the end
        double seconds = 0.0;                ///< duration of the fade; at 0 or less the value is the target at once
        double elapsed = 0.0;                ///< seconds; at least the duration once the fade has finished
        FadeCurve curve = FadeCurve::Linear; ///< progress over time
    };

    explicit Fade(double value) : Fade(State{value, value}) {} ///< A finished fade at a constant value.
    explicit Fade(const State& state);                         ///< state: finite numbers

    double value() const { return _value; }                              ///< the current value
    double mean() const { return _mean; }                                ///< mean value during the last advance()
    const State& state() const { return _state; }                        ///< to store the fade
    bool isFinished() const { return _state.elapsed >= _state.seconds; } ///< true if the target is reached
    /// Advances the time of the fade; seconds below 0 and NaN count as 0. Returns the share of the seconds after which
    /// the fade finished, in [0, 1]; none if it did not finish in this step.
    std::optional<double> advance(double seconds);

private:
    State _state;
    double _value, _mean;
};

} // namespace osgGpuAnimation
