// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/document/JsonTree.h"
#include "gltf/file/Report.h"

#include <osgGpuAnimation/animation/Skeleton.h>
#include <osgGpuAnimation/nodes/properties/AnimatedProperties.h>

#include <tiny_gltf.h>

#include <optional>
#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// Resolves the pointers of all channels:
///
/// - A node's transform or weights: the channel becomes one with that node and path. A mesh's weights: it becomes one
///   for each node with the mesh that has no weights of its own.
/// - A property that the kit draws (see PropertyPointer): the channel has no node, and its path is the pointer. Factors
///   without effect at rest (a clear coat of 0) get the smallest effect, so that the material has the maps and shader
///   terms that the animation needs.
/// - Anything else costs the channel, with a warning that names the pointer: it keeps its place without a target.
///
/// document: the one that the model was read from.
void resolvePointers(const JsonValue& document, tinygltf::Model& model, Report& report);

bool hasPointer(const tinygltf::AnimationChannel& channel); ///< its target was a pointer
/// The property that the channel animates; nothing: a node's transform or weights, or nothing.
std::optional<PropertyPointer> propertyOf(const tinygltf::AnimationChannel& channel);
/// The only weight that the channel animates; -1: all, or none.
int weightOf(const tinygltf::AnimationChannel& channel);
/// Removes the channel's target.
void dropTarget(tinygltf::AnimationChannel& channel);

/// The properties that clips of the file animate, named by their pointers, with their values at rest. Groups of
/// PropertyMember are complete.
std::vector<MorphWeights> propertiesOf(const tinygltf::Model& model);
/// The value at rest of one of them; empty: clips do not animate it.
std::vector<float> valueAtRest(const tinygltf::Model& model, const std::string& pointer);
/// One flag for each object of that kind: clips animate a property of it. count: of the objects.
std::vector<bool> animatedObjects(const tinygltf::Model& model, PropertyMember::Object object, std::size_t count);

} // namespace osgGpuAnimation::gltf
