// SPDX-License-Identifier: MIT
#pragma once

#include <osgGpuAnimation/math/Result.h>

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace osgGpuAnimation
{

/// The part of a joint's name after namespaces and Mixamo's prefix, which differ from file to file: "Hips" of "Hips",
/// "mixamorig:Hips", "mixamorig4_Hips", "mixamorigHips" and "Armature|hero:Hips".
std::string bareJointName(const std::string& name);

/// bareJointName() in small letters, with `_` for dots, which exporters replace.
std::string caselessJointName(const std::string& name);

/// The names of joints, morphs and other elements that have one.
template <typename T>
std::vector<std::string> namesIn(const std::vector<T>& elements)
{
    std::vector<std::string> names;
    for (const T& element : elements)
        names.push_back(elementName(element));
    return names;
}

/// Finds the counterparts of joints by name. One per name: an index of `others`, -1 where there is none.
///
/// A name of `given` has the counterpart that `given` names, or none where that is empty. Other names have the joint of
/// the same name, else of the same bareJointName(), else of the same caselessJointName(), else, if byRole, of the same
/// role in a known human rig; by the last two only a joint that no name has by then. Of several joints with one name,
/// the n-th has the n-th as its counterpart, and the first one where there are fewer. Empty names have none.
///
/// Known rigs are those of Mixamo, CMU's motion capture as BVH, Unreal's mannequin, VRM (its own names and VRoid's),
/// the deform bones of Rigify, and names like `UpperArm_L`. Joints of two of them have the same role if they move the
/// same part of the body: `LeftForeArm` of Mixamo has the role of `lowerarm_l` of Unreal. A skeleton is of a rig if 12
/// joints have names of it.
std::vector<int> findCounterparts(const std::vector<std::string>& names, const std::vector<std::string>& others,
                                  const std::map<std::string, std::string>& given, bool byRole = false);

/// One per name: 2 · bone + side (left, right) of the upper arm, forearm, hand, thigh, shank or foot; -1: other joints,
/// and all if the skeleton is of no known rig.
std::vector<int> limbBones(const std::vector<std::string>& names);

} // namespace osgGpuAnimation
