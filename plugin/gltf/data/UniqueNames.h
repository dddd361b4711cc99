// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>

namespace osgGpuAnimation::gltf
{

/// Names of which each occurs once: of equal names, later ones get a number.
class UniqueNames
{
public:
    /// The name itself, or `name 2`, `name 3`, … if it is taken.
    std::string unique(const std::string& name)
    {
        std::string made = name;
        for (std::size_t& copies = _copies[name]; !_taken.insert(made).second;)
            made = name + ' ' + std::to_string(++copies + 1);
        return made;
    }

private:
    std::set<std::string> _taken;
    std::map<std::string, std::size_t> _copies; ///< by name
};

} // namespace osgGpuAnimation::gltf
