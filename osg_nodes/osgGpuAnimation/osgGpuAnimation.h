// SPDX-License-Identifier: MIT
#pragma once

/// The umbrella header: every public header of the kit.

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/AnimationLayer.h>
#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/Clip.h>
#include <osgGpuAnimation/animation/ClipBuilder.h>
#include <osgGpuAnimation/animation/ClipMixer.h>
#include <osgGpuAnimation/animation/JointMask.h>
#include <osgGpuAnimation/animation/JointTransform.h>
#include <osgGpuAnimation/animation/Playback.h>
#include <osgGpuAnimation/animation/Pose.h>
#include <osgGpuAnimation/animation/Result.h>
#include <osgGpuAnimation/animation/RootMotion.h>
#include <osgGpuAnimation/animation/Skeleton.h>
#include <osgGpuAnimation/animation/StateMachine.h>
#include <osgGpuAnimation/gpu/EglGraphicsContext.h>
#include <osgGpuAnimation/gpu/FeedbackPass.h>
#include <osgGpuAnimation/gpu/PoseBatch.h>
#include <osgGpuAnimation/gpu/PosePipeline.h>
#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>
#include <osgGpuAnimation/nodes/CharacterKeys.h>
#include <osgGpuAnimation/nodes/CharacterProgram.h>
#include <osgGpuAnimation/nodes/Environment.h>
#include <osgGpuAnimation/nodes/GroundFeet.h>
#include <osgGpuAnimation/nodes/JointAttachment.h>
#include <osgGpuAnimation/nodes/MorphTarget.h>
#include <osgGpuAnimation/nodes/OsgMatrix.h>
#include <osgGpuAnimation/nodes/PbrMaterial.h>
#include <osgGpuAnimation/nodes/PoseStatistics.h>
#include <osgGpuAnimation/nodes/SkinnedGeometry.h>
#include <osgGpuAnimation/nodes/SpringBones.h>
#include <osgGpuAnimation/nodes/StateGraphFile.h>
