// SPDX-License-Identifier: MIT
#pragma once

#include <osg/StateAttribute>

namespace osgGpuAnimation
{

constexpr auto on = osg::StateAttribute::ON, off = osg::StateAttribute::OFF, inherit = osg::StateAttribute::INHERIT;
constexpr auto override = osg::StateAttribute::OVERRIDE, protect = osg::StateAttribute::PROTECTED;

} // namespace osgGpuAnimation
