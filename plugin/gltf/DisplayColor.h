// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Vec4>

namespace osgGpuAnimation::gltf
{

/// glTF's factors and vertex colours are linear (section 3.9.2), its pictures sRGB. OSG's fixed pipeline and our
/// character program shade in display space and take pictures as they are; so linear colours are brought there by the
/// sRGB transfer function (IEC 61966-2-1). Alpha is linear in both. Clamped to [0, 1].
osg::Vec4 displayColor(double red, double green, double blue, double alpha);

} // namespace osgGpuAnimation::gltf
