// SPDX-License-Identifier: MIT
#pragma once

namespace osgGpuAnimation::serializers
{

/// Has osg::StateSet's wrapper write shader defines into an .osgx so that OSG can read them again. OSG 3.6.5 leaves a
/// word out there, after which nothing that follows is read right. What goes into .osgb and .osgt stays as it is.
/// Only the first call does something.
void repairDefinesInXml();

} // namespace osgGpuAnimation::serializers
