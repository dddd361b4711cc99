// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// One option of osgDB's option string.
struct OptionWord
{
    std::string name;
    std::optional<std::string> value; ///< what follows the first `=`
};

/// The options of a string: words apart by spaces, `name` or `name=value`, a value with spaces in quotation marks
/// (`clip="Walk fast"`).
std::vector<OptionWord> splitOptions(const std::string& text);

/// A string that splitOptions() makes the same words of.
std::string joinOptions(const std::vector<OptionWord>& words);

} // namespace osgGpuAnimation::gltf
