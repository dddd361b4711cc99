// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/authoring/ClipBuilder.h>
#include <osgGpuAnimation/math/Hermite.h>

#include <glm/mat4x4.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace osgGpuAnimation::reference
{

/// Evaluates a channel by glTF 2.0 (section 3.11, appendix C), in double precision and directly from its keys: the
/// reference for clips. It shares no code with them; only the Channel struct, its input.

using Numbers = std::vector<double>;

inline Numbers keyValue(const Channel& channel, std::size_t width, std::size_t key, int part)
{
    const bool cubic = channel.interpolation == Channel::Interpolation::CubicSpline;
    const std::size_t first = (cubic ? key * 3 + static_cast<std::size_t>(part) : key) * width;
    return Numbers(channel.values.begin() + static_cast<std::ptrdiff_t>(first),
                   channel.values.begin() + static_cast<std::ptrdiff_t>(first + width));
}

inline Numbers normalized(Numbers q)
{
    double squared = 0.0;
    for (double c : q)
        squared += c * c;
    for (double& c : q)
        c /= std::sqrt(squared);
    return q;
}

/// Appendix C.4, with its acos.
inline Numbers slerp(const Numbers& from, const Numbers& to, double t)
{
    double dot = 0.0;
    for (std::size_t c = 0; c < 4; ++c)
        dot += from[c] * to[c];
    const double angle = std::acos(std::min(1.0, std::abs(dot)));
    const double sign = dot < 0.0 ? -1.0 : 1.0;
    const double a = angle < 1e-7 ? 1.0 - t : std::sin((1.0 - t) * angle) / std::sin(angle);
    const double b = angle < 1e-7 ? t : std::sin(t * angle) / std::sin(angle);
    Numbers result(4);
    for (std::size_t c = 0; c < 4; ++c)
        result[c] = a * from[c] + sign * b * to[c];
    return normalized(result);
}

inline Numbers hermite(const Channel& channel, std::size_t width, std::size_t key, double t, double length)
{
    const Numbers v0 = keyValue(channel, width, key, 1), out0 = keyValue(channel, width, key, 2);
    const Numbers v1 = keyValue(channel, width, key + 1, 1), in1 = keyValue(channel, width, key + 1, 0);
    Numbers result(width);
    for (std::size_t c = 0; c < width; ++c)
        result[c] = (2 * t * t * t - 3 * t * t + 1) * v0[c] + length * (t * t * t - 2 * t * t + t) * out0[c] +
                    (-2 * t * t * t + 3 * t * t) * v1[c] + length * (t * t * t - t * t) * in1[c];
    return result;
}

/// The value at that time, `width` numbers; rotations are normalized.
inline Numbers evaluate(const Channel& channel, std::size_t width, double time)
{
    using Interpolation = Channel::Interpolation;
    const bool rotation = channel.path == Channel::Path::Rotation;
    const std::vector<double>& times = channel.times;
    const auto finished = [rotation](Numbers v) { return rotation ? normalized(std::move(v)) : v; };
    if (time <= times.front()) return finished(keyValue(channel, width, 0, 1));
    if (time >= times.back()) return finished(keyValue(channel, width, times.size() - 1, 1));

    std::size_t key = 0;
    while (times[key + 1] <= time)
        ++key;
    const double length = times[key + 1] - times[key];
    const double t = (time - times[key]) / length;
    if (channel.interpolation == Interpolation::CubicSpline) return finished(hermite(channel, width, key, t, length));
    const Numbers from = keyValue(channel, width, key, 1);
    if (channel.interpolation == Interpolation::Step) return finished(from);

    const Numbers to = keyValue(channel, width, key + 1, 1);
    if (rotation) return slerp(normalized(from), normalized(to), t);
    Numbers result(width);
    for (std::size_t c = 0; c < width; ++c)
        result[c] = from[c] + t * (to[c] - from[c]);
    return result;
}

/// T · R · S, section 3.5.3; the quaternion is unit.
inline glm::dmat4 localMatrix(const Numbers& t, const Numbers& q, const Numbers& s)
{
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    glm::dmat4 m(1.0);
    m[0] = s[0] * glm::dvec4(1 - 2 * y * y - 2 * z * z, 2 * x * y + 2 * w * z, 2 * x * z - 2 * w * y, 0);
    m[1] = s[1] * glm::dvec4(2 * x * y - 2 * w * z, 1 - 2 * x * x - 2 * z * z, 2 * y * z + 2 * w * x, 0);
    m[2] = s[2] * glm::dvec4(2 * x * z + 2 * w * y, 2 * y * z - 2 * w * x, 1 - 2 * x * x - 2 * y * y, 0);
    m[3] = glm::dvec4(t[0], t[1], t[2], 1);
    return m;
}

/// Evaluates a PoseInstruction in double precision, directly from the set's keyframes: the reference for the mix stage
/// and its CPU twin. It shares no code with them.

/// The numbers of one track: three of translation, four of rotation, three of scale; a weight block has all twelve.
struct Track
{
    glm::dvec4 translation{0.0}, rotation{0.0}, scale{0.0};
};

struct BlendedPose
{
    std::vector<Track> tracks;
    /// The smallest margin of any choice of the shorter rotation: below about 1e-5 single precision may choose the
    /// other one.
    double closestDecision = 1.0;

    /// The palette entries of joints; entries of weight blocks hold the weights.
    std::vector<glm::dmat4> palette(const AnimationSet& set) const;
};

BlendedPose blend(const AnimationSet& set, const PoseInstruction& instruction);

} // namespace osgGpuAnimation::reference
