// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/nodes/AnimatedCharacter.h>
#include <osgGpuAnimation/nodes/AnimatedCrowd.h>

#include <osgUtil/LineSegmentIntersector>
#include <osgUtil/PolytopeIntersector>

#include <cstddef>
#include <optional>

namespace osgGpuAnimation
{

/// The mesh that an intersector has hit, with the joint that moves the hit point most.
///
///     if (auto picked = jointOf(ray->getFirstIntersection()))
///     {
///         std::cout << picked->set->skeleton().joint(picked->joint).name << std::endl;
///         if (picked->character) picked->character->getController().crossfade("Hit", 0.1);
///     }
///
/// The pointers are borrowed from the nodes and valid as long as those exist.
struct PickedJoint
{
    AnimatedCharacter* character = nullptr; ///< null: the hit is in a crowd
    AnimatedCrowd* crowd = nullptr;         ///< null: the hit is in a character
    AnimatedCrowd::Instance instance = 0;   ///< of the crowd, if any
    SkinnedGeometry* mesh = nullptr;        ///< never null; clones of the character share it
    const AnimationSet* set = nullptr;      ///< of the character or crowd, never null
    std::size_t joint = 0;                  ///< index in the skeleton of the set
};

/// The joint with the largest sum of weights at the corners of the hit triangle, each multiplied by the corner's share
/// in the hit point. Empty: the hit is in no character or crowd, or no joint moves the vertices.
std::optional<PickedJoint> jointOf(const osgUtil::LineSegmentIntersector::Intersection& hit);
/// The same by the vertex nearest to localIntersectionPoint, because polytope hits name no corners. Call it before the
/// pose changes.
std::optional<PickedJoint> jointOf(const osgUtil::PolytopeIntersector::Intersection& hit);

} // namespace osgGpuAnimation
