// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// Lists names for an error message: "Walk", "Run". Of more than 50 names it lists the first 50 and the total; without
/// names it is: none. nameOf: returns the name of a T.
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
