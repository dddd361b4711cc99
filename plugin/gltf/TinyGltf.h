// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/ImportOptions.h"
#include "gltf/Messages.h"

#include <osgGpuAnimation/animation/Result.h>

#include <tiny_gltf.h>

#include <string>

namespace osgGpuAnimation::gltf
{

/// Reads a .gltf or .glb through tinygltf, guarded. tinygltf parses what is left when everything it stumbles over is
/// out of the way: the GLB frame, the JSON and its members are checked first and put right (8.0 becomes 8, what no rule
/// names is dropped), buffers and pictures are read by us (the model's folder only, regular files only, limited size).
/// The data is validated afterwards, so that every index, offset, count and type in the model that comes out can be
/// trusted.
///
/// What the model is like, beyond the specification:
/// - buffers hold byteLength bytes; those without data are empty and nothing refers to them;
/// - images hold encoded bytes (as_is), mimeType by the bytes, width and height; empty where they cannot be read;
/// - an animation channel without target_node (-1) animates nothing; a primitive without attributes draws nothing;
/// - rotations of animations, joint numbers and weights are mended in accessors of our own where the file's are faulty;
/// - compressed meshes and buffer views are decompressed; accessors have no minValues and maxValues: the data tells.
///
/// bytes: the file's content (GLB or JSON, told apart by the content). fileName: where it came from, for its folder
/// and for messages; may be empty (a stream: no external files then).
/// Errors: the file as a whole is at fault; the message names the element, what was expected and what was found.
/// Faults that cost one clip, mesh, skin or image only are warnings.
Result<tinygltf::Model> loadDocument(const std::string& bytes, const std::string& fileName,
                                     const ImportOptions& options, Messages& messages);

} // namespace osgGpuAnimation::gltf
