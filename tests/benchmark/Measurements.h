// SPDX-License-Identifier: MIT
#pragma once

#include "Effort.h"
#include "Report.h"
#include "Subject.h"

#include <osgGpuAnimation/animation/Result.h>

#include <osg/GraphicsContext>

namespace osgGpuAnimation::benchmark
{

// Each puts its rows and points into the report. Errors: GL reported one, or a result was wrong: nothing of it counts.

/// From advance() to the finished palette, against osgAnimation's update traversal and against the floor.
/// The context is current.
Result<bool> measurePose(const Subject& subject, const Effort& effort, osg::GraphicsContext& context, Report& report);

/// Four blend samples a character against one, as layers and crossfades ask for. The context is current.
Result<bool> measureSamples(const Subject& subject, const Effort& effort, osg::GraphicsContext& context,
                            Report& report);

/// The same characters in chunks of so many instances each. The context is current.
Result<bool> measureChunks(const Subject& subject, const Effort& effort, osg::GraphicsContext& context, Report& report);

/// A joint's cost in chains of 8 to 64. The context is current.
Result<bool> measureDepth(const Effort& effort, osg::GraphicsContext& context, Report& report);

/// Whole frames, their stages, memory and the first frame, in viewers of their own.
Result<bool> measureFrames(const Subject& subject, const Effort& effort, Report& report);

/// Skinned draws against the same meshes and shader without skinning, and against the least that draws the triangles.
Result<bool> measureDraws(const Subject& subject, const Effort& effort, Report& report);

/// One crowd node against as many separate nodes: whole frames, and what the CPU does of them.
Result<bool> measureCrowd(const Subject& subject, const Effort& effort, Report& report);

/// Bytes and the first frame of many characters.
Result<bool> measureStart(const Subject& subject, const Effort& effort, Report& report);

/// Loading its file, against what tinygltf takes to parse it and decode its pictures.
Result<bool> measureLoad(const Subject& subject, const Effort& effort, Report& report);

} // namespace osgGpuAnimation::benchmark
