// SPDX-License-Identifier: MIT
#pragma once

#include "Effort.h"
#include "Report.h"
#include "Subject.h"

#include <osgGpuAnimation/math/Result.h>

#include <osg/GraphicsContext>

namespace osgGpuAnimation::benchmark
{

// Each function adds its rows and points to the report. Error: GL reported an error or a result was wrong, which makes
// the measurement invalid.

/// The work from advance() to the finished palette, compared with osgAnimation's update traversal and with the
/// FeedbackFloor. Requires a current context.
Result<void> measurePose(const Subject& subject, const Effort& effort, osg::GraphicsContext& context, Report& report);

/// Four blend samples per character compared with one; layers and crossfades add samples. Requires a current context.
Result<void> measureSamples(const Subject& subject, const Effort& effort, osg::GraphicsContext& context,
                            Report& report);

/// Look-ats and two-bone inverse kinematics compared with the same characters without. Requires a current context.
Result<void> measureConstraints(const Subject& subject, const Effort& effort, osg::GraphicsContext& context,
                                Report& report);

/// The same characters in chunks of different sizes. Requires a current context.
Result<void> measureChunks(const Subject& subject, const Effort& effort, osg::GraphicsContext& context, Report& report);

/// Compact clips compared with exact ones: pose and bytes. Requires a current context.
Result<void> measureCompact(const Subject& subject, const Effort& effort, osg::GraphicsContext& context,
                            Report& report);

/// The cost per joint in chains of 8 to 64 joints. Requires a current context.
Result<void> measureDepth(const Effort& effort, osg::GraphicsContext& context, Report& report);

/// Whole frames, their stages, memory and the first frame; each scene has its own viewer.
Result<void> measureFrames(const Subject& subject, const Effort& effort, Report& report);

/// Skinned draws compared with unskinned draws of the same meshes and shader, and with the cheapest draw of the
/// triangles.
Result<void> measureDraws(const Subject& subject, const Effort& effort, Report& report);

/// glTF's shading of a picture that the character fills, under one light and in the studio, compared with the fixed
/// pipeline's look.
Result<void> measureShading(const Subject& subject, const Effort& effort, Report& report);

/// One crowd node compared with the same number of separate nodes: whole frames and their CPU time.
Result<void> measureCrowd(const Subject& subject, const Effort& effort, Report& report);

/// A field of 99,856 instances of a crowd with a pixel error, of which the camera sees half: whole frames, poses and
/// bytes.
Result<void> measureField(const Subject& subject, const Effort& effort, Report& report);

/// A crowd of 99,856 of all subjects in turns; everyone walks and one camera flies through: times and counts a frame.
Result<void> measureMixed(const std::vector<Subject>& subjects, const Effort& effort, Report& report);

/// Pictures of instances with a pixel error of 0.5 against those with all triangles and exact poses: 100 of 4, 8 and 16
/// pixels of height, 8x8 supersampled (coverage, and the structural similarity of Wang et al., Image Quality
/// Assessment, 2004), and the field (steps of brightness from row to row).
Result<void> measurePictures(const Subject& subject, const Effort& effort, Report& report);

/// The memory of a field of 99,856 beyond that of a field of one, on the CPU and the GPU.
Result<void> measureMemory(const Subject& subject, const Effort& effort, Report& report);

/// The memory and the first frame of many characters.
Result<void> measureStart(const Subject& subject, const Effort& effort, Report& report);

/// Loading the subject's file, compared with tinygltf's parsing and image decoding.
Result<void> measureLoad(const Subject& subject, const Effort& effort, Report& report);

} // namespace osgGpuAnimation::benchmark
