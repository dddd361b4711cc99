// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/file/ImportOptions.h"

#include <osgGpuAnimation/math/Result.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace osgGpuAnimation::crowd
{

/// The description of a crowd: `fox.glb.40x40.crowd` is 40 columns and 40 rows of the character in `fox.glb`.
struct CrowdOptions
{
    std::string modelFile;
    std::size_t columns = 1, rows = 1;
    std::vector<std::string> clips;  ///< names or numbers to choose from; empty: all
    std::optional<double> spacing;   ///< distance between neighbours in units of the scene; none: by the median clip
    std::optional<float> pixelError; ///< see CharacterMeshes::setPixelError; none: the character's own
    std::uint32_t seed = 1;          ///< of the random clips and times
    std::string outfits;             ///< "random", or the name of an outfits file; empty: none
    bool isYUp = false;              ///< the model keeps glTF's +Y up: the ground is XZ
};

/// The options of a crowd, each with a line of help.
const std::vector<gltf::OptionHelp>& optionHelp();

/// The option string for the crowd's model: without the options of crowds alone and those of single characters. A value
/// of `clips` that ends in .glb or .gltf is a file of clips for the model.
std::string modelOptions(const std::string& options);

/// A hint for each misspelt option of a crowd, and for each option of a model that has no effect on a crowd.
std::vector<std::string> optionHints(const std::string& options);

/// name: without the `.crowd`. options: osgDB's option string; words of other readers are ignored.
/// Errors: no file name before the size; a size that is not COLUMNSxROWS, is 0 or exceeds AnimatedCrowd::maxInstances;
/// a value that its option does not accept.
Result<CrowdOptions> parseCrowd(const std::string& name, const std::string& options);

} // namespace osgGpuAnimation::crowd
