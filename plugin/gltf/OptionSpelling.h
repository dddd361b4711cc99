// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace osgGpuAnimation::gltf
{

/// An option that readers of osgDB may be given, like `clip=NAME`, with a line on what it does.
using OptionHelp = std::pair<const char*, const char*>;

/// The option's name, without what follows its `=`.
std::string optionName(const OptionHelp& help);

/// A sentence about each word of osgDB's option string that is nearly one of the known options: but for the case of its
/// letters and for one letter that is wrong, missing, too much or swapped with the next: `"cliq" is unknown; is "clip"
/// meant?`. Words of others, and those far from any, are taken for other readers': osgDB hands all to all.
std::vector<std::string> misspeltOptions(const std::string& text, const std::vector<OptionHelp>& known,
                                         const std::vector<OptionHelp>& others = {});

} // namespace osgGpuAnimation::gltf
