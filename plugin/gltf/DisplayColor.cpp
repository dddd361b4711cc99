// SPDX-License-Identifier: MIT
#include "gltf/DisplayColor.h"

#include <cmath>

namespace osgGpuAnimation::gltf
{

namespace
{

/// Not a number counts as 0.
double toUnit(double value)
{
    return value > 0.0 ? std::fmin(value, 1.0) : 0.0;
}

float encode(double linear)
{
    const double value = toUnit(linear);
    return static_cast<float>(value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1.0 / 2.4) - 0.055);
}

} // namespace

osg::Vec4 displayColor(double red, double green, double blue, double alpha)
{
    return osg::Vec4(encode(red), encode(green), encode(blue), static_cast<float>(toUnit(alpha)));
}

} // namespace osgGpuAnimation::gltf
