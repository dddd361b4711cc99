// SPDX-License-Identifier: MIT
#pragma once

#include "tool/ModelFile.h"
#include "tool/PictureViewer.h"

#include <osgGpuAnimation/math/Result.h>

#include <optional>
#include <string>

namespace osgGpuAnimation::tool
{

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

    /// Error messages begin with the name of the file at fault.
    Result<void> run() const;
};

} // namespace osgGpuAnimation::tool
