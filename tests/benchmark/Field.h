// SPDX-License-Identifier: MIT
#pragma once

#include "StagedViewer.h"
#include "Subject.h"

#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

namespace osgGpuAnimation::benchmark
{

// A field of 99,856 instances and the view of it.

constexpr std::size_t columns = 316; ///< and as many rows
constexpr std::size_t places = columns * columns;
constexpr float fieldPixelError = 0.5f;

/// Of neighbours, in the units of the subject's file.
double spacingOf(const Subject& subject);
/// Everybody loops some clip of the file from some time on. step: each step-th place is taken.
osg::ref_ptr<AnimatedCrowd> makeField(const Subject& subject, std::size_t step = 1);
/// From before the field over half of it.
void lookAcross(StagedViewer& viewer, const osg::BoundingSphere& field);

} // namespace osgGpuAnimation::benchmark
