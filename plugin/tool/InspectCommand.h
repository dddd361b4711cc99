// SPDX-License-Identifier: MIT
#pragma once

#include "tool/ModelFile.h"

namespace osgGpuAnimation::tool
{

/// `osggpuanim inspect`: prints the content of a file and its memory on standard output, as JSON or as text made from
/// that JSON:
///
///     file, generator, scene
///     joints       count, depth (levels of the hierarchy), roots (names), list (name, parent: an index or -1)
///     skins        name, joints                         a skin
///     paletteEntries
///     bounds       of the rest pose in the file's axes: [least corner, greatest corner], null if nothing is drawn
///     clips        index (the file's), name, seconds, keyframes, form (linear or spline), bounds (of what moves)
///     meshes       count, primitives, vertices, skinned, rigid, still (primitives each), morphTargets
///     materials    name, alphaMode (OPAQUE, MASK, BLEND), alphaCutoff (of MASK), doubleSided, unlit, maps (map, image:
///     the
///                  file's index, size: [width, height], null for a missing picture)
///     variants, extensions                              names
///     gpuBytes     animation, meshes, textures, total   in GPU buffers, without the driver's own memory
///     warnings, notes
struct InspectCommand : ModelArguments
{
    bool json = false; ///< prints JSON instead of text

    /// Error messages begin with the name of the file at fault.
    Result<void> run() const;
};

} // namespace osgGpuAnimation::tool
