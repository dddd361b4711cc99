// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>

namespace osgGpuAnimation
{

/// Options of withClipsOf().
struct RetargetOptions
{
    /// From joints of the set to their counterparts in the set of the clips, where their names differ; to an empty
    /// name: the joint has none. All others are matched by name, without namespaces and the prefix `mixamorig`.
    std::map<std::string, std::string> counterparts{};
    /// The joint of the set that carries the body. Empty: a joint called hips or pelvis, else the first joint below
    /// which the skeleton branches.
    std::string hips{};
};

} // namespace osgGpuAnimation
