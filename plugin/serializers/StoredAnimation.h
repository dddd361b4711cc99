// SPDX-License-Identifier: MIT
#pragma once

#include "serializers/ValueStream.h"

#include <osgGpuAnimation/animation/AnimationController.h>
#include <osgGpuAnimation/animation/AnimationSet.h>
#include <osgGpuAnimation/animation/Clip.h>
#include <osgGpuAnimation/animation/Constraint.h>
#include <osgGpuAnimation/mesh/SkinnedGeometry.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osg/Group>

#include <memory>
#include <optional>
#include <string>

namespace osgGpuAnimation::serializers
{

/// A property of a node: the set, or a reference to it if the file contains it already, so that characters that share a
/// set still share it after reading. A set that cannot be read makes the file unreadable.
void transferAnimationSet(ValueStream& stream, std::shared_ptr<const AnimationSet>& set);

/// A reference of the mesh to palette entries, morphs or vertices that do not exist: files are untrusted, and the GPU
/// does not check indices.
std::optional<std::string> findFault(const SkinnedGeometry& mesh, const AnimationSet& set);

/// Removes, with a warning, every SkinnedGeometry with a fault below the group.
void removeUnfitMeshes(osg::Group& group, const AnimationSet& set);

/// The set of a character or crowd, whose meshes are read before it. set: the owner's, for writing. give(set): gives
/// the set that was read to the owner, and returns a Result<void>.
template <typename Give>
void transferSet(ValueStream& stream, osg::Group& owner, std::shared_ptr<const AnimationSet> set, Give give)
{
    transferAnimationSet(stream, set);
    if (!stream.hasRead()) return;
    removeUnfitMeshes(owner, *set);
    stream.require("", give(set));
}

/// The present state of all layers. Reading expects a controller of the same set; a layer whose state does not fit the
/// set does not change, with a warning.
void transferController(ValueStream& stream, AnimationController& controller);

void transferMatrix(ValueStream& stream, osg::Matrixd& matrix);

template <typename Node>
void transferFileToNode(ValueStream& stream, Node& node)
{
    osg::Matrixd matrix = node.getFileToNode();
    transferMatrix(stream, matrix);
    if (stream.hasRead()) stream.require("a node: ", node.setFileToNode(matrix));
}

/// The declarations of a set.
void transferConstraints(ValueStream& stream, std::vector<Constraint>& constraints);

/// The targets of a controller. Reading expects a controller of the same set; a target that does not fit the set is
/// dropped, with a warning.
void transferTargets(ValueStream& stream, AnimationController& controller);

constexpr std::size_t floatsATransform = sizeof(JointTransform) / sizeof(float);

/// The keyframes of a compact clip, see CompactTracks: its tracks and records, the transforms of joints at rest, and
/// the morph weights. clip: has its times and numbers of tracks; reading adds its data and compact tracks, which
/// Clip::create() checks. bytesLeft: the memory for the data of all compact clips of a set; reading subtracts from it,
/// and beyond it the file is unreadable.
void transferCompactKeyframes(ValueStream& stream, ClipParts& clip, std::size_t& bytesLeft);

/// The levels of detail of a mesh, so that reading creates none. Levels with a fault (a warning names it) or of other
/// vertices or primitives than the mesh's are dropped and created anew when they are needed.
void transferLodLevels(ValueStream& stream, SkinnedGeometry& mesh);
/// The same for a crowd's levels of the character as a whole, before the crowd's pixel error is set.
void transferCharacterLevels(ValueStream& stream, AnimatedCrowd& crowd);

} // namespace osgGpuAnimation::serializers
