// SPDX-License-Identifier: MIT
#pragma once

#include <osgAnimation/Channel>

#include <cmath>
#include <vector>

namespace osgGpuAnimation::osganimation
{

// For sampledTrack(): what keys may deviate from osgAnimation, as a part of the value, and how many of that are a jump.
constexpr double tolerance = 1e-5, minJump = 100.0;

/// The key times of all channels, ascending, each once: floats from 0 on, as clips have them. Others are left out.
std::vector<double> keyTimesOf(const std::vector<osg::ref_ptr<osgAnimation::Channel>>& channels);

/// The next float towards 0.
inline double justBefore(double time)
{
    return static_cast<double>(std::nextafter(static_cast<float>(time), 0.0f));
}

} // namespace osgGpuAnimation::osganimation
