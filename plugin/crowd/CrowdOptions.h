// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/animation/Result.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation::crowd
{

/// What a crowd is to be made of: `fox.glb.40x40.crowd` is 40 columns and 40 rows of what `fox.glb` holds.
struct CrowdOptions
{
    std::string modelFile;
    std::size_t columns = 1, rows = 1;
    std::vector<std::string> clips;  ///< names or numbers to choose from; none: all
    std::optional<double> spacing;   ///< units of the scene, from one to the next
    std::optional<float> pixelError; ///< see AnimatedCrowd::setPixelError; none: the character's own
    std::uint32_t seed = 1;          ///< the same clips and times at each load
    bool isYUp = false;              ///< the model keeps glTF's +Y up: the ground is XZ
};

/// An option with a line on what it does.
std::vector<std::pair<const char*, const char*>> optionHelp();

/// name: without the `.crowd`. options: osgDB's option string; other readers' words are passed over.
/// Errors: no file name before the size, a size that is not COLUMNSxROWS, of nothing, or of more than a crowd can hold;
/// a value that does not fit its option.
Result<CrowdOptions> parseCrowd(const std::string& name, const std::string& options);

} // namespace osgGpuAnimation::crowd
