// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/file/ImportOptions.h"
#include "gltf/file/Report.h"

#include <osgGpuAnimation/math/Result.h>

#include <tiny_gltf.h>

#include <string>

namespace osgGpuAnimation::gltf
{

/// Reads a .gltf or .glb into tinygltf's model without tinygltf's parser, which trusts its input. Each byte of JSON is
/// parsed once: the tree is checked against the schema and the rules, mended (members without a rule are dropped, 8.0
/// becomes 8), and then copied into the model. Buffers and pictures come from the model's folder only, from regular
/// files only and within the limits. The data is validated afterwards, so every index, offset, count and type in the
/// returned model can be trusted.
///
/// The model, beyond the specification:
/// - buffers hold byteLength bytes; those without data are empty and nothing refers to them;
/// - images hold encoded bytes (as_is), mimeType by the bytes, width and height; empty where they cannot be read;
/// - an animation channel without target_node (-1) animates nothing; a primitive without attributes draws nothing;
/// - no property of a node is animated by two channels of one animation;
/// - rotations of animations, joint numbers and weights are mended in accessors of our own where the file's are faulty;
/// - compressed meshes and buffer views are decompressed; accessors have no minValues and maxValues, because the bounds
///   are computed from the data;
/// - lights (KHR_lights_punctual) and cameras without a type are left out; of cameras, only yfov and ymag are read.
///
/// bytes: the file's content, GLB or JSON. fileName: gives the folder of external files and appears in messages; empty
/// for a stream, which then has no external files.
/// Errors: the file as a whole is at fault; the message names the element, what was expected and what was found.
/// Faults that cost one clip, mesh, skin or image only are warnings.
Result<tinygltf::Model> loadDocument(const std::string& bytes, const std::string& fileName,
                                     const ImportOptions& options, Messages& messages);

} // namespace osgGpuAnimation::gltf
