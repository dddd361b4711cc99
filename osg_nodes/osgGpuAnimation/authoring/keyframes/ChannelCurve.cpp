// SPDX-License-Identifier: MIT
#include <osgGpuAnimation/authoring/keyframes/ChannelCurve.h>

#include <osgGpuAnimation/math/Hermite.h>
#include <osgGpuAnimation/math/Rotation.h>

#include <glm/geometric.hpp>

#include <algorithm>

namespace osgGpuAnimation
{

namespace
{

using Interpolation = Channel::Interpolation;

glm::dvec4 rotationAt(const double* q)
{
    return glm::dvec4(q[0], q[1], q[2], q[3]);
}

void store(const glm::dvec4& q, double* out)
{
    for (int c = 0; c < 4; ++c)
        out[c] = q[c];
}

/// True if single precision could find the other way shorter: |cos| < 1e-6. If every term of the dot product is 0, it
/// is 0 in any precision. a, b: of float range, so that their squares neither overflow nor vanish.
bool isAmbiguous(const glm::dvec4& a, const glm::dvec4& b)
{
    const double product = glm::dot(a, b);
    return product * product < 1e-12 * glm::dot(a, a) * glm::dot(b, b) && a * b != glm::dvec4(0.0);
}

} // namespace

ChannelCurve::ChannelCurve(const Channel& channel, std::size_t componentCount)
    : _channel(channel), _componentCount(componentCount),
      _valuesPerKey(channel.interpolation == Interpolation::CubicSpline ? 3 : 1)
{
}

bool ChannelCurve::isSplineRotation() const
{
    return _channel.path == Channel::Path::Rotation && _channel.interpolation == Interpolation::CubicSpline;
}

const double* ChannelCurve::valueOfKey(std::size_t key) const
{
    const std::size_t place = _valuesPerKey == 3 ? key * 3 + 1 : key; // in-tangent, value, out-tangent
    return _channel.values.data() + place * _componentCount;
}

std::size_t ChannelCurve::keyAt(const Moment& at)
{
    const std::vector<double>& times = _channel.times;
    if (times[_cursor] > at.time) _cursor = 0;
    while (_cursor + 1 < times.size() && times[_cursor + 1] <= at.time)
        ++_cursor;
    return _cursor;
}

bool ChannelCurve::isHeldAt(std::size_t key, double time) const
{
    return time <= _channel.times.front() || key + 1 == _channel.times.size();
}

void ChannelCurve::value(const Moment& at, double* out)
{
    const std::size_t key = keyAt(at);
    const bool isRotation = _channel.path == Channel::Path::Rotation;
    const bool oldValue =
        _channel.interpolation == Interpolation::Step && at.before && key > 0 && _channel.times[key] == at.time;
    const double* first = valueOfKey(oldValue ? key - 1 : key);

    if (_channel.interpolation == Interpolation::Step || isHeldAt(key, at.time) || at.time == _channel.times[key])
    {
        std::copy_n(first, _componentCount, out);
        if (isRotation && !isSplineRotation()) store(Rotation::unit(rotationAt(first)), out);
        return;
    }

    const double* second = valueOfKey(key + 1);
    const double alpha = (at.time - _channel.times[key]) / (_channel.times[key + 1] - _channel.times[key]);
    if (_channel.interpolation == Interpolation::CubicSpline)
        spline(key, alpha, out);
    else if (isRotation)
        store(Rotation::slerp(rotationAt(first), rotationAt(second), alpha), out);
    else
        for (std::size_t c = 0; c < _componentCount; ++c)
            out[c] = first[c] * (1.0 - alpha) + second[c] * alpha;
}

void ChannelCurve::spline(std::size_t key, double alpha, double* out) const
{
    const double length = _channel.times[key + 1] - _channel.times[key];
    const double* v0 = valueOfKey(key);
    const double* v1 = valueOfKey(key + 1);
    for (std::size_t c = 0; c < _componentCount; ++c) // the out-tangent follows the value, the in-tangent precedes it
        out[c] = hermite(v0[c], length * v0[_componentCount + c], v1[c], length * (v1 - _componentCount)[c], alpha);
}

void ChannelCurve::splineSlope(std::size_t key, double alpha, double factor, double* out) const
{
    const double length = _channel.times[key + 1] - _channel.times[key];
    const double square = alpha * alpha;
    const double* v0 = valueOfKey(key);
    const double* v1 = valueOfKey(key + 1);
    for (std::size_t c = 0; c < _componentCount; ++c)
    {
        const double m0 = length * v0[_componentCount + c];
        const double m1 = length * (v1 - _componentCount)[c];
        const double slope = 6.0 * (square - alpha) * (v0[c] - v1[c]) + (3.0 * square - 4.0 * alpha + 1.0) * m0 +
                             (3.0 * square - 2.0 * alpha) * m1;
        out[c] = slope * factor;
    }
}

void ChannelCurve::tangents(const Moment& from, const Moment& to, double* outFirst, double* outLast)
{
    std::fill_n(outFirst, _componentCount, 0.0);
    std::fill_n(outLast, _componentCount, 0.0);
    const std::size_t key = keyAt(from);
    if (isHeldAt(key, to.time) || from.time == to.time || _channel.interpolation == Interpolation::Step) return;

    const double length = _channel.times[key + 1] - _channel.times[key];
    const double share = (to.time - from.time) / length;
    const double alpha = (from.time - _channel.times[key]) / length;
    if (_channel.interpolation == Interpolation::CubicSpline)
    {
        splineSlope(key, alpha, share, outFirst);
        splineSlope(key, (to.time - _channel.times[key]) / length, share, outLast);
    }
    else if (_channel.path != Channel::Path::Rotation)
    {
        for (std::size_t c = 0; c < _componentCount; ++c)
            outFirst[c] = outLast[c] = (valueOfKey(key + 1)[c] - valueOfKey(key)[c]) * share;
    }
}

void ChannelCurve::appendJumps(std::vector<double>& out) const
{
    if (_channel.interpolation != Interpolation::Step) return;
    for (std::size_t key = 1; key < _channel.times.size(); ++key)
        if (!std::equal(valueOfKey(key), valueOfKey(key) + _componentCount, valueOfKey(key - 1)))
            out.push_back(_channel.times[key]);
}

void ChannelCurve::appendMiddlesOfHalfTurns(const std::vector<double>& times, std::vector<double>& out) const
{
    if (_channel.path != Channel::Path::Rotation || _channel.interpolation != Interpolation::Linear) return;
    for (std::size_t key = 0; key + 1 < _channel.times.size(); ++key)
    {
        if (!isAmbiguous(rotationAt(valueOfKey(key)), rotationAt(valueOfKey(key + 1)))) continue;
        const double from = _channel.times[key];
        const double to = _channel.times[key + 1];
        const auto next = std::upper_bound(times.begin(), times.end(), from);
        const double middle = static_cast<double>(static_cast<float>(0.5 * (from + to)));
        const bool isCut = next != times.end() && *next < to;
        if (!isCut && from < middle && middle < to) out.push_back(middle);
    }
}

} // namespace osgGpuAnimation
