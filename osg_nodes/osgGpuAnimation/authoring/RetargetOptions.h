// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>

namespace osgGpuAnimation
{

/// How withClipsOf() fits clips to joints with another rest pose.
enum class ClipMatch
{
    /// ByName for joints that only their rest rotations tell apart from those of the clips, if the rest pose of the
    /// clips is the first keyframe of one of them; else Retarget.
    Automatic,
    Retarget, ///< joints keep their difference from the rest pose in model space, see withClipsOf()
    ByName,   ///< joints take rotations and translations as they are: the bones have the lengths of the clips
};

/// Options of withClipsOf().
struct RetargetOptions
{
    /// From joints of the set to their counterparts in the set of the clips, where their names differ; to an empty
    /// name: the joint has none. All others are matched by name, without namespaces and the prefix `mixamorig`, then
    /// without regard to case and with `_` for dots, then by the names of known rigs, see findCounterparts().
    std::map<std::string, std::string> counterparts{};
    /// The joint of the set that carries the body. Empty: a joint called hips or pelvis, else the first joint below
    /// which the skeleton branches.
    std::string hips{};
    /// Whether clips are taken as they are or retargeted.
    ClipMatch match = ClipMatch::Automatic;
};

} // namespace osgGpuAnimation
