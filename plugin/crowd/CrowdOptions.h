// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/ImportOptions.h"

#include <osgGpuAnimation/animation/Result.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
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

/// The options of a crowd, with a line on what each does.
const std::vector<gltf::OptionHelp>& optionHelp();

/// The option string without what is the crowd's alone and what is for single characters: what its model is to be
/// read with.
std::string modelOptions(const std::string& options);

/// A sentence about each word that is nearly one of a crowd's options, and about each that is one of a model's but does
/// nothing to a crowd.
std::vector<std::string> optionHints(const std::string& options);

/// name: without the `.crowd`. options: osgDB's option string; other readers' words are passed over.
/// Errors: no file name before the size, a size that is not COLUMNSxROWS, of nothing, or of more than a crowd can hold;
/// a value that does not fit its option.
Result<CrowdOptions> parseCrowd(const std::string& name, const std::string& options);

} // namespace osgGpuAnimation::crowd
