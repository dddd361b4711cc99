// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osgUtil/LineSegmentIntersector>
#include <osgUtil/PolytopeIntersector>

#include <optional>

namespace osgGpuAnimation
{

/// Whose mesh an intersector has hit, and the joint that moves what is there most.
///
///     if (auto picked = jointOf(ray->getFirstIntersection()))
///         std::cout << picked->set->skeleton().joint(picked->joint).name << std::endl;
///
/// The pointers are borrowed: they hold as long as the nodes do.
struct PickedJoint
{
    const AnimatedCharacter* character = nullptr; ///< null: it is a crowd's
    const AnimatedCrowd* crowd = nullptr;         ///< null: it is a character's
    AnimatedCrowd::Instance instance = 0;         ///< of the crowd
    const SkinnedGeometry* mesh = nullptr;        ///< never null
    const AnimationSet* set = nullptr;            ///< the character's or the crowd's, never null
    std::size_t joint = 0;                        ///< of the set's skeleton
};

/// The joint whose weights at the hit triangle's corners, each counted by its share in the point, come to the most.
/// Nothing where the hit is neither a character's nor a crowd's, or no joint moves the vertices.
std::optional<PickedJoint> jointOf(const osgUtil::LineSegmentIntersector::Intersection& hit);
/// A polytope does not tell the triangle's corners: the vertex nearest to localIntersectionPoint has the say.
std::optional<PickedJoint> jointOf(const osgUtil::PolytopeIntersector::Intersection& hit);

} // namespace osgGpuAnimation
