// SPDX-License-Identifier: MIT
#pragma once

namespace osgGpuAnimation
{

/// The cubic Hermite form between a and b at x in [0, 1] (glTF 2.0, appendix C.5). out: the tangent after a. in: the
/// tangent before b. Both tangents are multiplied by the length of the interval.
template <typename V>
V hermite(const V& a, const V& out, const V& b, const V& in, double x)
{
    const double square = x * x, cube = square * x;
    return (2.0 * cube - 3.0 * square + 1.0) * a + (cube - 2.0 * square + x) * out + (3.0 * square - 2.0 * cube) * b +
           (cube - square) * in;
}

/// Its derivative by x.
inline double hermiteSlope(double a, double out, double b, double in, double x)
{
    const double square = x * x;
    return 6.0 * (square - x) * (a - b) + (3.0 * square - 4.0 * x + 1.0) * out + (3.0 * square - 2.0 * x) * in;
}

} // namespace osgGpuAnimation
