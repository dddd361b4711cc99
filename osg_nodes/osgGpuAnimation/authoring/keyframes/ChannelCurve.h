// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Channel.h>

#include <cstddef>
#include <vector>

namespace osgGpuAnimation
{

/// The time of a clip's keyframe. At a jump two keyframes have the same time; the first of them is `before` the jump.
struct Moment
{
    double time = 0.0; ///< seconds; a value that fits a float
    bool before = false;
};

/// A channel that ClipBuilder has checked, as a function of time in double precision (glTF 2.0, appendix C). It keeps a
/// cursor into the keys, so ascending moments are fast.
class ChannelCurve
{
public:
    /// componentCount: numbers per value. The channel must outlive the curve.
    ChannelCurve(const Channel& channel, std::size_t componentCount);

    const Channel& channel() const { return _channel; }
    std::size_t componentCount() const { return _componentCount; }

    /// True for CUBICSPLINE rotations, which are not unit; false for rotations that are slerped or stepped.
    bool isSplineRotation() const;

    /// out: componentCount() numbers. Before the first key it is the first value, after the last key the last value.
    /// STEP and LINEAR rotations are unit; CUBICSPLINE rotations are not normalized.
    void value(const Moment& at, double* out);

    /// The Hermite tangents of the piece between two moments without a key between them: the derivatives at its ends,
    /// multiplied by its length. outFirst, outLast: componentCount() numbers each; 0 for slerped rotations.
    void tangents(const Moment& from, const Moment& to, double* outFirst, double* outLast);

    /// Appends the times of the keys at which the value jumps: STEP keys with a new value.
    void appendJumps(std::vector<double>& out) const;

    /// For each slerp of almost 180 degrees that contains none of the times, appends the time of its middle: the
    /// rounding of its ends to floats could reverse its direction. times: ascending.
    void appendMiddlesOfHalfTurns(const std::vector<double>& times, std::vector<double>& out) const;

private:
    const double* valueOfKey(std::size_t key) const;
    std::size_t keyAt(const Moment& at);
    bool isHeldAt(std::size_t key, double time) const;
    void spline(std::size_t key, double alpha, double* out) const;
    void splineSlope(std::size_t key, double alpha, double factor, double* out) const;

    const Channel& _channel;
    std::size_t _componentCount;
    std::size_t _valuesPerKey;
    std::size_t _cursor = 0;
};

} // namespace osgGpuAnimation
