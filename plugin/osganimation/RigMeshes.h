// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/mesh/SkinnedGeometry.h>

#include <osgAnimation/Bone>
#include <osgAnimation/MorphGeometry>
#include <osgAnimation/Skeleton>
#include <osgAnimation/UpdateBone>

#include <string>
#include <vector>

namespace osgGpuAnimation::osganimation
{

/// A bone and its joint: the index of both is the same.
struct BoneJoint
{
    osg::ref_ptr<osgAnimation::Bone> bone;
    osgAnimation::UpdateBone* update; ///< null: the bone keeps its matrix
    int parent;                       ///< -1: none
};

/// A geometry that bones move.
struct RigMesh
{
    osg::ref_ptr<osg::Geometry> geometry; ///< a RigGeometry, or one that a single bone carries
    osg::ref_ptr<osg::StateSet> state;    ///< of all nodes from the skeleton down to it, and its own
    std::vector<int> bones;
    std::vector<AffineMatrix> inverseBinds; ///< one per bone
    /// The geometry itself, or the source of a RigGeometry, if it is morphed.
    osg::ref_ptr<osgAnimation::MorphGeometry> morph{};
    osgAnimation::UpdateMorph* weights = nullptr; ///< drives them; null: nothing does
};

/// The geometries below a skeleton that are drawn from the palette: RigGeometry anywhere, other geometry below a bone,
/// unless a transform between the two has an update callback.
std::vector<RigMesh> findMeshes(osgAnimation::Skeleton& skeleton, const std::vector<BoneJoint>& bones,
                                std::vector<std::string>& warnings);

/// The mesh for a set with one skin a RigMesh. morph: the index of the set's morph weights; -1: the mesh has none.
osg::ref_ptr<SkinnedGeometry> skinnedMesh(const RigMesh& mesh, const AnimationSet& set, std::size_t skin, int morph,
                                          std::vector<std::string>& warnings);

/// True if nothing is left of a subgraph but groups and transforms without callbacks.
bool isEmpty(osg::Node& node);

} // namespace osgGpuAnimation::osganimation
