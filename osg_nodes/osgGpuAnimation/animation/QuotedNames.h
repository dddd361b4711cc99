// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// The names there are, for a message that says that one is not among them: "Walk", "Run"; of many the first 50 and how
/// many there are; or: none. nameOf: of a T, its name.
template <typename T, typename NameOf>
std::string quotedNames(const std::vector<T>& named, NameOf nameOf)
{
    constexpr std::size_t most = 50;
    std::string names;
    for (std::size_t i = 0; i < std::min(named.size(), most); ++i)
        names += (i == 0 ? "\"" : ", \"") + nameOf(named[i]) + "\"";
    if (named.size() > most) names += ", … (" + std::to_string(named.size()) + " in all)";
    return names.empty() ? "none" : names;
}

} // namespace osgGpuAnimation
