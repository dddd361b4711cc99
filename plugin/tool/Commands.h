// SPDX-License-Identifier: MIT
#pragma once

#include "tool/ModelFile.h"
#include "tool/PictureViewer.h"

#include <osgGpuAnimation/math/Result.h>

#include <optional>
#include <string>
#include <vector>

namespace osgGpuAnimation::tool
{

// The commands of osggpuanim and what the command line says to each. Error messages of run() begin with the name of the
// file at fault.

/// `osggpuanim inspect`: prints the content of a file and its memory on standard output, as JSON or as text made from
/// that JSON:
///
///     file, generator, scene
///     joints       count, depth (levels of the hierarchy), roots (names), list (name, parent: an index or -1)
///     skins        name, joints                         a skin
///     paletteEntries
///     bounds       of the rest pose in the file's axes: [least corner, greatest corner], null if nothing is drawn
///     clips        index (the file's), name, seconds, keyframes, form (linear or spline), bounds (of what moves)
///     keyframes    count, bytes (on the GPU), snapshotBytes; of compact clips also error, tolerance, longestSide
///     meshes       count, primitives, vertices, skinned, rigid, still (primitives each), morphTargets
///     materials    name, alphaMode (OPAQUE, MASK, BLEND), alphaCutoff (of MASK), doubleSided, unlit, maps (map, image:
///                  the file's index, size: [width, height], null for a missing picture)
///     variants, extensions                              names
///     lights       index (the file's), node, number (OpenGL's; null: left out), and with a number name, type
///     cameras      index (the file's), name, node, type (perspective or orthographic)
///     gpuBytes     animation, meshes, textures, total   in GPU buffers, without the driver's own memory
///     warnings, notes
struct InspectCommand : ModelArguments
{
    bool json = false; ///< prints JSON instead of text

    Result<void> run() const;
};

/// `osggpuanim pose`: writes the poses of a file's joints and vertices at given times in the schema gltf-pose/1: JSON,
/// in the file's own axes, units and numbers; matrices are 16 numbers, column-major for column vectors. A pose holds
/// the world matrix of every node that is a joint (null for others), the joint matrices by skin, the morph weights, and
/// of each primitive its bounding box and the requested vertices. `modelSize` is the diagonal of the first pose's box;
/// comparisons divide lengths by it (errors of compact clips refer to the longest side at rest instead).
struct PoseCommand : ModelArguments
{
    std::string like;                ///< a document whose clip, times, set weights and vertices are taken; empty: none
    std::optional<std::string> clip; ///< by its name, or by number where none has that name; default: the first
    bool bind = false;               ///< no clip: the nodes at rest, at time 0
    std::vector<double> times;       ///< seconds from the beginning of the clip
    bool onGpu = true;               ///< false: the CPU computes the poses
    std::string output;              ///< empty: standard output

    Result<void> run() const;
};

/// `osggpuanim render`: draws pictures of a file without a display. One camera, in front and to the side, shows
/// everything in all pictures, unless another direction, a way around, or a camera of the file is asked for.
struct RenderCommand : ModelArguments ///< or a crowd of it: `fox.glb.20x20.crowd`
{
    static constexpr int maxSize = 8192; ///< pixels, each way

    std::optional<std::string> clip;    ///< name or animation number; default: the first; of a crowd: all, at random
    std::optional<std::string> camera;  ///< of the file: name or number; default: none
    std::optional<std::string> variant; ///< of the file's materials: name or number; default: none
    std::string outfits;                ///< of a crowd: the name of an outfits file, or "random"; empty: none
    double time = 0.0;                  ///< seconds; clips loop
    int width = 800;                    ///< pixels, [1, maxSize]
    int height = 600;
    std::optional<ViewDirection> view; ///< none: `camera`, or raisedStandpoint(); of a crowd, fillingDirection()
    std::optional<int> turntable;      ///< the number of numbered pictures around the model; none: one view
    std::optional<int> frames;         ///< the number of numbered pictures over time; none: one time
    double framesPerSecond = 30.0;
    Look look = Look::Studio;
    std::string environment; ///< an equirectangular picture in place of the studio; empty: none
    std::string output;      ///< a .png; numbered, OUT.png becomes OUT.0001.png, OUT.0002.png …

    Result<void> run() const;
};

/// `osggpuanim convert`: writes a model with all its clips as a GLB, see gltf::exportModel(), or in OSG's own formats.
struct ConvertCommand : ModelArguments
{
    std::string output; ///< a .glb, .osgb, .osgt or .osgx

    Result<void> run() const;
};

} // namespace osgGpuAnimation::tool
