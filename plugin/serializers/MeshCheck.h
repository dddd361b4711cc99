// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/AnimationSet.h>

#include <osg/Group>

namespace osgGpuAnimation::serializers
{

/// Takes every SkinnedGeometry below the group away, with a warning, that names palette entries, morphs or vertices
/// that are not there: files are not trusted, and the GPU does not look.
void removeUnfitMeshes(osg::Group& group, const AnimationSet& set);

} // namespace osgGpuAnimation::serializers
