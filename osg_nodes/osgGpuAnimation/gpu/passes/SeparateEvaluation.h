// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/gpu/passes/EvaluationContext.h>
#include <osgGpuAnimation/gpu/PoseBatch.h>

namespace osgGpuAnimation
{

/// The separate form: mix, local, world, one draw each; the world stage multiplies along the ancestors. It is the
/// readable form of the stages, without constraints. False: a pass does not compile.
bool evaluateSeparately(EvaluationContext& context, FeedbackScope& scope, const PoseBatch& batch,
                        const AnimationBuffers& buffers, PosePalette::Chunk& chunk);

} // namespace osgGpuAnimation
