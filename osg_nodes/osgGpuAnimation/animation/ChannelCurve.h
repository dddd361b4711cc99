// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/ClipBuilder.h>

#include <cstddef>
#include <vector>

namespace osgGpuAnimation
{

/// Where a clip's keyframe stands. At a jump two keyframes have one time, and the earlier one is `before` it.
struct Moment
{
    double time = 0.0; ///< seconds; holds a float
    bool before = false;
};

/// A checked channel as a function of time, in double precision (glTF 2.0, appendix C). Ask for moments in ascending
/// order: it moves a cursor along the keys.
class ChannelCurve
{
public:
    /// componentCount: numbers a value. The channel must outlive the curve.
    ChannelCurve(const Channel& channel, std::size_t componentCount);

    const Channel& channel() const { return _channel; }
    std::size_t componentCount() const { return _componentCount; }

    /// True for what the Hermite form stands for by itself; false for rotations that are slerped or held.
    bool isSplineRotation() const;

    /// out gets componentCount() numbers. Before the first key the first value, after the last the last.
    /// Rotations of STEP and LINEAR are unit, those of CUBICSPLINE the spline's own numbers.
    void value(const Moment& at, double* out);

    /// The Hermite tangents of the piece from one moment to a later one, no key being between: derivatives at its ends
    /// times its length. outFirst, outLast get componentCount() numbers each; zero for slerped rotations.
    void tangents(const Moment& from, const Moment& to, double* outFirst, double* outLast);

    /// Appends the times of the keys at which the value jumps (STEP, the value being another than before).
    void appendJumps(std::vector<double>& out) const;

    /// Appends, for each slerp of very nearly 180 degrees in which none of the (ascending) times lies, the time of its
    /// middle: rounding its ends to floats could turn it round.
    void appendMiddlesOfHalfTurns(const std::vector<double>& times, std::vector<double>& out) const;

private:
    const double* valueOfKey(std::size_t key) const;
    std::size_t keyAt(const Moment& at);
    bool isHeldAt(std::size_t key, double time) const;
    void hermite(std::size_t key, double alpha, double* out) const;
    void hermiteSlope(std::size_t key, double alpha, double factor, double* out) const;

    const Channel& _channel;
    std::size_t _componentCount;
    std::size_t _valuesPerKey;
    std::size_t _cursor = 0;
};

} // namespace osgGpuAnimation
