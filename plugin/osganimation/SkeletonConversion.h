// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>

#include <osg/Node>

#include <string>
#include <vector>

namespace osgGpuAnimation::osganimation
{

/// The result of convertOsgAnimation().
struct Conversion
{
    osg::ref_ptr<osg::Node> node; ///< the scene; another node where its root was a skeleton
    std::vector<osg::ref_ptr<AnimatedCharacter>> characters;
    std::vector<std::string> warnings; ///< what stayed as it was, and why
};

/// Puts an AnimatedCharacter in the place of each osgAnimation::Skeleton at or below the node: its Bones become joints,
/// the animations of the scene's animation managers become clips, RigGeometry and the geometry below bones are drawn
/// from the palette with their own StateSets and the characters' program, and other nodes below bones are attached to
/// joints. Everything else of the scene stays. The characters play their first clip.
///
///     const Conversion converted = convertOsgAnimation(scene);
///     viewer.setSceneData(converted.node);
///
/// The poses are osgAnimation's: see BoneMotion. A manager whose channels are all in clips is removed. What stays as it
/// was, with a warning: skeletons without bones or with a shear in a bone, MorphGeometry that no bone carries, animated
/// materials and transforms outside skeletons. Vertices keep their eight largest influences. MorphGeometry below bones,
/// and as the source of RigGeometry, becomes morph targets, its UpdateMorph's channels become weights.
Conversion convertOsgAnimation(osg::Node& node);

} // namespace osgGpuAnimation::osganimation
